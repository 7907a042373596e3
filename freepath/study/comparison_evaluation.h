#pragma once
/// @file What the runs of a comparison say together.

#include "freepath/study/comparison.h"

namespace freepath {

/// Tests the pictures of all configurations for bias at the comparison's level, and finds their
/// efficiencies.
void evaluate(Comparison& comparison);

}  // namespace freepath
