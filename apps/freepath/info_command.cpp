// freepath info: what a volume file holds.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "freepath/base/box.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/io/volume.h"
#include "freepath/media/walk_part.h"

namespace freepath::program {
namespace {

constexpr const char* kInfoFooter =
    R"(Lists the grids of a volume file and loads each that can be a density: OpenVDB, NanoVDB, VTI, legacy
VTK, NRRD, MetaImage, NIfTI and NetCDF are read.
--grid looks at one of them: a name (the first of that name, name[1] the second), or a number.

Examples:
  freepath info cloud.vdb
  freepath info cloud.vdb --grid density
  freepath info les.nc --grid extinction@3
  freepath info cloud.nvdb --json)";

struct InfoOptions {
  std::string file, grid;
  bool json = false;
};

/// A grid and, where it can be loaded, what became of it: a field for each channel.
struct Described {
  GridInfo info;
  std::vector<LoadedField> loaded;
};

/// A transform in parts that say something to a reader.
struct Placement {
  Vec3d voxel_size;
  Vec3d axis;
  double angle = 0;  // [degrees]
  bool mirrored = false, sheared = false;
};

Vec3d edge(const Matrix4d& matrix, int row) {
  return {matrix[row][0], matrix[row][1], matrix[row][2]};
}

Placement placement_of(const Matrix4d& matrix) {
  Placement placement;
  Vec3d axes[3];
  for (int row = 0; row < 3; ++row) {
    placement.voxel_size[row] = edge(matrix, row).length();
    axes[row] = edge(matrix, row).normalized();
  }
  placement.mirrored = axes[0].cross(axes[1]).dot(axes[2]) < 0;
  constexpr double kTolerance = 1e-5;
  for (int row = 0; row < 3; ++row) {
    placement.sheared |= std::abs(axes[row].dot(axes[(row + 1) % 3])) > kTolerance;
  }
  if (placement.mirrored) {  // the rotation that is left once the axis is turned back
    const int row = axes[0].x < 0 ? 0 : axes[1].y < 0 ? 1 : 2;
    axes[row] = -axes[row];
  }
  const double cosine = (axes[0].x + axes[1].y + axes[2].z - 1) / 2;
  placement.angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI;
  if (placement.angle < 1e-3) placement.angle = 0;
  placement.axis = Vec3d(axes[1].z - axes[2].y, axes[2].x - axes[0].z, axes[0].y - axes[1].x);
  if (placement.axis.length() < 1e-9) {  // half a turn: the axis is what stays
    placement.axis = Vec3d(std::sqrt(std::max(0.0, (axes[0].x + 1) / 2)),
                           std::sqrt(std::max(0.0, (axes[1].y + 1) / 2)),
                           std::sqrt(std::max(0.0, (axes[2].z + 1) / 2)));
  }
  placement.axis.normalize();
  return placement;
}

/// Bounds of the voxels that count, whole voxels, in the world.
Box3d world_bounds(const GridInfo& info) {
  const Box3d voxels(Vec3d(info.active_min) - Vec3d(0.5), Vec3d(info.active_max) + Vec3d(0.5));
  return Imath::transform(voxels, info.index_to_world);
}

std::string size_text(double bytes) {
  const char* const units[] = {"B", "KiB", "MiB", "GiB"};
  int unit = 0;
  for (; bytes >= 1024 && unit < 3; ++unit) bytes /= 1024;
  return fmt::format("{:.{}f} {}", bytes, unit == 0 ? 0 : 1, units[unit]);
}

std::string transform_text(const GridInfo& info) {
  const Placement placement = placement_of(info.index_to_world);
  std::string text;
  if (placement.angle != 0) {
    text += fmt::format("rotated {:.4g} degrees about ({:.3g}, {:.3g}, {:.3g}), ", placement.angle,
                        placement.axis.x, placement.axis.y, placement.axis.z);
  }
  if (placement.mirrored) text += "mirrored, ";
  if (placement.sheared) text += "sheared, ";
  const Vec3d move = edge(info.index_to_world, 3);
  return text + fmt::format("moved by ({:.6g}, {:.6g}, {:.6g})", move.x, move.y, move.z);
}

/// The super-voxels that a render with a density scale of 1 would walk through.
struct SuperVoxelFacts {
  std::string reason;  ///< Why none can be made; empty if they can.
  int cell_size = 0;   ///< Of the first part, as the counts.
  Vec3i counts{0};
  std::size_t parts = 0;  ///< Places of voxels far apart have super-voxels each.
  std::size_t cells = 0;
  std::size_t occupied = 0;                 ///< In any channel.
  std::vector<SuperVoxelSummary> channels;  ///< Of each.
  std::size_t memory_bytes = 0;
};

SuperVoxelFacts super_voxel_facts(const std::vector<LoadedField>& loaded) {
  SuperVoxelFacts facts;
  std::vector<const Field*> fields;
  fields.reserve(loaded.size());
  for (const LoadedField& one : loaded) fields.push_back(&one.field);
  const auto edge_length = std::cbrt(std::abs(fields[0]->index_to_world.determinant()));
  const std::vector<float> extinction(fields.size(), static_cast<float>(edge_length));
  WalkParts made;
  try {
    made = make_walk_parts(make_walk_space(fields), fields, extinction, 0);
  } catch (const Error& error) {
    facts.reason = error.what();
    return facts;
  }
  facts.cell_size = made.parts[0].cells.cell_size;
  facts.counts = made.parts[0].cells.counts;
  facts.parts = made.parts.size();
  facts.channels.resize(fields.size());
  for (const WalkPart& part : made.parts) {
    const SuperVoxels& cells = part.cells;
    facts.cells += cells.cell_count();
    facts.occupied += static_cast<std::size_t>(
        std::ranges::count_if(cells.empty_radius, [](int radius) { return radius == 0; }));
    facts.memory_bytes += cells.memory_bytes();
    for (std::size_t k = 0; k < fields.size(); ++k) {
      facts.channels[k].merge(summarize(cells, static_cast<int>(k)));
    }
  }
  return facts;
}

std::string cells_text(const SuperVoxelFacts& cells) {
  const std::string shape =
      cells.parts == 1 ? fmt::format("{} x {} x {} of {} voxels a side", cells.counts.x,
                                     cells.counts.y, cells.counts.z, cells.cell_size)
                       : fmt::format("{} in {} parts that lie apart", cells.cells, cells.parts);
  return fmt::format("{}, {:.1f} % occupied, {}", shape,
                     100.0 * static_cast<double>(cells.occupied) / static_cast<double>(cells.cells),
                     size_text(static_cast<double>(cells.memory_bytes)));
}

/// "", or "R " of a grid of vectors.
std::string channel_prefix(const GridInfo& info, std::size_t channel) {
  return info.channels == 1 ? "" : fmt::format("{}: ", kChannelNames[channel]);
}

std::string ranges_text(const GridInfo& info) {
  std::string text;
  for (std::size_t i = 0; i < info.ranges.size(); ++i) {
    text += fmt::format("{}{}{:.6g} to {:.6g}", i == 0 ? "" : ", ", channel_prefix(info, i),
                        info.ranges[i].minimum, info.ranges[i].maximum);
  }
  return text;
}

struct Bricks {
  std::size_t count = 0;
  std::size_t bytes = 0;
};

Bricks bricks_of(const std::vector<LoadedField>& fields) {
  Bricks sum;
  for (const LoadedField& loaded : fields) {
    sum.count += loaded.field.voxels.brick_count() - 1;
    sum.bytes += loaded.field.voxels.memory_bytes();
  }
  return sum;
}

std::string units_text(const GridInfo& info) {
  std::string text;
  if (!info.length_unit.empty()) text += "positions in " + info.length_unit;
  if (!info.value_unit.empty())
    text += (text.empty() ? "" : ", ") + ("values in " + info.value_unit);
  return text;
}

std::string grid_text(const Described& grid) {
  const GridInfo& info = grid.info;
  std::string lines = fmt::format("grid {}: \"{}\"\n", info.index, printable(info.name));
  const auto row = [&](const char* name, const std::string& text) {
    lines += fmt::format("  {:<14} {}\n", name, printable(text));
  };
  const Vec3d voxel = placement_of(info.index_to_world).voxel_size;
  row("type", fmt::format("{}, {}", info.type, info.grid_class));
  if (!info.length_unit.empty() || !info.value_unit.empty()) row("units", units_text(info));
  if (info.times > 1) row("times", fmt::format("{}, of which this is {}", info.times, info.time));
  row("voxel size", fmt::format("{:.6g} x {:.6g} x {:.6g}", voxel.x, voxel.y, voxel.z));
  row("transform", transform_text(info));
  if (info.empty() && info.loadable) row("active", "no voxels: it is empty");
  if (!info.empty()) {
    const Vec3i size = info.active_max - info.active_min + Vec3i(1);
    const Box3d box = world_bounds(info);
    row("world bounds",
        fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.min.x, box.min.y,
                    box.min.z, box.max.x, box.max.y, box.max.z));
    row("voxel bounds", fmt::format("({}, {}, {}) to ({}, {}, {}), {} x {} x {}", info.active_min.x,
                                    info.active_min.y, info.active_min.z, info.active_max.x,
                                    info.active_max.y, info.active_max.z, size.x, size.y, size.z));
    row("range", ranges_text(info));
    row("active", fmt::format("{}, {} among them", counted(info.active_voxels, "voxel"),
                              counted(info.active_tiles, "constant tile")));
    if (info.inactive_voxels > 0) {
      row("inactive", counted(info.inactive_voxels, "voxel that is not 0 and counts as it is",
                              "voxels that are not 0 and count as they are"));
    }
  }
  row("in the file", size_text(static_cast<double>(info.stored_bytes)));
  if (!grid.loaded.empty()) {
    const Bricks bricks = bricks_of(grid.loaded);
    row("in memory",
        fmt::format("{}, {} of 8 x 8 x 8 voxels", size_text(static_cast<double>(bricks.bytes)),
                    counted(bricks.count, "brick")));
    const SuperVoxelFacts cells = super_voxel_facts(grid.loaded);
    row("super-voxels", cells.reason.empty() ? cells_text(cells) : "none: " + cells.reason);
    for (std::size_t i = 0; i < cells.channels.size(); ++i) {
      row("", fmt::format("{}of those occupied the mean maximum is {:.4g}, the mean minimum {:.4g}",
                          channel_prefix(info, i), cells.channels[i].mean_maximum,
                          cells.channels[i].mean_minimum));
    }
    for (const LoadedField& loaded : grid.loaded) {
      for (const std::string& warning : loaded.warnings) row("warning", warning);
    }
  } else {
    row("not loadable", info.reason);
  }
  return lines;
}

