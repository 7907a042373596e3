#pragma once
/// @file The volumes of a picture: files, grids and optical properties, each given once for all of
/// them or once for each.

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/freepath/render_output.h"
#include "freepath/io/volume.h"
#include "freepath/scene/volume_scene.h"

namespace freepath::program {

/// The options as they were typed, in their order.
struct VolumeOptions {
  std::vector<std::string> files;
  std::vector<std::string> grids;  ///< "density", or three for R,G,B: "red,green,blue"
  std::vector<double> density_scale, g;
  std::vector<std::string> temperature;  ///< Grids of temperatures.
  std::vector<double> temperature_scale, temperature_offset;
  std::vector<std::string> phase;
  std::vector<std::string> albedo, sigma_a, sigma_s, radiance;
  std::string negative = "error", invalid = "zero";
};

/// Adds all but the files.
void add_volume_options(CLI::App& command, VolumeOptions& options);

/// How to load a volume, and what its densities become.
struct VolumePlan {
  std::string file;
  std::vector<LoadOptions> grids;  ///< One, or those of R, G and B.
  OpticalProperties optics;
  std::optional<LoadOptions> temperature;
};

/// Reads the options; no file is opened.
/// @throws Error naming the option
std::vector<VolumePlan> plan_volumes(const VolumeOptions& options);

/// Policy for voxels and pixels that are NaN or infinite.
/// @throws Error naming the option
InvalidPolicy read_invalid(const VolumeOptions& options);

/// Loads them, and tells warnings on standard error. Empty volumes are left out where others are
/// not.
/// @param report gets a row for each volume
/// @throws Error as load_fields
std::vector<Volume> load_volumes(const std::vector<VolumePlan>& plans,
                                 std::vector<VolumeReport>& report);

}  // namespace freepath::program
