#pragma once
/// @file The laboratory's settings: media that vary along x alone, whose free paths are known.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/tracking/streams.h"

namespace freepath {

/// Voxels from x = 0 to x = 1, and along the edge of a super-voxel: the ray passes 16 of these.
inline constexpr int kLabVoxels = 256;
inline constexpr int kLabCell = 16;

/// A medium, what lights it, and one ray: from x = 0 to x = 1. A path that scatters at x brings
/// back the radiance `scattered`, one that escapes the background.
///
/// The medium is made of voxels that are read by `nearest` interpolation, so that every tracker
/// applies and free paths have a closed form (lab_curves.h); it goes on beyond the ray on all
/// sides, so that the bounds of super-voxels are those of the function.
struct LabSetting {
  std::string name;     ///< Name on the command line.
  std::string summary;  ///< One line for users.
  std::shared_ptr<const Medium> medium;
  int channels = 1;  ///< 1 where all are equal.
  /// L_s at x in a channel.
  std::function<double(double x, int channel)> scattered;
  double background = 0;
};

/// What there is to choose from.
struct LabSettingInfo {
  std::string_view name;
  std::string_view summary;
};
std::span<const LabSettingInfo> lab_setting_infos();

/// @throws Error for a name that is not in the list, which the message gives
LabSetting make_lab_setting(std::string_view name);

/// What the ray passes and nothing else: the same densities as functions, the same bounds. For what
/// judges a medium by all of its super-voxels; those beside the ray are only half full.
Medium medium_along_ray(const LabSetting& setting);

/// Fixture A of docs/equations.md: the radiance at x = 0, and the optical thickness, by quadrature
/// of the functions. Voxels change them by less than 1e-4.
inline constexpr double kFixtureRadiance[3] = {0.74584544, 1.10968931, 0.74747946};
inline constexpr double kFixtureThickness[3] = {3.82675652, 2.57584138, 2.86495606};

/// Copies of the ray, numbered from `first`; a number stands for random numbers of its own.
/// @param count may be 0
void set_lab_rays(uint64_t first, std::size_t count, RayStream& rays);

/// Puts one of them elsewhere along the ray.
/// @param length how far it goes [world]
void set_lab_ray(std::size_t slot, float x, float length, RayStream& rays);

}  // namespace freepath
