#pragma once
/// @file What scenes and fluxes read alike of what users give.

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "freepath/base/up_axis.h"
#include "freepath/scene/periodic_sides.h"

namespace freepath::python {

/// Least and largest corner of a box [world].
using DomainCorners = std::pair<std::array<double, 3>, std::array<double, 3>>;

/// @param up "y" or "z"
/// @throws Error for another
UpAxis parse_up_axis(const std::string& up);

/// Sides that repeat.
/// @param axes some of "xyz"
/// @param domain a period along them; none: that of the active voxels
/// @throws Error for other axes, and a domain without any
PeriodicSides periodic_sides(const std::string& axes, const std::optional<DomainCorners>& domain);

}  // namespace freepath::python
