#pragma once
/// @file Walks through a medium of several parts, one after the other.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"
#include "freepath/media/medium_view.h"
#include "freepath/transport/kernels.h"

namespace freepath {

/// What a walk through several parts makes of the weights of each.
enum class PartWeights {
  kHandedOn,    ///< A flight goes on with those that it left the part before with.
  kMultiplied,  ///< A transmittance is the product of those of the parts.
};

/// Flies rays through the parts that they meet, front to back: one that leaves a part goes on in
/// the next, with random numbers of that part. Flights have no memory, and transmittances of parts
/// multiply, so that this is exact for every method that is in one part.
///
/// In each part positions are relative to its middle, so that single precision holds them however
/// far it is from the others. What becomes of a ray depends on that ray and the seed alone.
class PartWalks {
 public:
  /// @param medium,channels must outlive it
  /// @param origin what positions of rays are relative to [world]
  PartWalks(const Medium& medium, const MediumChannels& channels, const Vec3d& origin);

  /// Walks through the parts, as WalkFunction does through a whole.
  /// @param view of the medium
  /// @param channels whose weights the function writes
  void walk(WalkFunction function, PartWeights weights, const MediumView& view,
            std::span<const float> options, const WalkModes& modes, uint64_t seed, int channels,
            const RayStream& rays, FlightStream& flights, WalkStatistics& statistics) const;

 private:
  struct Visit;
  class Streams;

  std::vector<Visit> first_visits(const RayStream& rays, std::vector<std::size_t>& ends) const;

  const Medium& medium_;
  Vec3d origin_;
  Matrix4d ray_to_grid_;        ///< Map from where rays are, relative to the origin, to the grid.
  std::vector<Vec3d> middles_;  ///< Middles of the parts, relative to the origin.
  /// Radiance of the parts.
  std::vector<std::shared_ptr<const std::vector<RadianceView>>> radiance_;
};

}  // namespace freepath