nlohmann::json to_json(const Vec3d& v) { return {v.x, v.y, v.z}; }
nlohmann::json to_json(const Vec3i& v) { return {v.x, v.y, v.z}; }

nlohmann::json grid_json(const Described& grid) {
  const GridInfo& info = grid.info;
  const Placement placement = placement_of(info.index_to_world);
  nlohmann::json json{{"index", info.index},
                      {"name", info.name},
                      {"type", info.type},
                      {"class", info.grid_class},
                      {"voxel_size", to_json(placement.voxel_size)},
                      {"active_voxels", info.active_voxels},
                      {"active_tiles", info.active_tiles},
                      {"inactive_voxels", info.inactive_voxels},
                      {"stored_bytes", info.stored_bytes},
                      {"loadable", info.loadable}};
  for (int row = 0; row < 4; ++row) {
    const double* const m = info.index_to_world[row];
    json["index_to_world"].push_back({m[0], m[1], m[2], m[3]});
  }
  if (!info.length_unit.empty()) json["length_unit"] = info.length_unit;
  if (!info.value_unit.empty()) json["value_unit"] = info.value_unit;
  if (info.times > 1) {
    json["times"] = info.times;
    json["time"] = info.time;
  }
  if (!info.loadable) json["reason"] = info.reason;
  if (!info.empty()) {
    const Box3d box = world_bounds(info);
    json["world_bounds"] = {{"min", to_json(box.min)}, {"max", to_json(box.max)}};
    json["active_bounds"] = {{"min", to_json(info.active_min)}, {"max", to_json(info.active_max)}};
    json["minimum"] = info.minimum;
    json["maximum"] = info.maximum;
  }
  if (info.channels > 1) {
    for (std::size_t i = 0; i < info.ranges.size(); ++i) {
      json["channels"].push_back({{"name", std::string(1, kChannelNames[i])},
                                  {"minimum", info.ranges[i].minimum},
                                  {"maximum", info.ranges[i].maximum}});
    }
  }
  if (grid.loaded.empty()) return json;
  const Bricks bricks = bricks_of(grid.loaded);
  json["memory_bytes"] = bricks.bytes;
  json["bricks"] = bricks.count;
  const SuperVoxelFacts cells = super_voxel_facts(grid.loaded);
  nlohmann::json& super_voxels = json["super_voxels"];
  if (!cells.reason.empty()) super_voxels["reason"] = cells.reason;
  if (cells.reason.empty()) {
    super_voxels = {{"parts", cells.parts},
                    {"cells", cells.cells},
                    {"occupied", cells.occupied},
                    {"memory_bytes", cells.memory_bytes}};
  }
  if (cells.parts == 1) {
    super_voxels["edge_voxels"] = cells.cell_size;
    super_voxels["counts"] = to_json(cells.counts);
  }
  for (std::size_t i = 0; i < cells.channels.size(); ++i) {
    nlohmann::json& target = info.channels == 1 ? super_voxels : json["channels"][i];
    target["mean_maximum"] = cells.channels[i].mean_maximum;
    target["mean_minimum"] = cells.channels[i].mean_minimum;
  }
  json["warnings"] = nlohmann::json::array();
  for (const LoadedField& loaded : grid.loaded) {
    for (const std::string& warning : loaded.warnings) json["warnings"].push_back(warning);
  }
  return json;
}

/// Reads each grid once, one at a time being in memory.
template <class Use>
void for_each_grid(const InfoOptions& options, Use use) {
  std::optional<GridSelection> only;
  if (!options.grid.empty()) only = parse_grid_selection(options.grid);
  visit_grids(options.file, only, {}, [&](const GridInfo& info, std::vector<LoadedField> loaded) {
    use(Described{info, std::move(loaded)});
  });
}

void run(const InfoOptions& options) {
  if (options.json) {
    nlohmann::json json{{"file", options.file}, {"grids", nlohmann::json::array()}};
    for_each_grid(options,
                  [&](const Described& grid) { json["grids"].push_back(grid_json(grid)); });
    print_json_text(json, 2);
    return;
  }
  std::string text;  // printed once there can't be an error any more
  for_each_grid(options, [&](const Described& grid) { text += grid_text(grid); });
  print_lines(text);
}

}  // namespace

void add_info_command(CLI::App& program) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* const command = program.add_subcommand("info", "Show the grids of a volume file");
  command->footer(kInfoFooter);
  command->add_option("FILE", options->file, "Volume file")->required();
  command->add_option("--grid", options->grid, "Only this grid: name or number");
  command->add_flag("--json", options->json, "One JSON object on standard output");
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
