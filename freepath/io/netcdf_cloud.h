#pragma once
/// @file Extinction of cloud droplets from the water that a simulation of clouds gives.

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/io/netcdf_file.h"

namespace freepath::io {

/// Values of a level, x fastest.
using NetcdfLevel = std::function<std::vector<double>(std::size_t z)>;
/// Values of a level of a quantity at a time.
using NetcdfQuantityLevel = std::function<std::vector<double>(std::size_t z, std::size_t time)>;
/// Levels of a quantity over some axes. Throws Error, without a place, where it can't be had.
using NetcdfQuantity = std::function<NetcdfQuantityLevel(const NetcdfAxes& axes)>;

/// The variable that holds liquid water, by its name (lwc, ql, qc, qn, ...) or standard name.
std::optional<std::size_t> cloud_water_of(const NetcdfFile& netcdf);

/// Extinction 3/2 LWC/(ρ_w r_e) [1/m] of droplets that are large against the wavelength, whose
/// extinction efficiency is 2 [Stephens78]. Water by mass of air is multiplied by the air's
/// density, which stands in the file or follows from its pressure and temperature.
/// @param fallback_radius effective radius where the file has none [m]; 0: it must have
/// @throws Error, without a place, if a variable or its unit is missing
NetcdfQuantityLevel cloud_extinction(const std::shared_ptr<const NetcdfFile>& netcdf,
                                     std::size_t water, const NetcdfAxes& axes,
                                     double fallback_radius);

}  // namespace freepath::io
