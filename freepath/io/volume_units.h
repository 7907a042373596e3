#pragma once
/// @file Units as files write them.

#include <optional>
#include <string_view>

namespace freepath {

/// Length of a unit [m]: of "m", "km", "mm", "cm", "um" and the words for them; nothing if a text
/// is none of these.
std::optional<double> meters_of(std::string_view unit);

namespace io {

/// What an amount of water is told of.
enum class WaterKind { kByVolume, kByMass };

/// A unit of liquid water content: of kg/m³ by volume of air, or kg/kg by its mass.
struct WaterUnit {
  WaterKind kind = WaterKind::kByVolume;
  double scale = 1;  ///< Factor from its unit to kg/m³ or kg/kg.
};

/// A unit of liquid water content, "g m-3" or "kg/kg" and other ways to write those; nothing if a
/// text is none.
std::optional<WaterUnit> water_unit(std::string_view unit);

/// A unit of pressure [Pa]; nothing if a text is none.
std::optional<double> pascals_of(std::string_view unit);

}  // namespace io
}  // namespace freepath
