// The transforms of grids in .vdb files, which OpenVDB reads.

#include <openvdb/io/io.h>
#include <openvdb/math/Maps.h>
#include <openvdb/math/Transform.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <istream>

#include "freepath/base/error.h"
#include "freepath/io/memory_buffer.h"
#include "freepath/io/volume_vdb_layout.h"
#include "freepath/io/volume_vdb_nodes.h"

namespace freepath::io {
namespace {

void initialize_openvdb() {
  static const bool kDone = (openvdb::initialize(), true);
  static_cast<void>(kDone);
}

Matrix4d to_matrix(const openvdb::Mat4d& matrix) {
  Matrix4d result;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) result[row][column] = matrix(row, column);
  }
  return result;
}

FrustumMap frustum_map(const openvdb::math::NonlinearFrustumMap& map) {
  const openvdb::BBoxd& box = map.getBBox();
  const openvdb::Vec3d size = box.extents();
  return {
      .origin = Vec3d(box.min().x() + size.x() / 2, box.min().y() + size.y() / 2, box.min().z()),
      .width = size.x(),
      .step = map.getDepth() / size.z(),
      .growth = map.getGamma(),
      .frustum_to_world = to_matrix(map.secondMap().getMat4())};
}

bool is_sound(const FrustumMap& map) {
  return map.width > 0 && map.step != 0 && std::isfinite(map.width) && std::isfinite(map.step) &&
         std::isfinite(map.growth) && std::isfinite(map.origin.length());
}

/// The name of a transform's type, and the bytes that begin with it; any transform is shorter than
/// these.
std::string transform_bytes(const VolumeFile& file, uint64_t offset,
                            std::vector<std::byte>& bytes) {
  constexpr std::size_t kLongest = 4096;
  bytes.resize(std::min<uint64_t>(kLongest, file.size() - std::min(offset, file.size())));
  file.read(offset, bytes);
  return FileCursor(file, offset).take_string();
}

}  // namespace

VdbLocation read_vdb_location(const VolumeFile& file, const VdbDirectory& directory,
                              const VdbGrid& grid) {
  initialize_openvdb();
  VdbLocation location;
  uint64_t offset = grid.body;
  location.topology = grid.body;
  const bool transform_first = directory.file_version >= kVdbInstances;
  if (!transform_first) {
    offset = skip_vdb_topology(file, grid.body, *vdb_value_format(directory, grid)).end;
  }
  std::vector<std::byte> bytes;
  const std::string type = transform_bytes(file, offset, bytes);
  if (directory.file_version >= kVdbMaps && !openvdb::math::MapRegistry::isRegistered(type)) {
    location.reason = fmt::format(
        "its transform is of the unknown type \"{}\"; the file is damaged "
        "or made by a newer OpenVDB",
        type);
    return location;
  }
  MemoryBuffer buffer;
  buffer.reset(bytes);
  std::istream stream(&buffer);
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  openvdb::io::setVersion(stream,
                          openvdb::VersionId(directory.library_major, directory.library_minor),
                          directory.file_version);
  openvdb::math::Transform transform;
  try {
    transform.read(stream);
  } catch (const openvdb::ArithmeticError&) {
    location.reason = "its transform is not invertible; set another";
    return location;
  }
  location.end = offset + buffer.taken();
  if (transform_first) location.topology = location.end;
  location.index_to_world = to_matrix(transform.baseMap()->getAffineMap()->getMat4());
  const auto* const frustum =
      dynamic_cast<const openvdb::math::NonlinearFrustumMap*>(transform.baseMap().get());
  if (frustum != nullptr) {
    location.frustum = frustum_map(*frustum);
    if (!is_sound(*location.frustum)) {
      location.frustum.reset();
      location.reason = "its transform is a frustum without an extent; set another";
      return location;
    }
  }
  location.reason = reason_against_transform(location.index_to_world);
  return location;
}

}  // namespace freepath::io
