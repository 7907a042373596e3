#pragma once
/// @file Light on its way from a scattering to a light.

#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/paths/media_set_table.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/path_state.h"
#include "freepath/paths/walk_batches.h"

namespace freepath {

/// Traces the shadow rays of a round of paths: through surfaces first, which end most of those that
/// end, then through the media between them.
class ShadowTracer {
 public:
  static constexpr uint32_t kNoCell = UINT32_MAX;

  /// @param scene,media_sets must outlive this
  /// @param is_second of two that trace rays of the same paths and flights, whose random numbers
  ///   are to be others
  ShadowTracer(const PathScene& scene, MediaSetTable& media_sets, uint64_t seed, std::size_t slots,
               bool is_second = false);

  /// Adds a ray.
  /// @param owner number of the path, whose radiance it is to add to
  /// @param media at its origin
  /// @param radiance what it adds if nothing is in between
  /// @param is_rgb to ScenePath::rgb and not to ScenePath::radiance
  /// @param cell that it is to add to, and not to the path: Deposit says what that does; kNoCell:
  ///   none
  void add(uint32_t owner, const ScenePath& path, const Vec3f& origin, const Vec3f& direction,
           const ShadowEnd& end, MediaSetId media, const SampledSpectrum& radiance, bool is_rgb,
           uint32_t cell = kNoCell) {
    arrivals_.push_back({radiance, owner, cell, is_rgb});
    if (is_open_) {
      const MediumId medium = media_sets_.medium(media);
      if (medium != kVacuum) add_open(path, medium, origin, direction, end.distance);
      return;
    }
    shadows_.push_back({origin, direction, end, media});
    // While its path is at hand.
    if (!scene_.surfaces) trace_surfaces(shadows_.back(), arrivals_.back(), path);
  }

  /// Whether each ray meets at most one medium, and nothing else: such may be added by their
  /// walker.
  bool is_open() const { return is_open_; }
  /// Adds what a ray of that kind brings, as add(). The ray follows by add_rays().
  void add_arrival(uint32_t owner, const SampledSpectrum& radiance, bool is_rgb) {
    arrivals_.push_back({radiance, owner, kNoCell, is_rgb});
  }
  /// Where to write the rays of the last arrivals, one behind the other.
  /// @param walker of the medium that they are in
  WalkBatches::Slot add_rays(const Walker& walker, std::size_t count) {
    const WalkBatches::Slot slot = batches_.add_all(walker, count);
    std::iota(slot.batch.owners.begin() + slot.slot, slot.batch.owners.begin() + slot.slot + count,
              static_cast<uint32_t>(arrivals_.size() - count));
    return slot;
  }

  /// Ray from where another is refracted on to the light.
  struct Bend {
    Vec3f origin, direction;  ///< [world, relative to the scene's origin]; unit.
    ShadowEnd end;
    uint32_t shape;  ///< Shape whose inside it leaves.
  };
  /// Adds a ray that is refracted on its way, as add().
  /// @param end where it is refracted, at its target
  /// @param bend the ray from there on
  void add_bent(uint32_t owner, const Vec3f& origin, const Vec3f& direction, const ShadowEnd& end,
                const Bend& bend, MediaSetId media, const SampledSpectrum& radiance, bool is_rgb) {
    bends_.push_back(bend);
    arrivals_.push_back({radiance, owner, kNoCell, is_rgb});
    shadows_.push_back({origin, direction, end, media, 0, static_cast<uint32_t>(bends_.size())});
  }

  /// Takes what a ray adds to a cell.
  using Deposit = std::function<void(ScenePath&, uint32_t cell, const SampledSpectrum&)>;
  /// Traces all rays, adds to their paths or cells, and forgets them.
  void trace(std::span<ScenePath> paths, WalkStatistics& statistics, const Deposit& deposit);

 private:
  /// What a ray brings, and whom.
  struct Arrival {
    SampledSpectrum radiance;
    uint32_t owner;
    uint32_t cell;
    bool is_rgb;
    uint32_t lookups = 0;
  };
  /// The ray of an arrival, where it may meet more than one medium.
  struct Shadow {
    Vec3f origin, direction;
    ShadowEnd end;
    MediaSetId media;
    uint32_t segments = 0;
    uint32_t bend = 0;  ///< Number in bends_, from 1 on; 0: none.
  };
  /// A ray's way through one medium.
  struct Segment {
    uint32_t arrival;
    SampledSpectrum transmittance{1.0F};
    uint32_t lookups = 0;
  };

  /// Stream of a ray's part through one medium.
  uint32_t stream_of(uint32_t flight, uint32_t segment) const;
  /// Sends a ray to the walker of the one medium on its way.
  void add_open(const ScenePath& path, MediumId medium, const Vec3f& origin, const Vec3f& direction,
                float end);
  /// Sends a ray's ways through media to their walkers; black if a surface is in between.
  void trace_surfaces(Shadow& shadow, Arrival& arrival, const ScenePath& path);
  /// Traces a ray from side to side of a domain that repeats.
  void trace_domain(Shadow& shadow, Arrival& arrival, const ScenePath& path);
  /// Traces a ray that meets no side; its media are those at its end then, if it comes there.
  void trace_part(Shadow& shadow, Arrival& arrival, const ScenePath& path);
  /// Traces a ray where surfaces have holes or are there in part: one position after the other.
  void trace_porous_surfaces(Shadow& shadow, Arrival& arrival, const ScenePath& path);
  /// Whether a ray goes on at a surface, which it crosses then; what is there in part takes its
  /// part.
  bool passes(const Shadow& shadow, Arrival& arrival, const ScenePath& path, const SurfaceHit& hit,
              MediaSetId& media);
  void add_segment(Shadow& shadow, const ScenePath& path, MediaSetId media, float begin, float end);

  const PathScene& scene_;
  MediaSetTable& media_sets_;
  uint64_t seed_;
  bool is_second_;
  bool has_holes_ = false;  // whether a material or an alpha of the scene has
  bool is_open_ = false;    // whether each ray has at most one medium on its way
  std::vector<Arrival> arrivals_;
  std::vector<Segment> segments_;  // ray after ray, each in the order of its way
  WalkBatches batches_;
  FlightStream flights_;
  std::vector<Bend> bends_;
  std::vector<Shadow> shadows_;    // of all arrivals, unless they are open
  std::vector<TiedSurface> ties_;  // of one ray, as the crossings
  BoundaryCrossings crossings_;
};

}  // namespace freepath
