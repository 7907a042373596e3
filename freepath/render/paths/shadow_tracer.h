#pragma once
/// @file Light on its way from a scattering to a light.

#include <cstdint>
#include <vector>

#include "freepath/base/channels.h"
#include "freepath/base/vector.h"
#include "freepath/render/paths/path_colors.h"
#include "freepath/render/paths/path_scene.h"
#include "freepath/render/paths/path_state.h"
#include "freepath/render/paths/walk_batches.h"

namespace freepath {

/// Traces the shadow rays of a round of paths: through surfaces first, which end most of those that
/// end, then through the media between them.
class ShadowTracer {
 public:
  ShadowTracer(const PathScene& scene, std::size_t slots) : scene_(scene), batches_(slots, false) {}

  /// Adds a ray.
  /// @param owner of PathState, whose radiance it is to add to
  /// @param radiance what it adds if nothing is in between
  /// @param is_rgb to ScenePath::rgb and not to ScenePath::radiance
  void add(uint32_t owner, const Vec3f& origin, const Vec3f& direction, float distance,
           MediumId medium, const Channels& radiance, bool is_rgb) {
    shadows_.push_back({origin, direction, distance, medium, radiance, owner, is_rgb});
  }

  /// Traces all rays, adds to their paths, and forgets them.
  void trace(std::vector<ScenePath>& paths, WalkStatistics& statistics);

 private:
  struct Shadow {
    Vec3f origin, direction;
    float distance;
    MediumId medium;
    Channels radiance;
    uint32_t owner;
    bool is_rgb;
    uint32_t first_segment = 0, segments = 0;
  };

  /// Sends a ray's ways through media to their walkers; black if a surface is in between.
  void trace_surfaces(Shadow& shadow, const ScenePath& path);
  void add_segment(Shadow& shadow, const ScenePath& path, MediumId medium, float begin, float end);

  const PathScene& scene_;
  std::vector<Channels> segments_;  // transmittances, ray after ray, each in the order of its way
  std::vector<uint32_t> owners_;    // of the segments
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Shadow> shadows_;
};

/// The medium beyond a shape, for a path that was in `before`.
inline MediumId medium_beyond(const PathShape& shape, bool enters, MediumId before) {
  if (shape.inside == shape.outside) return before;
  return enters ? shape.inside : shape.outside;
}

}  // namespace freepath
