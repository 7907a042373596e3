// Fields as plain arrays and back, to be sent to other processes; and a digest of what they hold.

#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/content_digest.h"
#include "freepath/media/density_function.h"
#include "freepath/media/field.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/fields.h"
#include "python/src/interruptible.h"

namespace freepath::python {
namespace {

constexpr std::size_t kBrickVoxels = BrickMap::kBrickVoxels;

using Corner = std::array<int, 3>;
using Coords = nb::ndarray<const int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Bricks = nb::ndarray<const uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Voxels = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

Corner corner_of(const Vec3i& voxel) { return {voxel.x, voxel.y, voxel.z}; }
Vec3i voxel_of(const Corner& corner) { return {corner[0], corner[1], corner[2]}; }

void check_voxels(const Field& field) {
  if (field.function != nullptr) {
    fail("'{}' is computed by a function, which can't be sent: bake it first", field.name);
  }
}

/// Corners of the active voxels, origin and size of the index, whether it is a list, places of
/// bricks (n, 3), the number of the brick at each, and the voxels of all bricks (m, 512).
nb::tuple bricks_of(const Field& field) {
  check_voxels(field);
  const BrickMap& map = field.voxels;
  std::vector<PlacedBrick> placed;
  map.for_each_brick([&](const PlacedBrick& brick) { placed.push_back(brick); });
  ArrayMemory<int32_t> coords(placed.size() * 3);
  ArrayMemory<uint32_t> bricks(placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) coords.data()[3 * i + axis] = placed[i].coord[axis];
    bricks.data()[i] = placed[i].brick;
  }
  ArrayMemory<float> voxels(map.voxels().size());
  std::copy(map.voxels().begin(), map.voxels().end(), voxels.data());
  return nb::make_tuple(corner_of(map.active_min()), corner_of(map.active_max()),
                        corner_of(map.origin()), corner_of(map.brick_counts()), map.is_sparse(),
                        std::move(coords).to_numpy({placed.size(), 3}),
                        std::move(bricks).to_numpy({placed.size()}),
                        std::move(voxels).to_numpy({map.brick_count(), kBrickVoxels}));
}

/// The inverse of bricks_of().
std::shared_ptr<Field> field_of_bricks(const std::string& name, const Matrix& transform,
                                       const Corner& active_min, const Corner& active_max,
                                       const Corner& origin, const Corner& brick_counts,
                                       bool is_sparse, const Coords& coords, const Bricks& bricks,
                                       const Voxels& voxels) {
  const std::size_t count = bricks.shape(0);
  if (coords.shape(0) != count || voxels.shape(1) != kBrickVoxels) {
    fail("{}: its bricks do not go together", name);
  }
  // A brick that stands at several places is of one value.
  std::vector<uint32_t> uses(voxels.shape(0));
  for (std::size_t i = 0; i < count; ++i) {
    if (bricks.data()[i] >= uses.size()) fail("{}: its bricks do not go together", name);
    ++uses[bricks.data()[i]];
  }
  // The bounds that the index is that of; it may be larger than that of the active voxels.
  const Vec3i first = voxel_of(origin) + Vec3i(2);
  const Vec3i last = voxel_of(origin) + voxel_of(brick_counts) * BrickMap::kBrickSize - Vec3i(3);
  BrickMapBuilder builder(first, last, std::max<std::size_t>(voxels.shape(0), 1) - 1,
                          is_sparse ? count : BrickMapBuilder::kUnknown);
  for (std::size_t i = 0; i < count; ++i) {
    const int32_t* const coord = coords.data() + 3 * i;
    const float* const values = voxels.data() + std::size_t{bricks.data()[i]} * kBrickVoxels;
    const Vec3i brick(coord[0], coord[1], coord[2]);
    if (uses[bricks.data()[i]] > 1) {
      builder.add_constant_brick(brick, values[0]);
    } else {
      std::copy_n(values, kBrickVoxels, builder.add_brick(brick).begin());
    }
  }
  builder.set_active_bounds(voxel_of(active_min), voxel_of(active_max));
  return std::make_shared<Field>(Field{name, std::move(builder).finish(), matrix_of(transform)});
}

template <class T>
std::string_view bytes_of(const T* values, std::size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

/// A name for the voxels and their place in the world.
std::string digest_of(const Field& field) {
  check_voxels(field);
  return result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    ContentDigest digest;
    digest.add(bytes_of(field.index_to_world.getValue(), 16));
    const Corner corners[] = {corner_of(field.voxels.active_min()),
                              corner_of(field.voxels.active_max())};
    digest.add(bytes_of(corners, 2));
    field.voxels.for_each_brick([&](const PlacedBrick& brick) {
      const Corner coord = corner_of(brick.coord);
      digest.add(bytes_of(&coord, 1));
      digest.add(bytes_of(field.voxels.voxels().data() + brick.brick * kBrickVoxels, kBrickVoxels));
    });
    return digest.hex();
  });
}

}  // namespace

void bind_field_states(nb::module_& module) {
  module.def("bricks_of_field", &bricks_of, nb::arg("field"));
  module.def("digest_of_field", &digest_of, nb::arg("field"));
  module.def("field_of_bricks", &field_of_bricks, nb::arg("name"), nb::arg("transform"),
             nb::arg("active_min"), nb::arg("active_max"), nb::arg("origin"),
             nb::arg("brick_counts"), nb::arg("is_sparse"), nb::arg("places"), nb::arg("bricks"),
             nb::arg("voxels"));
}

}  // namespace freepath::python
