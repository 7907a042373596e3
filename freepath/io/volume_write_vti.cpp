// Writes images in VTK's XML.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_write.h"

namespace freepath {
namespace {

/// A grid as VTK tells it: where the first voxel is, edges, and their directions.
struct VtiPlacement {
  Vec3d origin, spacing;
  std::array<Vec3d, 3> directions;
};

/// @param first the voxel that becomes the first
VtiPlacement vti_placement(const AtomicFile& file, const Field& field, const Vec3i& first) {
  const Matrix4d& matrix = field.index_to_world;
  VtiPlacement placement;
  placement.origin = Vec3d(first) * matrix;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d edge(matrix[axis][0], matrix[axis][1], matrix[axis][2]);
    placement.spacing[axis] = edge.length();
    placement.directions[static_cast<std::size_t>(axis)] = edge / edge.length();
  }
  constexpr double kTolerance = 1e-6;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cosine = placement.directions[axis].dot(placement.directions[(axis + 1) % 3]);
    if (!(std::abs(cosine) < kTolerance)) {
      fail(
          "{}: the edges of the voxels of \"{}\" are not perpendicular, which a VTK image can't "
          "tell; write a .vdb or .nvdb",
          file.path(), field.name);
    }
  }
  return placement;
}

std::string xml_text(const std::string& text) {
  std::string escaped;
  for (const char c : printable(text)) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// The box of voxels that holds all active ones.
struct VoxelBox {
  Vec3i low, high;
  Vec3i counts() const { return high - low + Vec3i(1); }
};

VoxelBox common_box(std::span<const Field* const> fields) {
  VoxelBox box{fields[0]->voxels.active_min(), fields[0]->voxels.active_max()};
  for (const Field* field : fields) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], field->voxels.active_min()[axis]);
      box.high[axis] = std::max(box.high[axis], field->voxels.active_max()[axis]);
    }
  }
  return box;
}

std::string vti_head(const AtomicFile& file, std::span<const Field* const> fields,
                     const VoxelBox& box, uint64_t array_bytes) {
  const VtiPlacement placement = vti_placement(file, *fields[0], box.low);
  const Vec3i last = box.counts() - Vec3i(1);
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", last.x, last.y, last.z);
  std::string directions;
  for (int row = 0; row < 3; ++row) {
    for (const Vec3d& direction : placement.directions) {
      directions += fmt::format("{}{}", directions.empty() ? "" : " ", direction[row]);
    }
  }
  std::string head = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "<ImageData WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\" Direction=\"{}\">\n"
      "<Piece Extent=\"{}\">\n<PointData Scalars=\"{}\">\n",
      std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", extent,
      placement.origin.x, placement.origin.y, placement.origin.z, placement.spacing.x,
      placement.spacing.y, placement.spacing.z, directions, extent, xml_text(fields[0]->name));
  uint64_t offset = 0;
  for (const Field* field : fields) {
    head +=
        fmt::format("<DataArray type=\"Float32\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
                    xml_text(field->name), offset);
    offset += sizeof(uint64_t) + array_bytes;
  }
  return head + "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";
}

void write_array(std::ofstream& stream, const Field& field, const VoxelBox& box,
                 uint64_t array_bytes) {
  stream.write(reinterpret_cast<const char*>(&array_bytes), sizeof(array_bytes));
  std::vector<float> row(static_cast<std::size_t>(box.counts().x));
  for (int z = box.low.z; z <= box.high.z; ++z) {
    for (int y = box.low.y; y <= box.high.y; ++y) {
      for (int x = box.low.x; x <= box.high.x; ++x) {
        row[static_cast<std::size_t>(x - box.low.x)] = field.voxels.value(Vec3i(x, y, z));
      }
      stream.write(reinterpret_cast<const char*>(row.data()),
                   static_cast<std::streamsize>(row.size() * sizeof(float)));
    }
  }
}

/// Checks that all voxels of a box fit onto the disk: those of a sparse grid may be a million times
/// as many as it has.
void check_room(const AtomicFile& file, const Vec3i& counts, std::size_t fields) {
  const double bytes = static_cast<double>(counts.x) * static_cast<double>(counts.y) *
                       static_cast<double>(counts.z) * static_cast<double>(fields) * sizeof(float);
  const std::filesystem::path folder = std::filesystem::absolute(file.path()).parent_path();
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (error || bytes <= static_cast<double>(space.available)) return;
  constexpr double kGigabyte = 1e9;
  fail(
      "{}: a value for each of {} x {} x {} voxels takes {:.3g} GB, and {:.3g} GB are free; write "
      "a "
      ".vdb or .nvdb",
      file.path(), counts.x, counts.y, counts.z, bytes / kGigabyte,
      static_cast<double>(space.available) / kGigabyte);
}

}  // namespace

void write_vti(AtomicFile& file, std::span<const Field* const> fields) {
  if (fields.empty()) fail("{}: there is no field to write", file.path());
  for (const Field* field : fields) {
    if (field->index_to_world != fields[0]->index_to_world) {
      fail(
          "{}: \"{}\" and \"{}\" stand in different grids, which one VTK image can't hold; write "
          "each to its own",
          file.path(), fields[0]->name, field->name);
    }
  }
  const VoxelBox box = common_box(fields);
  const Vec3i counts = box.counts();
  check_room(file, counts, fields.size());
  const uint64_t array_bytes = static_cast<uint64_t>(counts.x) * static_cast<uint64_t>(counts.y) *
                               static_cast<uint64_t>(counts.z) * sizeof(float);
  const std::string head = vti_head(file, fields, box, array_bytes);
  std::ofstream stream(file.name(), std::ios::binary | std::ios::trunc);
  stream << head;
  for (const Field* field : fields) write_array(stream, *field, box, array_bytes);
  stream << "\n</AppendedData>\n</VTKFile>\n";
  stream.close();
  if (!stream) {
    file.give_up("it came out cut short; is the disk full, or the size of files limited?");
  }
  file.replace_target();
}

}  // namespace freepath
