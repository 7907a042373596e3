#pragma once
/// @file What the parts of the extension share of fields.

#include <array>

#include "freepath/base/vector.h"
#include "freepath/media/field.h"

namespace freepath::python {

/// An affine transform in rows, as OpenVDB has it: points are rows, the last row is the offset.
using Matrix = std::array<std::array<double, 4>, 4>;

Matrix4d matrix_of(const Matrix& rows);

}  // namespace freepath::python
