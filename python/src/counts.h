#pragma once
/// @file Counts of walks as Python has them.

#include <nanobind/nanobind.h>

#include "freepath/tracking/statistics.h"

namespace freepath::python {

/// By the names of WalkStatistics.
nanobind::dict counts_to_python(const WalkStatistics& counts);

}  // namespace freepath::python
