#pragma once
/// @file Bare volumes as a medium.

#include <memory>
#include <optional>
#include <vector>

#include "freepath/lights/thermal_radiance.h"
#include "freepath/media/medium.h"
#include "freepath/paths/scene_medium.h"

namespace freepath {

/// How a density becomes collision coefficients: an extinction and an albedo, or both coefficients.
struct OpticalProperties {
  float density_scale = 1;          ///< Multiplies the densities.
  Spectrum albedo{0.999F};          ///< sigma_s/sigma_t, where sigma_t is 1 per unit of density.
  std::optional<Spectrum> sigma_a;  ///< [1/m per unit of density] with sigma_s replaces the albedo;
  std::optional<Spectrum> sigma_s;  ///< of the two the one that is not given is 0.
  PhaseFunction phase = {};
  /// L_e; with temperatures, what multiplies their black bodies' radiance, 1 if it is not given.
  std::optional<Spectrum> emission;
  double temperature_scale = 1;   ///< [K per unit of the field]
  double temperature_offset = 0;  ///< Value of the field at 0 K.
};

/// Densities with one set of optical properties.
struct Volume {
  /// One, which acts on all channels, or those of R, G and B, each of which acts on its channel
  /// alone.
  std::vector<Field> densities;
  OpticalProperties optics;
  /// Temperatures, where it glows as black bodies of them (TemperatureEmission).
  std::shared_ptr<const Field> temperature = nullptr;
};

/// Volumes as one medium.
struct VolumeMedium {
  std::shared_ptr<const Medium> medium;  ///< With coefficients in R, G and B (linear sRGB).
  /// Of its components, in their order, those that glow as black bodies; what the components emit
  /// multiplies that. May be shorter.
  std::vector<std::optional<TemperatureEmission>> temperatures = {};
};

/// The volumes' densities as components of one medium, in their order; they may overlap anyhow.
/// @param super_voxel edge of a super-voxel [voxels], 0 for automatic
/// @throws Error for coefficients out of range, another number of densities in a volume than one or
///   three, and as Medium
VolumeMedium make_medium(std::vector<Volume> volumes, int super_voxel);

/// Whether there is nothing in a medium: its densities are 0 everywhere.
bool is_empty(const Medium& medium);

/// The medium in a table of spectra. Coefficients whose channels are equal are the same at all
/// wavelengths, others become spectra as those of scenes do.
/// @throws Error for a component whose emission is a field without temperatures
SceneMedium to_scene_medium(const VolumeMedium& medium, SpectrumTable& table);

}  // namespace freepath
