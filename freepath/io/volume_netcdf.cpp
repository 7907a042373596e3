// Reads NetCDF files: every variable in space as it stands, and the extinction of cloud water.

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"
#include "freepath/io/netcdf_cloud.h"
#include "freepath/io/netcdf_file.h"
#include "freepath/io/volume_dense.h"

namespace freepath::io {
namespace {

/// Planes of a uniform grid in z, each between two levels of the file.
class NetcdfPlanes : public PlaneSource {
 public:
  /// @param levels places of the file's levels [m]; none if the planes are its levels
  NetcdfPlanes(NetcdfLevel level, std::vector<double> levels, int planes)
      : level_(std::move(level)), levels_(std::move(levels)), planes_(planes) {}

  void next(std::span<double> values) override {
    const auto plane = static_cast<std::size_t>(plane_++);
    if (levels_.empty()) {
      std::ranges::copy(level_(plane), values.begin());
      return;
    }
    const std::size_t last = levels_.size() - 1;
    const double share = static_cast<double>(plane) / (planes_ - 1);
    const double level = levels_.front() + (levels_.back() - levels_.front()) * share;
    const bool rising = levels_.back() > levels_.front();
    while (lower_ + 1 < last &&
           (rising ? levels_[lower_ + 1] <= level : levels_[lower_ + 1] >= level)) {
      ++lower_;
    }
    const double weight =
        std::clamp((level - levels_[lower_]) / (levels_[lower_ + 1] - levels_[lower_]), 0.0, 1.0);
    const std::vector<double>&below = cached(lower_), &above = cached(lower_ + 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
      // A missing value counts only where it has a weight.
      values[i] = weight == 0   ? below[i]
                  : weight == 1 ? above[i]
                                : (1 - weight) * below[i] + weight * above[i];
    }
  }

 private:
  const std::vector<double>& cached(std::size_t level) {
    cache_.erase(cache_.begin(), cache_.lower_bound(lower_));
    const auto found = cache_.find(level);
    return found != cache_.end() ? found->second
                                 : cache_.emplace(level, level_(level)).first->second;
  }

  NetcdfLevel level_;
  std::vector<double> levels_;
  int planes_;
  int plane_ = 0;
  std::size_t lower_ = 0;  // level below the plane
  std::map<std::size_t, std::vector<double>> cache_;
};

/// How many planes of one distance stand for levels of several.
/// @throws Error, without a place, if there were too many
int planes_for(const NetcdfCoordinates& z) {
  double least = std::abs(z.positions[1] - z.positions[0]);
  for (std::size_t i = 1; i < z.positions.size(); ++i) {
    least = std::min(least, std::abs(z.positions[i] - z.positions[i - 1]));
  }
  const double planes =
      std::ceil(std::abs(z.positions.back() - z.positions.front()) / least - 1e-3) + 1;
  constexpr double kMostTimes = 16;
  if (planes > kMostTimes * static_cast<double>(z.positions.size())) {
    fail(
        "its levels {} lie {:.4g} m apart at least, which would make {} planes of {}; interpolate "
        "it to even levels",
        z.name, least, planes, z.positions.size());
  }
  return static_cast<int>(planes);
}

/// Sets where the samples lie.
/// @return places of the levels [m]; none if they are even
std::vector<double> set_axes(const NetcdfFile& netcdf, const NetcdfAxes& axes, DenseGrid& grid) {
  grid.info.length_unit = "m";
  grid.info.grid_class = "samples";
  std::vector<double> levels;
  std::array<double, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int k = static_cast<int>(axis);
    NetcdfCoordinates along = netcdf.coordinates(axes.space[axis]);
    counts[axis] = static_cast<double>(along.positions.size());
    if (!along.uniform && axis < 2) {
      fail("its coordinates {} are not evenly spaced; interpolate it to such", along.name);
    }
    if (!along.uniform) {
      counts[axis] = planes_for(along);
      grid.note = fmt::format(
          "its {} levels {} are not evenly spaced: interpolated to {} planes, {:.4g} m apart",
          along.positions.size(), along.name, counts[axis],
          std::abs(along.positions.back() - along.positions.front()) / (counts[axis] - 1));
      levels = along.positions;
      along.step = (along.positions.back() - along.positions.front()) / (counts[axis] - 1);
    }
    grid.info.index_to_world[k][k] = along.step;
    grid.info.index_to_world[3][k] = along.positions.front();
  }
  grid.counts = checked_counts(netcdf.file(), "an axis with", counts);
  check_dense_size(netcdf.file(), grid.counts, 1, DensePacking::kUnknown);
  if (axes.time >= 0) {
    constexpr std::size_t kMostTimes = 1 << 24;
    const std::size_t times = netcdf.size(axes.time);
    if (times < 1 || times > kMostTimes) fail("it has {} times", times);
    grid.info.times = static_cast<int>(times);
  }
  return levels;
}

/// A grid whose levels a function reads, or that says why it can't be loaded.
DenseGrid netcdf_grid(const std::shared_ptr<const NetcdfFile>& netcdf, std::string name,
                      std::string type, std::size_t variable, const NetcdfQuantity& quantity) {
  DenseGrid grid;
  grid.info.name = std::move(name);
  grid.info.type = std::move(type);
  grid.info.grid_class = "samples";
  try {
    const NetcdfAxes axes = netcdf->axes(variable);
    if (!axes.in_space()) fail("it isn't along x, y and z");
    const NetcdfQuantityLevel level = quantity(axes);
    std::vector<double> levels = set_axes(*netcdf, axes, grid);
    grid.info.stored_bytes = dense_bytes(grid.counts, sizeof(float));
    grid.open = [level, levels, planes = grid.counts.z](const GridInfo& head) {
      const auto time = static_cast<std::size_t>(head.time);
      return std::make_unique<NetcdfPlanes>([level, time](std::size_t z) { return level(z, time); },
                                            levels, planes);
    };
  } catch (const Error& error) {
    grid.counts = Vec3i(0);
    set_failure(netcdf->file().name(), error.what(), grid.info);
  }
  return grid;
}

}  // namespace

VolumeReaderPointer open_netcdf(const VolumeFile& file, const LoadOptions& options) {
  const auto netcdf = std::make_shared<const NetcdfFile>(file);
  std::vector<DenseGrid> grids;
  const std::optional<std::size_t> water = cloud_water_of(*netcdf);
  if (water) {
    grids.push_back(netcdf_grid(netcdf, "extinction", "from " + netcdf->variable(*water).name,
                                *water, [&](const NetcdfAxes& axes) {
                                  return cloud_extinction(netcdf, *water, axes,
                                                          options.effective_radius);
                                }));
    grids.back().info.value_unit = "1/m";
  }
  for (std::size_t i = 0; i < netcdf->variables().size(); ++i) {
    const NetcdfVariable& variable = netcdf->variable(i);
    constexpr std::size_t kSpace = 3;
    if (variable.type.empty() || variable.dimensions.size() < kSpace) continue;
    grids.push_back(
        netcdf_grid(netcdf, variable.name, variable.type, i, [&](const NetcdfAxes& axes) {
          return [netcdf, i, axes](std::size_t z, std::size_t time) {
            return netcdf->level(i, axes, z, time);
          };
        }));
    grids.back().info.value_unit = excerpt(variable.text("units"));
  }
  if (grids.empty()) {
    fail(
        "{}: it has no variable along x, y and z; name its dimensions so, or set the attributes "
        "axis of its coordinates",
        file.name());
  }
  return make_dense_reader(file, std::move(grids));
}

}  // namespace freepath::io
