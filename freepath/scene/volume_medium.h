#pragma once
/// @file Bare volumes as a medium.

#include <memory>
#include <optional>
#include <vector>

#include "freepath/lights/thermal_radiance.h"
#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"
#include "freepath/paths/scene_medium.h"
#include "freepath/scene/periodic_sides.h"
#include "freepath/scene/volume.h"

namespace freepath {

/// Volumes as one medium.
struct VolumeMedium {
  std::shared_ptr<const Medium> medium;  ///< Medium with coefficients in R, G and B (linear sRGB).
  /// Temperatures of its components, in their order, where they glow as black bodies; what the
  /// components emit multiplies that. May be shorter.
  std::vector<std::optional<TemperatureEmission>> temperatures = {};
  /// What repeats, if anything does: along which axes, and from where to where [world].
  PeriodicSides sides = {};
};

/// Lets a component glow as a black body of temperatures, in R, G and B.
/// @param factor multiplies its radiance
void set_thermal_emission(const TemperatureEmission& emission, const Rgb& factor,
                          Component& component);

/// The volumes' densities as components of one medium, in their order; they may overlap anyhow.
/// @param super_voxel edge of a super-voxel [voxels], 0 for automatic
/// @throws Error for coefficients out of range, another number of densities in a volume than one or
///   three, and as repeat_sides and Medium
VolumeMedium make_medium(std::vector<Volume> volumes, int super_voxel,
                         const PeriodicSides& sides = {});

/// Grey media, one for each channel: what the medium is there. One alone where all are the same.
/// @param channels coefficients of its components
/// @param super_voxel edge of a super-voxel [voxels], 0 for automatic
std::vector<VolumeMedium> grey_media(const VolumeMedium& medium, const MediumChannels& channels,
                                     int super_voxel);

/// Checks that single precision tells the tentative collisions of a walk through a medium apart.
/// @throws Error, naming the densest grid, for an optical depth across it that is too large
void check_optical_depth(const Medium& medium);

/// Whether there is nothing in a medium: its densities are 0 everywhere.
bool is_empty(const Medium& medium);

/// The medium in a table of spectra. Coefficients whose channels are equal are the same at all
/// wavelengths, others become spectra as those of scenes do.
/// @throws Error for a component whose emission is a field without temperatures
SceneMedium to_scene_medium(const VolumeMedium& medium, SpectrumTable& table);

}  // namespace freepath
