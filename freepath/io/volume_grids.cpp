// Choosing among the grids of a file, and the reasons against some.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "freepath/base/error.h"
#include "freepath/io/volume_assembly.h"

namespace freepath {
namespace {

std::string listed(const std::vector<GridInfo>& grids) {
  std::string list;
  for (const GridInfo& grid : grids) {
    list +=
        fmt::format("{}{} \"{}\" ({})", list.empty() ? "" : ", ", grid.index, grid.name, grid.type);
  }
  return list;
}

/// Whole numbers and truth values are more often labels than densities.
bool holds_reals(const GridInfo& grid) {
  constexpr std::string_view kOthers[] = {"int8",   "int16",  "int32",  "int64", "uint8",
                                          "uint16", "uint32", "uint64", "bool",  "mask"};
  return std::ranges::find(kOthers, grid.type) == std::end(kOthers);
}

/// The grid of a name with a time behind it, "lwc@3"; nothing if it is none.
/// @throws Error if there is no such time
std::optional<GridInfo> grid_at_time(const std::filesystem::path& file,
                                     const std::vector<GridInfo>& grids, std::string_view wanted) {
  const std::size_t mark = wanted.rfind('@');
  if (mark == wanted.npos) return std::nullopt;
  const auto named = std::ranges::find(grids, wanted.substr(0, mark), &GridInfo::name);
  if (named == grids.end()) return std::nullopt;
  if (!named->loadable) return *named;
  const std::optional<int> time = parse_grid_selection(wanted.substr(mark + 1)).index;
  if (!time || *time >= named->times) {
    fail("{}: grid \"{}\" has no time {}; there are {}, from 0", file.string(), named->name,
         wanted.substr(mark + 1), named->times);
  }
  GridInfo info = *named;
  info.name = wanted;
  info.time = *time;
  info.time_chosen = true;
  return info;
}

}  // namespace

GridSelection parse_grid_selection(std::string_view text) {
  GridSelection selection;
  if (text.empty()) return selection;
  int index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size() && index >= 0) {
    selection.index = index;
  } else {
    selection.name = std::string(text);
  }
  return selection;
}

GridInfo find_grid(const std::filesystem::path& file, const std::vector<GridInfo>& grids,
                   const GridSelection& selection) {
  if (grids.empty()) fail("{}: the file holds no grids", file.string());
  if (selection.index) {
    const int index = *selection.index;
    if (index < 0 || static_cast<std::size_t>(index) >= grids.size()) {
      fail("{}: there is no grid {}; it holds {}", file.string(), index, listed(grids));
    }
    return grids[static_cast<std::size_t>(index)];
  }
  std::string wanted = selection.name.value_or("density");
  constexpr std::string_view kFirst = "[0]";
  if (wanted.ends_with(kFirst)) wanted.resize(wanted.size() - kFirst.size());
  const auto named = std::ranges::find(grids, wanted, &GridInfo::name);
  if (named != grids.end()) return *named;
  if (auto timed = grid_at_time(file, grids, wanted)) return *std::move(timed);
  if (selection.name) {
    fail("{}: there is no grid named \"{}\"; it holds {}", file.string(), wanted, listed(grids));
  }
  const auto extinction = std::ranges::find(grids, "extinction", &GridInfo::name);
  // Where it can't be had, the reason says more than other values rendered in its place would.
  if (extinction != grids.end()) return *extinction;
  bool reals = true;
  const auto is_default = [&reals](const GridInfo& grid) {
    return grid.loadable && grid.channels == 1 && holds_reals(grid) == reals;
  };
  auto loadable = std::ranges::count_if(grids, is_default);
  if (loadable == 0) {
    reals = false;
    loadable = std::ranges::count_if(grids, is_default);
  }
  if (loadable == 1) return *std::ranges::find_if(grids, is_default);
  // Its own reason says more than a choice of one.
  if (grids.size() == 1 && grids[0].channels == 1) return grids[0];
  fail("{}: no grid is named \"density\" and {} could be one; choose (--grid) among {}",
       file.string(), loadable == 0 ? "none" : "several", listed(grids));
}

namespace io {

void check_distinct(const VolumeFile& file, std::vector<Vec3i> origins) {
  std::sort(origins.begin(), origins.end(), [](const Vec3i& a, const Vec3i& b) {
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.z < b.z;
  });
  const auto twice = std::adjacent_find(origins.begin(), origins.end());
  if (twice == origins.end()) return;
  file.fail_damaged(
      fmt::format("two nodes begin at voxel ({}, {}, {})", twice->x, twice->y, twice->z));
}

void make_names_unique(std::vector<GridInfo>& grids) {
  std::map<std::string, int> seen;
  for (GridInfo& grid : grids) {
    const int count = seen[grid.name]++;
    if (count > 0) grid.name += fmt::format("[{}]", count);
  }
}

void set_failure(const std::string& file, std::string_view message, GridInfo& grid) {
  grid.loadable = false;
  if (!grid.reason.empty()) return;
  for (const std::string& label : {grid_label(file, grid.name), file}) {
    if (message.starts_with(label + ": ")) {
      message.remove_prefix(label.size() + 2);
      break;
    }
  }
  grid.reason = message;
}

std::string grid_label(const std::string& file, const std::string& grid) {
  return fmt::format("{}: grid \"{}\"", file, grid);
}

std::string reason_against_class(const std::string& grid_class) {
  if (grid_class == "level set") {
    return "it is a level set (signed distances), not a density; convert it to a fog volume "
           "(openvdb::tools::sdfToFogVolume, or Convert VDB in Houdini)";
  }
  if (grid_class == "staggered") return "it is a staggered velocity grid, not a density";
  return {};
}

std::string reason_against_transform(const Matrix4d& index_to_world) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (!std::isfinite(index_to_world[row][column])) {
        return "its transform is not finite; set another";
      }
    }
  }
  double box = 1;  // volume of a voxel if its edges were perpendicular
  for (int row = 0; row < 3; ++row) {
    box *= Vec3d(index_to_world[row][0], index_to_world[row][1], index_to_world[row][2]).length();
  }
  const double voxel = std::abs(index_to_world.fastMinor(0, 1, 2, 0, 1, 2));
  if (!(box > 0) || !(voxel > 1e-9 * box)) {
    return "its transform is not invertible (voxels have no volume); set another";
  }
  return {};
}

std::string reason_against_type(const std::string& type) {
  if (type == "points") {
    return "it holds points, not densities; rasterise them first (VDB from Particles in Houdini)";
  }
  if (type == "index") {
    return "its voxels are indices of values that stand elsewhere; write the grid with its values "
           "(nanovdb::createNanoGrid<..., float>)";
  }
  return fmt::format(
      "its voxels are of type {}; only numbers, truth values, masks and vectors of three numbers "
      "can be densities",
      type);
}

void check_selected(const std::string& file, const GridInfo& info, const LoadOptions& options) {
  const std::string label = grid_label(file, info.name);
  if (!info.loadable) fail("{}: {}", label, info.reason);
  if (options.scalar_only && info.channels != 1) {
    fail("{}: its voxels are of type {}, which are {} densities; choose a grid of one", label,
         info.type, info.channels);
  }
}

}  // namespace io
}  // namespace freepath
