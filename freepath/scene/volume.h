#pragma once
/// @file A bare volume: densities, and what they do to light.

#include <memory>
#include <optional>
#include <vector>

#include "freepath/base/rgb.h"
#include "freepath/media/field.h"
#include "freepath/media/phase/phase_function.h"

namespace freepath {

/// How a density becomes collision coefficients: an extinction and an albedo, or both coefficients.
struct OpticalProperties {
  float density_scale = 1;     ///< Multiplies the densities.
  Rgb albedo{0.999F};          ///< sigma_s/sigma_t, where sigma_t is 1 per unit of density.
  std::optional<Rgb> sigma_a;  ///< [1/m per unit of density] with sigma_s replaces the albedo;
  std::optional<Rgb> sigma_s;  ///< of the two the one that is not given is 0.
  PhaseFunction phase = {};
  /// L_e; with temperatures, what multiplies their black bodies' radiance, 1 if it is not given.
  std::optional<Rgb> emission;
  double temperature_scale = 1;   ///< [K per unit of the field]
  double temperature_offset = 0;  ///< Value of the field at 0 K.
};

/// Densities with one set of optical properties.
struct Volume {
  /// One density, which acts on all channels, or those of R, G and B, each of which acts on its
  /// channel alone.
  std::vector<Field> densities;
  OpticalProperties optics;
  /// Temperatures, where it glows as black bodies of them (TemperatureEmission).
  std::shared_ptr<const Field> temperature = nullptr;
};

}  // namespace freepath
