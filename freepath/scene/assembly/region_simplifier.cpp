#include "freepath/scene/assembly/region_simplifier.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace freepath {
namespace {

/// The part of a medium that a boundary has to lie outside of: all but what rounding of positions
/// may take of it.
/// @param origin that these are relative to
OrientedBox core_of(const OrientedBox& reach, const Vec3d& origin) {
  constexpr double kRounding = 4 * double{std::numeric_limits<float>::epsilon()};
  return reach.grown_by(-kRounding * reach.farthest_coordinate(origin));
}

/// The corner of a box that a place is, a bit for each axis; nothing if it is none.
std::optional<uint32_t> corner_of(const Box3d& box, const Vec3d& point) {
  uint32_t corner = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] == box.max[axis]) {
      corner |= 1U << axis;
    } else if (point[axis] != box.min[axis]) {
      return std::nullopt;
    }
  }
  return corner;
}

/// The box that a mesh of twelve triangles is, two of them on each side, all turned outward, in its
/// own space.
/// @param is_reversed the other side of each triangle is its outside
std::optional<Box3d> box_of(const TriangleMesh& mesh, bool is_reversed) {
  if (mesh.indices.size() != 36 || !mesh.normals.empty()) return std::nullopt;
  Box3d box;
  for (const int index : mesh.indices) box.extendBy(mesh.positions[index]);
  if (!(box.size().x > 0 && box.size().y > 0 && box.size().z > 0)) return std::nullopt;
  // The corners of each side that its triangles leave out.
  std::array<std::vector<uint32_t>, 6> left_out;
  for (std::size_t first = 0; first < mesh.indices.size(); first += 3) {
    std::array<uint32_t, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = corner_of(box, mesh.positions[mesh.indices[first + i]]);
      if (!corner) return std::nullopt;
      corners[i] = *corner;
    }
    const uint32_t low = ~(corners[0] | corners[1] | corners[2]) & 7U;
    const uint32_t high = corners[0] & corners[1] & corners[2];
    if (!std::has_single_bit(low | high)) return std::nullopt;  // on no side, or of no area
    const int axis = std::countr_zero(low | high);
    const auto position = [&](std::size_t i) { return mesh.positions[mesh.indices[first + i]]; };
    const Vec3d normal = (position(1) - position(0)).cross(position(2) - position(0));
    if ((normal[axis] > 0) != ((high != 0) != is_reversed)) return std::nullopt;
    // The corners of a side cancel each other but for its own axis.
    left_out[2 * axis + (high != 0 ? 1 : 0)].push_back(corners[0] ^ corners[1] ^ corners[2] ^ high);
  }
  for (int side = 0; side < 6; ++side) {
    // Two triangles cover it if those corners lie opposite each other.
    const std::vector<uint32_t>& corners = left_out[side];
    const uint32_t across = 7U & ~(1U << side / 2);
    if (corners.size() != 2 || ((corners[0] ^ corners[1]) & across) != across) return std::nullopt;
  }
  return box;
}

/// How often a ray has to have entered each medium before it starts at a point, if it is never to
/// leave what it has not entered: as the boundaries around the point say, by the middle of three
/// rays for those that are not closed.
MediaSet media_at(const Surfaces& surfaces, const std::vector<PathShape>& shapes, std::size_t media,
                  const Vec3f& point) {
  std::vector<std::array<int32_t, 3>> needed(media);
  for (std::size_t ray = 0; ray < Surfaces::kProbes.size(); ++ray) {
    std::vector<int32_t> count(media);
    const auto add = [&](MediumId medium, int32_t number) {
      if (medium == kVacuum) return;
      count[medium] += number;
      needed[medium][ray] = std::max(needed[medium][ray], -count[medium]);
    };
    for (const BoundaryCrossing& crossing : surfaces.all_crossings(point, Surfaces::kProbes[ray])) {
      const PathShape& shape = shapes[crossing.shape];
      if (shape.inside == shape.outside) continue;
      add(crossing.enters ? shape.inside : shape.outside, 1);
      add(crossing.enters ? shape.outside : shape.inside, -1);
    }
  }
  MediaSet set;
  for (std::size_t medium = 0; medium < media; ++medium) {
    std::sort(needed[medium].begin(), needed[medium].end());
    set.add(static_cast<MediumId>(medium), needed[medium][1]);
  }
  return set;
}

class Simplifier {
 public:
  Simplifier(SurfaceScene& surfaces, PathScene& scene, const Vec3d& stood)
      : surfaces_(surfaces), scene_(scene), stood_(stood - scene.origin) {
    for (uint32_t shape = 0; shape < scene.shapes.size(); ++shape) all_.push_back(shape);
  }

