#include "freepath/media/walk_space.h"

#include <algorithm>
#include <cmath>

#include "freepath/base/box.h"
#include "freepath/base/error.h"

namespace freepath {
namespace {

/// Lanes count voxels in floats (small_to_int in base/lanes-inl.h), and interpolate between them.
constexpr int kMostVoxels = 1 << 23;
/// Where a position passes through another grid's, rounding may move it by half a voxel, as far as
/// the bounds of super-voxels are dilated; see PlacedVoxels.
constexpr int kMostVoxelsApart = 1 << 20;

bool have_one_layout(const Field& a, const Field& b) {
  return a.index_to_world == b.index_to_world && a.voxels.origin() == b.voxels.origin() &&
         a.voxels.brick_counts() == b.voxels.brick_counts() && !a.voxels.is_sparse() &&
         !b.voxels.is_sparse();
}

double blocks_in(const Vec3i& voxel_counts) {
  const Vec3d blocks = Vec3d(voxel_counts) / BoxTree::kBlock;
  return blocks.x * blocks.y * blocks.z;
}

double voxel_volume(const Field& field) { return std::abs(field.index_to_world.determinant()); }

Matrix4d translation(const Vec3d& by) { return Matrix4d().setTranslation(by); }

Matrix4d linear_part(Matrix4d matrix) {
  for (int axis = 0; axis < 3; ++axis) matrix[3][axis] = 0;
  return matrix;
}

/// Index space → position, counted from a voxel.
Matrix4d index_to_grid(const Vec3i& origin) { return translation(Vec3d(0.5) - Vec3d(origin)); }

/// Index space of one field → that of another. The fields' distance from the world's origin is
/// taken out before anything is rounded.
Matrix4d index_to_index(const Matrix4d& from, const Matrix4d& to) {
  const Vec3d apart = from.translation() - to.translation();
  return linear_part(from) * translation(apart) * linear_part(to).inverse();
}

/// Bounds of a field's active voxels, each of which reaches that far [index].
Box3d active_box(const Field& field, double reach) {
  return {Vec3d(field.voxels.active_min()) - Vec3d(reach),
          Vec3d(field.voxels.active_max()) + Vec3d(reach)};
}

void check_lengths(std::span<const Field* const> fields) {
  for (const Field* field : fields) {
    const Vec3i& bricks = field->voxels.brick_counts();
    if (std::max({bricks.x, bricks.y, bricks.z}) > kMostVoxels / BrickMap::kBrickSize) {
      fail(
          "grid '{}' is more than {} voxels long: positions along it exceed the precision of "
          "floats",
          field->name, kMostVoxels);
    }
  }
}

void check_inverse(const Field& field) {
  const double determinant = field.index_to_world.determinant();
  if (!std::isfinite(determinant) || determinant == 0) {
    fail("grid '{}': its transform has no inverse", field.name);
  }
}

/// Fails if the grid over all fields, or a part of it, is longer than positions can be told apart,
/// in voxels of its own or of a component.
void check_extent(const Box3d& bounds, const WalkSpace& space, std::span<const Field* const> fields,
                  const Field& finest, int most) {
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const Matrix4d map = index_to_index(space.index_to_world, fields[k]->index_to_world);
    const Vec3d size = Imath::transform(bounds, map).size();
    const Vec3d own = bounds.size();
    const double longest = std::max({size.x, size.y, size.z, own.x, own.y, own.z});
    if (longest <= most) continue;
    const Field& other = fields[k] == &finest ? *fields[k == 0 ? 1 : 0] : *fields[k];
    fail(
        "grids '{}' and '{}' lie too far apart, or differ too much in the size of their voxels: "
        "the "
        "box around both is {:.3g} voxels long, more than {}; move them together, or resample the "
        "finer one",
        finest.name, other.name, longest, most);
  }
}

const Field& finest_of(std::span<const Field* const> fields) {
  return **std::min_element(fields.begin(), fields.end(), [](const Field* a, const Field* b) {
    return voxel_volume(*a) < voxel_volume(*b);
  });
}

/// The grid over fields that differ in transform or layout.
WalkSpace common_space(std::span<const Field* const> fields) {
  for (const Field* field : fields) check_inverse(*field);
  const Field& finest = finest_of(fields);
  WalkSpace space;
  space.aligned = false;
  space.index_to_world = finest.index_to_world;
  Box3d bounds;
  for (const Field* field : fields) {
    bounds.extendBy(Imath::transform(active_box(*field, 1),
                                     index_to_index(field->index_to_world, space.index_to_world)));
  }
  check_extent(bounds, space, fields, finest, kMostVoxels);
  constexpr double kRounding = 1e-3;  // of bounds that are whole voxels; one is to spare
  for (int axis = 0; axis < 3; ++axis) {
    space.origin[axis] = static_cast<int>(std::floor(bounds.min[axis] + kRounding)) - 1;
    const int last = static_cast<int>(std::ceil(bounds.max[axis] - kRounding)) + 1;
    space.voxel_counts[axis] = last - space.origin[axis] + 1;
  }
  for (const Field* field : fields) {
    space.to_component.push_back(index_to_grid(space.origin).inverse() *
                                 index_to_index(space.index_to_world, field->index_to_world) *
                                 index_to_grid(field->voxels.origin()));
  }
  return space;
}

/// The grid of fields that share a transform, over the bricks of all.
WalkSpace shared_space(std::span<const Field* const> fields) {
  WalkSpace space;
  space.index_to_world = fields[0]->index_to_world;
  space.in_parts = true;
  space.origin = fields[0]->voxels.origin();
  Vec3d end(space.origin);
  for (const Field* field : fields) {
    const BrickMap& map = field->voxels;
    const Vec3d last = Vec3d(map.origin()) + Vec3d(map.brick_counts()) * BrickMap::kBrickSize;
    for (int axis = 0; axis < 3; ++axis) {
      space.origin[axis] = std::min(space.origin[axis], map.origin()[axis]);
      end[axis] = std::max(end[axis], last[axis]);
    }
  }
  const Vec3d size = end - Vec3d(space.origin);
  const double longest = std::max({size.x, size.y, size.z});
  if (longest > kMostVoxels) {
    fail(
        "grids '{}' and '{}' lie too far apart: the box around both is {:.3g} voxels long, more "
        "than {}; move them together",
        fields[0]->name, fields[1]->name, longest, kMostVoxels);
  }
  space.voxel_counts = Vec3i(size);
  for (const Field* field : fields) {
    space.to_component.push_back(translation(Vec3d(space.origin - field->voxels.origin())));
  }
  return space;
}

}  // namespace

