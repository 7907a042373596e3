#pragma once
/// @file Options on the domain: which way is up, its sides and its ground.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "freepath/base/rgb.h"
#include "freepath/base/up_axis.h"
#include "freepath/scene/ground.h"
#include "freepath/scene/periodic_sides.h"

namespace freepath::program {

/// One number or three from a place on.
Rgb spectrum_of(const std::vector<double>& numbers, std::size_t first);

/// Axis that points up.
/// @param text of --up
UpAxis parse_up(const std::string& text);

/// Sides that --periodic and --domain make repeat.
/// @param periodic axes, separated by commas; perhaps empty
/// @param domain "FROM,TO" for each of them, in the order x, y, z; perhaps empty
/// @param up_axis which can't repeat
PeriodicSides parse_sides(const std::string& periodic, const std::string& domain, UpAxis up_axis);

/// Ground that is asked for, if one is.
/// @param text of --ground, perhaps empty
std::optional<Ground> parse_ground(const std::string& text, UpAxis up);

}  // namespace freepath::program
