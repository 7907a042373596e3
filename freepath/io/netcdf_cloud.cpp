#include "freepath/io/netcdf_cloud.h"

#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_units.h"

namespace freepath::io {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::string_view kWaterNames[] = {"lwc", "ql", "qc", "qcloud", "qn", "qcl", "clw"};
constexpr std::string_view kWaterStandardNames[] = {
    "mass_concentration_of_cloud_liquid_water_in_air", "cloud_liquid_water_mixing_ratio",
    "mass_fraction_of_cloud_liquid_water_in_air"};
constexpr std::string_view kRadiusNames[] = {"re",  "reff",   "r_eff",  "re_cloud",
                                             "rel", "re_liq", "re_cld", "effective_radius"};
constexpr std::string_view kRadiusStandardNames[] = {
    "effective_radius_of_cloud_liquid_water_particles",
    "effective_radius_of_cloud_liquid_water_particle"};
constexpr std::string_view kDensityNames[] = {"rho",    "rhoa", "rho_air", "air_density",
                                              "rhobar", "rho0", "dn0"};
constexpr std::string_view kDensityStandardNames[] = {"air_density"};
constexpr std::string_view kPressureNames[] = {"p", "pres", "pressure"};
constexpr std::string_view kPressureStandardNames[] = {"air_pressure"};
constexpr std::string_view kTemperatureNames[] = {"tabs", "temperature", "temp", "tk"};
constexpr std::string_view kTemperatureStandardNames[] = {"air_temperature"};

/// A variable that is multiplied by its unit, to be read level by level.
struct ScaledVariable {
  std::size_t index = 0;
  double scale = 1;
};

/// Checks that each dimension of a variable is one of the axes, so that it has values everywhere.
void check_along(const NetcdfFile& netcdf, std::size_t index, const NetcdfAxes& axes) {
  for (const int dimension : netcdf.variable(index).dimensions) {
    const bool known = dimension == axes.time || dimension == axes.space[0] ||
                       dimension == axes.space[1] || dimension == axes.space[2];
    if (!known && netcdf.size(dimension) != 1) {
      fail("{} has other dimensions than the cloud water; interpolate both to the same",
           printable(netcdf.variable(index).name));
    }
  }
}

/// The unit of a variable, by what a function says of its text.
template <class Unit>
auto unit_of(const NetcdfFile& netcdf, std::size_t index, std::string_view examples, Unit unit) {
  const NetcdfVariable& variable = netcdf.variable(index);
  const std::string text = variable.text("units");
  const auto found = unit(text);
  if (!found) {
    fail("{} is in {}; set its attribute units to one of {}", printable(variable.name),
         text.empty() ? "no units" : "'" + printable(text) + "', which is not known", examples);
  }
  return *found;
}

std::optional<double> kelvins_of(std::string_view unit) {
  if (unit == "K" || unit == "kelvin" || unit == "Kelvin") return 1;
  return std::nullopt;
}

std::optional<double> air_density_of(std::string_view unit) {
  const auto found = water_unit(unit);
  if (!found || found->kind != WaterKind::kByVolume) return std::nullopt;
  return found->scale;
}

std::optional<ScaledVariable> find_scaled(const NetcdfFile& netcdf, const NetcdfAxes& axes,
                                          Names names, Names standard_names,
                                          std::string_view examples,
                                          std::optional<double> (*unit)(std::string_view)) {
  const auto index = netcdf.find(names, standard_names);
  if (!index) return std::nullopt;
  check_along(netcdf, *index, axes);
  return ScaledVariable{*index, unit_of(netcdf, *index, examples, unit)};
}

/// What a level of extinction is made of.
struct CloudParts {
  ScaledVariable water;
  std::optional<ScaledVariable> radius;
  double fallback_radius = 0;
  bool by_mass = false;
  std::optional<ScaledVariable> air_density, pressure, temperature;
};

CloudParts find_parts(const NetcdfFile& netcdf, std::size_t water, const NetcdfAxes& axes,
                      double fallback_radius) {
  CloudParts parts;
  const WaterUnit unit = unit_of(netcdf, water, "kg m-3, g m-3, kg kg-1, g kg-1",
                                 [](const std::string& text) { return water_unit(text); });
  parts.water = {water, unit.scale};
  parts.by_mass = unit.kind == WaterKind::kByMass;
  parts.fallback_radius = fallback_radius;
  parts.radius = find_scaled(netcdf, axes, kRadiusNames, kRadiusStandardNames, "um, m", meters_of);
  if (!parts.radius && !(fallback_radius > 0)) {
    fail(
        "it needs the effective radius of droplets, a variable re in um or m; or take one radius "
        "(freepath convert --effective-radius)");
  }
  if (!parts.by_mass) return parts;
  parts.air_density =
      find_scaled(netcdf, axes, kDensityNames, kDensityStandardNames, "kg m-3", air_density_of);
  if (parts.air_density) return parts;
  parts.pressure =
      find_scaled(netcdf, axes, kPressureNames, kPressureStandardNames, "Pa, hPa", pascals_of);
  parts.temperature =
      find_scaled(netcdf, axes, kTemperatureNames, kTemperatureStandardNames, "K", kelvins_of);
  if (!parts.pressure || !parts.temperature) {
    fail(
        "its water is by mass of air, whose density it doesn't have: add a variable rho in kg m-3, "
        "or p in Pa and temperature in K");
  }
  return parts;
}

/// Values of a level in units of SI.
std::vector<double> scaled_level(const NetcdfFile& netcdf, const ScaledVariable& variable,
                                 const NetcdfAxes& axes, std::size_t z, std::size_t time) {
  std::vector<double> values = netcdf.level(variable.index, axes, z, time);
  for (double& value : values) value *= variable.scale;
  return values;
}

/// Density of air [kg/m³].
std::vector<double> air_density(const NetcdfFile& netcdf, const CloudParts& parts,
                                const NetcdfAxes& axes, std::size_t z, std::size_t time) {
  if (parts.air_density) return scaled_level(netcdf, *parts.air_density, axes, z, time);
  constexpr double kGasConstantOfDryAir = 287.05;  // [J/(kg K)]
  std::vector<double> density = scaled_level(netcdf, *parts.pressure, axes, z, time);
  const std::vector<double> temperature = scaled_level(netcdf, *parts.temperature, axes, z, time);
  for (std::size_t i = 0; i < density.size(); ++i) {
    density[i] /= kGasConstantOfDryAir * temperature[i];
  }
  return density;
}

}  // namespace