Box3d WalkSpace::bounds(std::span<const Field* const> fields, double reach) const {
  Box3d box;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const Vec3i& first = fields[k]->voxels.origin();
    const Box3d covered = Imath::transform(active_box(*fields[k], reach), index_to_grid(first));
    box.extendBy(to_component[k] == Matrix4d()
                     ? covered
                     : Imath::transform(covered, to_component[k].inverse()));
  }
  return box;
}

std::vector<GridBox> WalkSpace::occupied(std::span<const Field* const> fields) const {
  constexpr double kRounding = 1e-3;  // of maps that are whole voxels
  std::vector<GridBox> boxes;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const BrickMap& map = fields[k]->voxels;
    const Box3d active = Imath::transform(active_box(*fields[k], 1.5), index_to_grid(map.origin()));
    const Matrix4d from_component = to_component[k].inverse();
    map.for_each_brick([&](const PlacedBrick& placed) {
      const Vec3d first(placed.coord * BrickMap::kBrickSize - map.origin());
      Box3d covered(first - Vec3d(1), first + Vec3d(BrickMap::kBrickSize + 1));
      GridBox box;
      for (int axis = 0; axis < 3; ++axis) {
        covered.min[axis] = std::max(covered.min[axis], active.min[axis]);
        covered.max[axis] = std::min(covered.max[axis], active.max[axis]);
        if (!(covered.min[axis] < covered.max[axis])) return;
      }
      if (!aligned)
        covered = Imath::transform(covered, from_component);
      else
        covered = {covered.min + from_component.translation(),
                   covered.max + from_component.translation()};
      for (int axis = 0; axis < 3; ++axis) {
        box.begin[axis] = static_cast<int>(std::floor(covered.min[axis] + kRounding));
        box.end[axis] = static_cast<int>(std::ceil(covered.max[axis] - kRounding));
      }
      boxes.push_back(box);
    });
  }
  return boxes;
}

void share_layout(std::span<Field* const> fields) {
  Vec3i first = fields[0]->voxels.origin();
  Vec3i last = first;
  double entries = 0;
  for (const Field* field : fields) {
    if (field->function || field->index_to_world != fields[0]->index_to_world) return;
    if (field->voxels.is_sparse()) return;
    const BrickMap& map = field->voxels;
    entries += static_cast<double>(map.index().size());
    for (int axis = 0; axis < 3; ++axis) {
      const int end = map.origin()[axis] + map.brick_counts()[axis] * BrickMap::kBrickSize;
      first[axis] = std::min(first[axis], map.origin()[axis]);
      last[axis] = std::max(last[axis], end);
    }
  }
  const Vec3d extent = (Vec3d(last) - Vec3d(first)) / BrickMap::kBrickSize;
  constexpr double kMostEmpty = 8;  // entries for each that there is now
  if (extent.x * extent.y * extent.z > kMostEmpty * entries) return;
  for (Field* field : fields) field->voxels.widen_index(first, Vec3i(extent));
}

WalkSpace make_walk_space(std::span<const Field* const> fields) {
  check_lengths(fields);
  const Field& first = *fields[0];
  WalkSpace space;
  if (std::all_of(fields.begin(), fields.end(),
                  [&](const Field* field) { return have_one_layout(*field, first); })) {
    space.index_to_world = first.index_to_world;
    space.origin = first.voxels.origin();
    space.voxel_counts = first.voxels.brick_counts() * BrickMap::kBrickSize;
    space.to_component.assign(fields.size(), Matrix4d());
    return space;
  }
  const bool any_sparse = std::any_of(fields.begin(), fields.end(),
                                      [](const Field* field) { return field->voxels.is_sparse(); });
  const bool one_transform = std::all_of(fields.begin(), fields.end(), [&](const Field* field) {
    return field->index_to_world == first.index_to_world;
  });
  if (any_sparse && one_transform) return shared_space(fields);
  space = common_space(fields);
  space.in_parts = any_sparse;
  if (!any_sparse && !is_worth_an_index(blocks_in(space.voxel_counts), 0)) {
    const std::vector<GridBox> boxes = space.occupied(fields);
    space.in_parts =
        !is_worth_an_index(blocks_in(space.voxel_counts), BoxTree::filled_blocks(boxes));
    if (space.in_parts && one_transform) return shared_space(fields);
  }
  if (!space.in_parts) check_part(space, {Vec3i(0), space.voxel_counts}, fields);
  return space;
}

void check_part(const WalkSpace& space, const GridBox& box, std::span<const Field* const> fields) {
  if (space.aligned) return;
  check_extent({Vec3d(box.begin), Vec3d(box.end)}, space, fields, finest_of(fields),
               kMostVoxelsApart);
}

}  // namespace freepath