  /// The medium whose boundary can go, if any.
  void run() {
    scene_.is_clear.assign(scene_.media.size(), false);
    if (scene_.media.empty()) return;
    const Surfaces traced(surfaces_, scene_.origin);
    add_media_around_camera(traced);
    for (MediumId id = 0; id < static_cast<MediumId>(scene_.media.size()); ++id) {
      std::vector<uint32_t> boundary;
      if (!find_boundary(id, boundary)) continue;
      const std::optional<SceneMedium> filling = filling_of(id, boundary);
      const OrientedBox reach = (filling ? *filling : scene_.media[id]).outer_box();
      // Boundaries may lie on the faces where the medium ends by itself.
      const OrientedBox core = core_of(reach, scene_.origin);
      const std::vector<uint32_t> others = all_but(boundary);
      if (traced.intersects_box(boundaries_among(others), core)) continue;
      if (!filling && traced.intersects_box(boundary, core)) continue;
      const Vec3f center(reach.center() - scene_.origin);
      const bool is_around = scene_.camera_media.count(id) > 0;
      if (boundary.empty() ? !is_around : !traced.is_inside(center, boundary)) continue;
      if (has_others(id, scene_.camera_media)) continue;
      const MediaSet inside = media_at(traced, scene_.shapes, scene_.media.size(), center);
      if (has_others(id, inside)) continue;
      // A boundary whose outside is turned inward has the medium around it.
      if (!boundary.empty() && inside.count(id) == 0) continue;
      if (filling) scene_.media[id] = *filling;
      dissolve(id);
      scene_.is_clear[id] = !traced.intersects_box(others, OrientedBox(reach.bounds()));
      return;
    }
  }

 private:
  /// To the camera's own medium, which need not have a boundary.
  void add_media_around_camera(const Surfaces& traced) {
    const MediaSet around = media_at(traced, scene_.shapes, scene_.media.size(), stood_);
    for (const MediaSet::Entry& entry : around.entries()) {
      scene_.camera_media.add(
          entry.medium,
          entry.count - std::min(entry.count, scene_.camera_media.count(entry.medium)));
    }
    // On its way to where it stands now it crosses boundaries as any ray does.
    const Vec3f way = Vec3f(scene_.camera->position() - scene_.origin) - stood_;
    if (way == Vec3f(0)) return;
    for (const BoundaryCrossing& crossing : traced.all_crossings(stood_, way)) {
      if (crossing.position.t >= 1) break;
      scene_.shapes[crossing.shape].cross(scene_.camera_media, crossing.enters);
    }
  }

  static bool has_others(MediumId id, const MediaSet& media) {
    return std::any_of(media.entries().begin(), media.entries().end(),
                       [&](const MediaSet::Entry& entry) { return entry.medium != id; });
  }

  /// The shapes around a medium, if they are mere boundaries to vacuum.
  bool find_boundary(MediumId id, std::vector<uint32_t>& boundary) const {
    for (const uint32_t shape : all_) {
      const PathShape& sides = scene_.shapes[shape];
      if (sides.inside != id && sides.outside != id) continue;
      if (sides.inside == sides.outside) continue;  // changes nothing
      if (sides.material || sides.light || sides.alpha || sides.inside != id ||
          sides.outside != kVacuum) {
        return false;
      }
      boundary.push_back(shape);
    }
    // A copy of the boundary in an instance would be another region of the same voxels.
    for (const auto& group : surfaces_.groups) {
      for (const SurfaceShape& shape : group) {
        if (std::find(boundary.begin(), boundary.end(), shape.shape) != boundary.end())
          return false;
      }
    }
    return true;
  }

  /// A homogeneous medium whose boundary is a box, as one that fills this box by itself.
  std::optional<SceneMedium> filling_of(MediumId id, std::span<const uint32_t> boundary) const {
    const SceneMedium& medium = scene_.media[id];
    if (!medium.is_homogeneous() || boundary.size() != 1) return std::nullopt;
    const SurfaceShape* only = nullptr;
    for (const SurfaceShape& shape : surfaces_.shapes) {
      if (shape.shape != boundary[0]) continue;
      if (only != nullptr) return std::nullopt;
      only = &shape;
    }
    const auto* const mesh = only != nullptr ? std::get_if<TriangleMesh>(&only->geometry) : nullptr;
    if (mesh == nullptr) return std::nullopt;
    const std::optional<Box3d> box = box_of(*mesh, only->reverse_orientation);
    if (!box) return std::nullopt;
    return medium.in_box(*box, only->object_to_world);
  }

  std::vector<uint32_t> all_but(std::span<const uint32_t> shapes) const {
    std::vector<uint32_t> others;
    std::set_difference(all_.begin(), all_.end(), shapes.begin(), shapes.end(),
                        std::back_inserter(others));
    return others;
  }

  std::vector<uint32_t> boundaries_among(std::vector<uint32_t> shapes) const {
    std::erase_if(shapes, [&](uint32_t shape) {
      return scene_.shapes[shape].inside == scene_.shapes[shape].outside;
    });
    return shapes;
  }

  /// Vacuum becomes the medium, and boundaries between both go.
  void dissolve(MediumId id) {
    const auto filled = [id](MediumId medium) { return medium == kVacuum ? id : medium; };
    for (PathShape& shape : scene_.shapes) {
      shape.inside = filled(shape.inside);
      shape.outside = filled(shape.outside);
    }
    scene_.camera_media = MediaSet();
    scene_.camera_media.add(id, 1);
    const auto is_useless = [&](const SurfaceShape& shape) {
      const PathShape& sides = scene_.shapes[shape.shape];
      return shape.is_boundary && sides.inside == id && sides.outside == id;
    };
    std::erase_if(surfaces_.shapes, is_useless);
  }

  SurfaceScene& surfaces_;
  PathScene& scene_;
  Vec3f stood_;  // the camera that the file describes
  std::vector<uint32_t> all_;
};

}  // namespace

void simplify_regions(SurfaceScene surfaces, PathScene& scene, const Vec3d& stood) {
  Simplifier(surfaces, scene, stood).run();
  if (surfaces.shapes.empty() && surfaces.instances.empty()) return;
  scene.surfaces.emplace(surfaces, scene.origin);
}

}  // namespace freepath
