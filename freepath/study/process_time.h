#pragma once
/// @file How long this process has worked.

#include <sys/resource.h>

namespace freepath {

/// Seconds that all of its threads have worked so far, in the system's calls too.
inline double process_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace freepath
