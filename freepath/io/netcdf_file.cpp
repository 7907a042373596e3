#include "freepath/io/netcdf_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"
#include "freepath/base/printable.h"
#include "freepath/io/netcdf_classic.h"
#include "freepath/io/volume_text.h"
#include "freepath/io/volume_units.h"

namespace freepath::io {
namespace {

bool is_among(std::string_view name, std::span<const std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// What a dimension of a name stands for, where nothing else tells.
NetcdfAxis axis_of_name(std::string_view name) {
  constexpr std::string_view kX[] = {"x", "xt", "xm", "xu", "xc", "xh", "nx", "lon", "longitude"};
  constexpr std::string_view kY[] = {"y", "yt", "ym", "yv", "yc", "yh", "ny", "lat", "latitude"};
  constexpr std::string_view kZ[] = {"z",      "zt",       "zm",  "zw",  "zc",    "zh",    "nz",
                                     "height", "altitude", "alt", "lev", "level", "levels"};
  constexpr std::string_view kTime[] = {"time", "t", "times", "nt"};
  if (is_among(name, kX) || name.starts_with("west_east")) return NetcdfAxis::kX;
  if (is_among(name, kY) || name.starts_with("south_north")) return NetcdfAxis::kY;
  if (is_among(name, kZ) || name.starts_with("bottom_top")) return NetcdfAxis::kZ;
  return is_among(name, kTime) ? NetcdfAxis::kTime : NetcdfAxis::kOther;
}

NetcdfAxis axis_of_letter(std::string_view letter) {
  if (letter == "X") return NetcdfAxis::kX;
  if (letter == "Y") return NetcdfAxis::kY;
  if (letter == "Z") return NetcdfAxis::kZ;
  return letter == "T" ? NetcdfAxis::kTime : NetcdfAxis::kOther;
}

/// Sets the step, if all are alike but for rounding to float.
void find_step(NetcdfCoordinates& coordinates) {
  const std::vector<double>& positions = coordinates.positions;
  const double range = positions.back() - positions.front();
  coordinates.step = range / static_cast<double>(positions.size() - 1);
  const double largest = std::max(std::abs(positions.front()), std::abs(positions.back()));
  const double tolerance =
      1e-3 * std::abs(coordinates.step) + 2 * std::numeric_limits<float>::epsilon() * largest;
  coordinates.uniform = true;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double even = positions.front() + coordinates.step * static_cast<double>(i);
    if (!std::isfinite(positions[i])) {
      fail("its {} holds {}; correct it", coordinates.name, positions[i]);
    }
    if (i > 0 && !((positions[i] - positions[i - 1]) * range > 0)) {
      fail("its {} neither rises nor falls throughout; sort the samples", coordinates.name);
    }
    coordinates.uniform = coordinates.uniform && std::abs(positions[i] - even) <= tolerance;
  }
}

}  // namespace

NetcdfFile::NetcdfFile(const VolumeFile& file) : file_(&file) {
  check_netcdf_whole(file);
  std::string reason;
  handle_ = netcdf_codec().open(file.name(), contents_, reason);
  if (!handle_) file.fail_damaged(reason);
}

std::optional<std::size_t> NetcdfFile::find(
    std::span<const std::string_view> names,
    std::span<const std::string_view> standard_names) const {
  for (const std::string_view name : names) {
    for (std::size_t i = 0; i < variables().size(); ++i) {
      if (lower_case(variable(i).name) == name) return i;
    }
  }
  for (std::size_t i = 0; i < variables().size(); ++i) {
    if (is_among(variable(i).text("standard_name"), standard_names)) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> NetcdfFile::coordinate_variable(int dimension) const {
  const std::string& name = contents_.dimensions[static_cast<std::size_t>(dimension)].name;
  for (std::size_t i = 0; i < variables().size(); ++i) {
    const NetcdfVariable& candidate = variable(i);
    if (candidate.name == name && candidate.dimensions == std::vector<int>{dimension}) return i;
  }
  return std::nullopt;
}

NetcdfAxis NetcdfFile::axis_of(int dimension) const {
  const std::string& name = contents_.dimensions[static_cast<std::size_t>(dimension)].name;
  if (const auto coordinate = coordinate_variable(dimension)) {
    const NetcdfVariable& found = variable(*coordinate);
    const NetcdfAxis axis = axis_of_letter(found.text("axis"));
    if (axis != NetcdfAxis::kOther) return axis;
    if (found.text("units").find(" since ") != std::string::npos) return NetcdfAxis::kTime;
    const std::string standard = found.text("standard_name");
    if (standard == "projection_x_coordinate") return NetcdfAxis::kX;
    if (standard == "projection_y_coordinate") return NetcdfAxis::kY;
    if (standard == "height" || standard == "altitude") return NetcdfAxis::kZ;
    if (standard == "time") return NetcdfAxis::kTime;
  }
  return axis_of_name(lower_case(name));
}

NetcdfAxes NetcdfFile::axes(std::size_t variable_index) const {
  NetcdfAxes axes;
  for (const int dimension : variable(variable_index).dimensions) {
    const NetcdfAxis axis = axis_of(dimension);
    const auto set = [&](int& target) {
      if (target >= 0) {
        fail(
            "two of its dimensions are along the same axis; set their attributes axis (X, Y, Z, "
            "T)");
      }
      target = dimension;
    };
    if (axis == NetcdfAxis::kTime) {
      set(axes.time);
    } else if (axis != NetcdfAxis::kOther) {
      set(axes.space[static_cast<std::size_t>(axis)]);
    } else if (size(dimension) != 1) {
      fail(
          "its dimension {} is along no axis that is known; give it a coordinate with the "
          "attribute axis (X, Y, Z, T)",
          printable(contents_.dimensions[static_cast<std::size_t>(dimension)].name));
    }
  }
  return axes;
}

NetcdfCoordinates NetcdfFile::coordinates(int dimension) const {
  NetcdfCoordinates coordinates;
  coordinates.name = printable(contents_.dimensions[static_cast<std::size_t>(dimension)].name);
  const auto found = coordinate_variable(dimension);
  if (!found) {
    fail("its dimension {0} has no coordinates; add a variable {0}({0}) with the attribute units",
         coordinates.name);
  }
  const std::string unit = variable(*found).text("units");
  if (unit.empty()) {
    fail("its coordinates {} have no units; add them: ncatted -a units,{},o,c,m FILE",
         coordinates.name, coordinates.name);
  }
  const std::optional<double> meters = meters_of(unit);
  if (!meters) {
    fail(
        "its coordinates {} are in '{}', which is no length; project or interpolate it to "
        "coordinates in m or km",
        coordinates.name, printable(unit));
  }
  const std::size_t count = size(dimension);
  if (count < 2) {
    fail("its {} has {} coordinates; two are needed for the size of voxels", coordinates.name,
         count);
  }
  check_declared(file_->name(), fmt::format("{} coordinates {}", count, coordinates.name),
                 static_cast<double>(count) * sizeof(double), file_->size());
  const std::size_t first = 0;
  coordinates.positions = read(*found, std::span(&first, 1), std::span(&count, 1));
  for (double& position : coordinates.positions) position *= *meters;
  find_step(coordinates);
  return coordinates;
}

std::vector<double> NetcdfFile::read(std::size_t variable_index, std::span<const std::size_t> first,
                                     std::span<const std::size_t> counts) const {
  std::size_t total = 1;
  for (const std::size_t count : counts) total *= count;
  std::vector<double> values(total);
  const std::string reason = handle_->read(variable_index, first, counts, values);
  if (!reason.empty()) {
    file_->fail_damaged(fmt::format("{}: {}", printable(variable(variable_index).name), reason));
  }
  const NetcdfVariable& described = variable(variable_index);
  const bool real = described.type == "float" || described.type == "double";
  // What NetCDF writes where nothing was written, of reals.
  constexpr double kFill = 9.9692099683868690e+36;
  const std::optional<double> fill =
      real ? described.number("_FillValue").value_or(kFill) : described.number("_FillValue");
  const std::optional<double> missing = described.number("missing_value");
  const double scale = described.number("scale_factor").value_or(1);
  const double offset = described.number("add_offset").value_or(0);
  for (double& value : values) {
    const bool absent = (fill && value == *fill) || (missing && value == *missing);
    value = absent ? std::numeric_limits<double>::quiet_NaN() : scale * value + offset;
  }
  return values;
}

std::vector<double> NetcdfFile::level(std::size_t variable_index, const NetcdfAxes& axes,
                                      std::size_t z, std::size_t time) const {
  const std::vector<int>& dimensions = variable(variable_index).dimensions;
  std::vector<std::size_t> first(dimensions.size(), 0), counts(dimensions.size(), 1);
  bool has_x = false, has_y = false, x_first = false;
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const int dimension = dimensions[i];
    if (dimension == axes.time) first[i] = time;
    if (dimension == axes.space[2]) first[i] = z;
    if (dimension != axes.space[0] && dimension != axes.space[1]) continue;
    counts[i] = size(dimension);
    (dimension == axes.space[0] ? has_x : has_y) = true;
    if (dimension == axes.space[0] && !has_y) x_first = true;
  }
  std::vector<double> stored = read(variable_index, first, counts);
  const std::size_t nx = size(axes.space[0]), ny = size(axes.space[1]);
  if (has_x && has_y && !x_first) return stored;
  std::vector<double> plane(nx * ny);
  for (std::size_t y = 0; y < ny; ++y) {
    for (std::size_t x = 0; x < nx; ++x) {
      const std::size_t from = has_x && has_y ? x * ny + y : has_x ? x : has_y ? y : 0;
      plane[y * nx + x] = stored[from];
    }
  }
  return plane;
}

}  // namespace freepath::io
