#include "freepath/scene/build/region_simplifier.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace freepath {
namespace {

/// The part of the world that a medium's densities reach.
Box3d reach_of(const SceneMedium& medium) {
  Box3d box = medium.bounds();
  if (!medium.medium()) return box;  // clipped at its bounds
  // Half a voxel more where voxels fade; what that is in the world, the transform knows.
  const Component& component = medium.medium()->components()[0];
  Vec3d half(0);
  for (int axis = 0; axis < 3; ++axis) {
    for (int from = 0; from < 3; ++from) {
      half[axis] += 0.5 * std::abs(component.density->index_to_world[from][axis]);
    }
  }
  return {box.min - half, box.max + half};
}

class Simplifier {
 public:
  Simplifier(SurfaceScene& surfaces, PathScene& scene) : surfaces_(surfaces), scene_(scene) {
    for (uint32_t shape = 0; shape < scene.shapes.size(); ++shape) all_.push_back(shape);
  }

  /// The medium whose boundary can go, if any.
  void run() {
    scene_.is_clear.assign(scene_.media.size(), false);
    const Surfaces traced(surfaces_, scene_.origin);
    for (MediumId id = 0; id < static_cast<MediumId>(scene_.media.size()); ++id) {
      const Box3d reach = reach_of(scene_.media[id]);
      if (traced.intersects_box(all_, reach)) continue;
      std::vector<uint32_t> boundary;
      if (!find_boundary(id, boundary)) continue;
      if (scene_.camera_medium != id && scene_.camera_medium != kVacuum) continue;
      const Vec3f center(reach.center() - scene_.origin);
      if (boundary.empty() ? scene_.camera_medium != id : !traced.is_inside(center, boundary)) {
        continue;
      }
      dissolve(id);
      return;
    }
  }

 private:
  /// The shapes around a medium, if they are mere boundaries to vacuum.
  bool find_boundary(MediumId id, std::vector<uint32_t>& boundary) const {
    for (const uint32_t shape : all_) {
      const PathShape& sides = scene_.shapes[shape];
      if (sides.inside != id && sides.outside != id) continue;
      if (sides.inside == sides.outside) continue;  // changes nothing
      if (sides.material || sides.light || sides.inside != id || sides.outside != kVacuum) {
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

  /// Vacuum becomes the medium, and boundaries between both go.
  void dissolve(MediumId id) {
    const auto filled = [id](MediumId medium) { return medium == kVacuum ? id : medium; };
    for (PathShape& shape : scene_.shapes) {
      shape.inside = filled(shape.inside);
      shape.outside = filled(shape.outside);
    }
    scene_.camera_medium = filled(scene_.camera_medium);
    const auto is_useless = [&](const SurfaceShape& shape) {
      const PathShape& sides = scene_.shapes[shape.shape];
      return shape.is_boundary && sides.inside == id && sides.outside == id;
    };
    std::erase_if(surfaces_.shapes, is_useless);
    scene_.is_clear[id] = true;
  }

  SurfaceScene& surfaces_;
  PathScene& scene_;
  std::vector<uint32_t> all_;
};

}  // namespace

void simplify_regions(SurfaceScene surfaces, PathScene& scene) {
  Simplifier(surfaces, scene).run();
  if (surfaces.shapes.empty() && surfaces.instances.empty()) return;
  scene.surfaces.emplace(surfaces, scene.origin);
}

}  // namespace freepath
