#pragma once
/// @file Light of hot media: black bodies by a field of temperatures.

#include <array>
#include <functional>
#include <memory>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/media/field.h"
#include "freepath/media/radiance_field.h"
#include "freepath/spectra/cie_observer.h"

namespace freepath {

/// Unit of radiance that media emit: pbrt's films do not divide by the integral of the luminous
/// efficiency, and lights are normalised for it; emission in media is not.
inline constexpr double kMediumRadiance = kLuminousIntegral;

/// Thermal emission by a field of temperatures: a black body of scale · (value - offset) kelvins,
/// its spectrum scaled to a maximum of 1 (pbrt's convention), and nothing at 100 K or less.
struct TemperatureEmission {
  std::shared_ptr<const Field> field;
  double scale = 1;
  double offset = 0;
};

/// Radiance that a medium of a temperature emits at a wavelength.
/// @param temperature [K]
/// @param wavelength [nm]
double thermal_radiance(double temperature, double wavelength);

/// X, Y, Z of that radiance.
Vec3d thermal_xyz(double temperature);

/// Radiance by the value of the field in each channel, as tables; without fields where nothing is
/// hot enough to glow.
/// @param radiance in the channels, of a temperature [K]
std::array<RadianceField, kMaxChannels> tabulate_radiance(
    const TemperatureEmission& emission, const std::function<SampledSpectrum(double)>& radiance);

}  // namespace freepath
