#include "freepath/scene/pbrt/parameter.h"

#include <algorithm>
#include <array>
#include <utility>

namespace freepath {
namespace {

struct TypeName {
  ParameterType type;
  std::string_view name;
  int numbers = 1;
};

constexpr auto kTypeNames = std::to_array<TypeName>({
    {ParameterType::kInteger, "integer"},
    {ParameterType::kFloat, "float"},
    {ParameterType::kPoint2, "point2", 2},
    {ParameterType::kVector2, "vector2", 2},
    {ParameterType::kPoint3, "point3", 3},
    {ParameterType::kVector3, "vector3", 3},
    {ParameterType::kNormal3, "normal3", 3},
    {ParameterType::kBool, "bool"},
    {ParameterType::kString, "string"},
    {ParameterType::kTexture, "texture"},
    {ParameterType::kRgb, "rgb", 3},
    {ParameterType::kSpectrum, "spectrum", 2},
    {ParameterType::kBlackbody, "blackbody"},
    // Older names of three of them: only for finding, so they come last.
    {ParameterType::kPoint3, "point", 3},
    {ParameterType::kVector3, "vector", 3},
    {ParameterType::kNormal3, "normal", 3},
});

const TypeName& entry_of(ParameterType type) {
  return *std::ranges::find(kTypeNames, type, &TypeName::type);
}

constexpr auto kColorSpaces = std::to_array<std::pair<ColorSpace, std::string_view>>({
    {ColorSpace::kSrgb, "srgb"},
    {ColorSpace::kDciP3, "dci-p3"},
    {ColorSpace::kRec2020, "rec2020"},
    {ColorSpace::kAces2065, "aces2065-1"},
});

constexpr auto kNamedSpectra = std::to_array<std::string_view>({
    "glass-BK7",      "glass-BAF10",   "glass-FK51A",   "glass-LASF9",  "glass-F5",
    "glass-F10",      "glass-F11",     "metal-Ag-eta",  "metal-Ag-k",   "metal-Al-eta",
    "metal-Al-k",     "metal-Au-eta",  "metal-Au-k",    "metal-Cu-eta", "metal-Cu-k",
    "metal-CuZn-eta", "metal-CuZn-k",  "metal-MgO-eta", "metal-MgO-k",  "metal-TiO2-eta",
    "metal-TiO2-k",   "stdillum-A",    "stdillum-D50",  "stdillum-D65", "stdillum-F1",
    "stdillum-F2",    "stdillum-F3",   "stdillum-F4",   "stdillum-F5",  "stdillum-F6",
    "stdillum-F7",    "stdillum-F8",   "stdillum-F9",   "stdillum-F10", "stdillum-F11",
    "stdillum-F12",   "illum-acesD60",
});

// Their responses are three spectra each, as in "nikon_d850_r".
constexpr auto kSensors = std::to_array<std::string_view>({
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d",
    "canon_eos_200d_mkii",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
});

}  // namespace

std::string_view name_of(ParameterType type) { return entry_of(type).name; }

std::optional<ParameterType> find_parameter_type(std::string_view name) {
  const auto* const found = std::ranges::find(kTypeNames, name, &TypeName::name);
  if (found == kTypeNames.end()) return std::nullopt;
  return found->type;
}

int numbers_per_value(ParameterType type) { return entry_of(type).numbers; }

std::optional<ColorSpace> find_color_space(std::string_view name) {
  for (const auto& [space, known] : kColorSpaces) {
    if (known == name) return space;
  }
  return std::nullopt;
}

std::string_view name_of(ColorSpace space) {
  return kColorSpaces[static_cast<std::size_t>(space)].second;
}

bool is_named_spectrum(std::string_view name) {
  if (std::ranges::find(kNamedSpectra, name) != kNamedSpectra.end()) return true;
  if (!name.ends_with("_r") && !name.ends_with("_g") && !name.ends_with("_b")) return false;
  name.remove_suffix(2);
  return std::ranges::find(kSensors, name) != kSensors.end();
}

}  // namespace freepath
