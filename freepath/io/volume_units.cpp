#include "freepath/io/volume_units.h"

#include <string>
#include <utility>

#include "freepath/io/volume_text.h"

namespace freepath {
namespace {

template <class Value, std::size_t kCount>
std::optional<Value> find_unit(const std::pair<std::string_view, Value> (&units)[kCount],
                               std::string_view name) {
  for (const auto& [unit, value] : units) {
    if (unit == name) return value;
  }
  return std::nullopt;
}

/// A compound unit in one of its ways to be written: without blanks, powers marked by nothing.
std::string plain_unit(std::string_view unit) {
  std::string plain;
  for (const char c : io::lower_case(unit)) {
    if (c != ' ' && c != '^' && c != '*' && c != '.' && c != '_') plain += c;
  }
  return plain;
}

}  // namespace

std::optional<double> meters_of(std::string_view unit) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"m", 1},
      {"meter", 1},
      {"meters", 1},
      {"metre", 1},
      {"metres", 1},
      {"km", 1e3},
      {"kilometer", 1e3},
      {"kilometers", 1e3},
      {"kilometre", 1e3},
      {"kilometres", 1e3},
      {"cm", 1e-2},
      {"mm", 1e-3},
      {"um", 1e-6},
      {"micron", 1e-6},
      {"microns", 1e-6},
      {"micrometer", 1e-6},
      {"micrometers", 1e-6},
      {"micrometre", 1e-6},
      {"micrometres", 1e-6},
      {"\xC2\xB5m", 1e-6},
      {"\xCE\xBCm", 1e-6}};  // either letter for micro
  const std::string_view name = io::trimmed(unit);
  // "Mm" is another unit than "mm".
  if (name.size() <= 2 && name != io::lower_case(name)) return std::nullopt;
  return find_unit(kUnits, io::lower_case(name));
}

namespace io {

std::optional<WaterUnit> water_unit(std::string_view unit) {
  constexpr std::pair<std::string_view, WaterUnit> kUnits[] = {
      {"kgm-3", {WaterKind::kByVolume, 1}},    {"kg/m3", {WaterKind::kByVolume, 1}},
      {"gm-3", {WaterKind::kByVolume, 1e-3}},  {"g/m3", {WaterKind::kByVolume, 1e-3}},
      {"mgm-3", {WaterKind::kByVolume, 1e-6}}, {"mg/m3", {WaterKind::kByVolume, 1e-6}},
      {"kgkg-1", {WaterKind::kByMass, 1}},     {"kg/kg", {WaterKind::kByMass, 1}},
      {"gkg-1", {WaterKind::kByMass, 1e-3}},   {"g/kg", {WaterKind::kByMass, 1e-3}},
      {"1", {WaterKind::kByMass, 1}}};
  return find_unit(kUnits, plain_unit(unit));
}

std::optional<double> pascals_of(std::string_view unit) {
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"pa", 1},     {"pascal", 1},     {"pascals", 1},     {"hpa", 1e2}, {"mb", 1e2},
      {"mbar", 1e2}, {"millibar", 1e2}, {"millibars", 1e2}, {"kpa", 1e3}};
  return find_unit(kUnits, plain_unit(unit));
}

}  // namespace io
}  // namespace freepath
