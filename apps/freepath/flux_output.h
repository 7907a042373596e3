#pragma once
/// @file What `freepath flux` says of fluxes: a table, JSON and maps.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/up_axis.h"
#include "freepath/paths/flux.h"

namespace freepath::program {

/// A direction [degrees].
struct FluxAngles {
  double zenith = 0;
  double azimuth = 0;  ///< As on a compass: sky_direction.
};

/// The unit vector that points there [world].
Vec3f direction_of(const FluxAngles& angles, UpAxis up);

/// Light that falls in.
struct FluxLight {
  std::optional<FluxAngles> sun = {};  ///< None: light from all over the sky.
};

/// Fluxes of one volume under several lights.
struct FluxReport {
  std::array<uint32_t, 2> counts{};  ///< Columns.
  Box3d domain;                      ///< [world]
  std::vector<FluxAngles> views;
  FluxSettings settings;
  std::vector<std::pair<FluxLight, FluxResult>> results;
};

void print_table(const FluxReport& report);
/// One object for one light, else a list of them under "results".
void print_json(const FluxReport& report);
/// Writes the columns of the only light as channels, north (or what the second level axis counts
/// up to) at the top.
/// @throws Error as write_exr
void write_maps(const std::string& path, const FluxReport& report);

}  // namespace freepath::program
