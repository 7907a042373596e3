#pragma once
/// @file Fields in other units.

#include "freepath/media/field.h"

namespace freepath {

/// A field with all values and all lengths multiplied.
/// @param values finite and not negative
/// @param lengths finite and positive
/// @throws Error that names the grid if a value leaves the range of float
Field scaled_field(const Field& field, double values, double lengths);

}  // namespace freepath
