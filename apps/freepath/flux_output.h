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
  bool is_grey = true;  ///< Else each light has a result for each of R, G and B.
  std::vector<std::pair<FluxLight, std::vector<FluxResult>>> results;
};

void print_table(const FluxReport& report);
/// One object for one light, else a list of them under "results". Of a medium that is not grey
/// the object of a light has one for each channel under "channels".
void print_json(const FluxReport& report);
/// Writes the columns of the only light as channels, north (or what the second level axis counts
/// up to) at the top. Of a medium that is not grey, names end with that of a channel: ".R".
/// @throws Error as write_exr
void write_maps(const std::string& path, const FluxReport& report);

}  // namespace freepath::program
