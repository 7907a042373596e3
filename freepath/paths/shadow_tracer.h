#pragma once
/// @file Light on its way from a scattering to a light.

#include <cstdint>
#include <vector>

#include "freepath/base/channels.h"
#include "freepath/base/vector.h"
#include "freepath/paths/media_places.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/walk_batches.h"

namespace freepath {

/// Traces the shadow rays of a round of paths: through surfaces first, which end most of those that
/// end, then through the media between them.
class ShadowTracer {
 public:
  /// @param scene,places must outlive this
  ShadowTracer(const PathScene& scene, MediaPlaces& places, uint64_t seed, std::size_t slots);

  /// Adds a ray.
  /// @param owner number of the path, whose radiance it is to add to
  /// @param place at its origin
  /// @param radiance what it adds if nothing is in between
  /// @param is_rgb to ScenePath::rgb and not to ScenePath::radiance
  void add(uint32_t owner, const ScenePath& path, const Vec3f& origin, const Vec3f& direction,
           const ShadowEnd& end, PlaceId place, const Channels& radiance, bool is_rgb) {
    shadows_.push_back({origin, direction, end, radiance, place, owner, is_rgb});
    if (!scene_.surfaces) trace_surfaces(shadows_.back(), path);  // while its path is at hand
  }

  /// Traces all rays, adds to their paths, and forgets them.
  void trace(std::vector<ScenePath>& paths, WalkStatistics& statistics);

 private:
  struct Shadow {
    Vec3f origin, direction;
    ShadowEnd end;
    Channels radiance;
    PlaceId place;
    uint32_t owner;
    bool is_rgb;
    uint32_t first_segment = 0, segments = 0;
  };

  /// Sends a ray's ways through media to their walkers; black if a surface is in between.
  void trace_surfaces(Shadow& shadow, const ScenePath& path);
  /// The same where surfaces have holes or are there in part: place by place.
  void trace_porous_surfaces(Shadow& shadow, const ScenePath& path);
  /// Whether a ray goes on at a surface, which it crosses then; what is there in part takes its
  /// part.
  bool passes(Shadow& shadow, const ScenePath& path, const SurfaceHit& hit, PlaceId& place);
  void add_segment(Shadow& shadow, const ScenePath& path, PlaceId place, float begin, float end);

  const PathScene& scene_;
  MediaPlaces& places_;
  uint64_t seed_;
  bool has_holes_ = false;          // whether a material or an alpha of the scene has
  std::vector<Channels> segments_;  // transmittances, ray after ray, each in the order of its way
  std::vector<uint32_t> owners_;    // of the segments
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Shadow> shadows_;
  std::vector<TiedSurface> ties_;  // of one ray, as the crossings
  BoundaryCrossings crossings_;
};

}  // namespace freepath
