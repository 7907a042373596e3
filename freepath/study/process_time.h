#pragma once
/// @file How long this process has worked.

namespace freepath {

/// Seconds that all of its threads have worked so far, in the system's calls too.
double process_cpu_seconds();

}  // namespace freepath
