#pragma once
/// @file Emitted radiance that varies from place to place.

#include <memory>
#include <vector>

#include "freepath/media/field.h"

namespace freepath {

/// Emitted radiance as a function of a field's value, which is interpolated trilinearly: a black
/// body's of its temperature. Straight lines between the values of a table, held at both ends.
struct RadianceField {
  std::shared_ptr<const Field> field;  ///< Null: the same radiance everywhere.
  /// Radiance where the field is first + i · step; empty: the field is the radiance.
  std::shared_ptr<const std::vector<float>> table;
  float first = 0;
  float step = 1;
};

}  // namespace freepath
