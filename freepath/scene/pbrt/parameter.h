#pragma once
/// @file Parameters of the scene language: "float fov" 30.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "freepath/scene/pbrt/source_location.h"

namespace freepath {

enum class ParameterType {
  kInteger,
  kFloat,
  kPoint2,
  kVector2,
  kPoint3,
  kVector3,
  kNormal3,
  kBool,
  kString,
  kTexture,
  kRgb,
  kSpectrum,
  kBlackbody,
};

/// Name of a type as it is written in a scene: "point3".
std::string_view name_of(ParameterType type);

/// The type of this name, also by the older names "point", "vector" and "normal".
std::optional<ParameterType> find_parameter_type(std::string_view name);

/// How many numbers make one value of a type: 3 of a point3, 2 of a spectrum (wavelength and
/// value), 1 of what is no number.
int numbers_per_value(ParameterType type);

/// Colour spaces that RGB values can be in.
enum class ColorSpace { kSrgb, kDciP3, kRec2020, kAces2065 };

/// The colour space of this name: "srgb", "dci-p3", "rec2020" or "aces2065-1".
std::optional<ColorSpace> find_color_space(std::string_view name);
std::string_view name_of(ColorSpace space);

struct RgbValue {
  double r = 0, g = 0, b = 0;
  ColorSpace color_space = ColorSpace::kSrgb;
};

struct BlackbodyValue {
  double temperature = 0;  ///< [K]
};

/// A spectrum that is built into renderers: "metal-Au-eta", "glass-BK7", "stdillum-D65".
struct NamedSpectrum {
  std::string name;
};

/// Samples to be connected by straight lines.
struct SpectrumSamples {
  std::vector<double> wavelengths;  ///< Increasing [nm].
  std::vector<double> values;       ///< Numbers, numbers_per_value() for each value.
};

/// A spectrum in any of the ways in which a scene can give one. Samples are shared, since many
/// parameters may name one file; they are never null.
using SpectrumValue =
    std::variant<RgbValue, BlackbodyValue, NamedSpectrum, std::shared_ptr<const SpectrumSamples>>;

/// Whether renderers know a spectrum of this name. Anything else that a "spectrum" parameter names
/// is a file.
bool is_named_spectrum(std::string_view name);

/// A parameter as a scene gives it. Counts are those of its type: a point3 has 3 numbers for each
/// value, a spectrum has SpectrumValues.
struct Parameter {
  /// bool; string and texture; integer; float, points, vectors, normals, rgb and blackbody;
  /// spectrum.
  using Values = std::variant<std::vector<bool>, std::vector<std::string>, std::vector<int>,
                              std::vector<double>, std::vector<SpectrumValue>>;

  ParameterType type = ParameterType::kFloat;
  std::string name;
  SourceLocation location;
  Values values;
  ColorSpace color_space = ColorSpace::kSrgb;  ///< Colour space of rgb values.
};

}  // namespace freepath
