#pragma once
/// @file Parameters of materials and textures: values, or textures by name.

#include <array>
#include <span>
#include <string_view>

#include "freepath/materials/textures/texture.h"
#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// What numbers a parameter may have.
struct FloatRange {
  double smallest, largest;
};
inline constexpr FloatRange kAnyFloat = {-1e300, 1e300};
inline constexpr FloatRange kNotNegative = {0, 1e300};

/// A parameter of type float or texture.
/// @param range of a value; a texture may have any
/// @throws Error with file:line:column for another type, a value out of range or an unknown texture
FloatInput float_input(const BuildContext& context, const ParameterList& list,
                       std::string_view name, double otherwise,
                       const FloatRange& range = kAnyFloat);

/// A parameter of type rgb, spectrum, blackbody or texture.
/// @param meaning of a colour: kReflectance or kUnbounded
/// @throws Error with file:line:column for another type, an impossible value or an unknown texture
SpectrumInput spectrum_input(BuildContext& context, const ParameterList& list,
                             std::string_view name, const SpectralDistribution& otherwise,
                             ColorMeaning meaning);

/// A refractive index: a parameter of type float, rgb, spectrum or blackbody.
SpectrumId index_input(BuildContext& context, const ParameterList& list, std::string_view name,
                       double otherwise);

/// Parameters of materials whose spectra are no reflectances but the index of a metal.
inline constexpr std::array<std::string_view, 4> kMetalIndexParameters = {
    "eta", "k", "conductor.eta", "conductor.k"};

}  // namespace freepath