std::optional<std::size_t> cloud_water_of(const NetcdfFile& netcdf) {
  const auto found = netcdf.find(kWaterNames, kWaterStandardNames);
  constexpr std::size_t kSpace = 3;
  if (!found || netcdf.variable(*found).dimensions.size() < kSpace) return std::nullopt;
  return found;
}

NetcdfQuantityLevel cloud_extinction(const std::shared_ptr<const NetcdfFile>& netcdf,
                                     std::size_t water, const NetcdfAxes& axes,
                                     double fallback_radius) {
  const CloudParts parts = find_parts(*netcdf, water, axes, fallback_radius);
  return [netcdf, axes, parts](std::size_t z, std::size_t time) {
    constexpr double kDensityOfWater = 1000;  // [kg/m³]
    std::vector<double> values = scaled_level(*netcdf, parts.water, axes, z, time);
    std::vector<double> radius(values.size(), parts.fallback_radius);
    if (parts.radius) radius = scaled_level(*netcdf, *parts.radius, axes, z, time);
    std::vector<double> air(values.size(), 1.0);
    if (parts.by_mass) air = air_density(*netcdf, parts, axes, z, time);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] == 0) continue;  // the radius of no droplets may be anything
      const bool known = radius[i] > 0 && air[i] > 0;
      values[i] = known ? 1.5 * values[i] * air[i] / (kDensityOfWater * radius[i])
                        : std::numeric_limits<double>::quiet_NaN();
    }
    return values;
  };
}

}  // namespace freepath::io
