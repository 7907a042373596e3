#pragma once
/// @file Russian roulette of shadow rays, in numbers that lanes read.

#include <algorithm>

#include "freepath/base/vector.h"

namespace freepath {

/// Coarse transmittances of a medium towards the direction from which most of the light comes, what
/// a shadow ray has to bring for it to be cast in any case, and how often paths split towards
/// that direction (ShadowGuide makes them).
struct ShadowRoulette {
  /// Rays are cast with this probability at least, so that none counts for much more than others.
  static constexpr float kLeastSurvival = 0.1F;
  /// Directions whose cosine with the dominant one reaches this count as that.
  static constexpr float kSameDirection = 0.985F;

  /// Brightness from which on every ray is cast: mean of the channels, in units of white, of what
  /// it is expected to bring. 0: all are.
  float least = 0;
  Vec3f dominant{0};  ///< Direction towards the light, unit [world].
  Vec3f corner{0};    ///< Corner of the cells [world, relative to the scene's origin].
  Vec3f per_cell{0};  ///< Cells in a unit of length [1/world].
  Vec3i counts{0};    ///< Number of cells along each axis.
  /// Roots of the transmittances of cells, x fastest, above 0; null: none is known.
  const float* roots = nullptr;
  /// Factor of what a path is expected to bring of the dominant light (LobeBranch), over what an
  /// isotropic scattering of all light does: this times its throughput, the density with which two
  /// scatterings would turn it into the dominant direction, and the cell's value. Up to 1 it is the
  /// chance with which a path splits; a branch is worth that or its throughput, whichever is more,
  /// when it plays Russian roulette. 0: none splits.
  float lobe_scale = 0;
  /// Least root of transmittance for the chance of splitting: a coarse cell may look dark of which
  /// an edge is lit, and where nothing splits peaks are as they were.
  static constexpr float kLeastRoot = 0.1F;
  /// Chances below are none. Small ones take little time, and yet hold what paths bring that come
  /// to a sharp peak by chance.
  static constexpr float kLeastLobeChance = 1e-4F;

  /// The probability with which to cast a ray, (0, 1]; if it is cast, what it brings is to be
  /// divided by that. The lanes compute the same in the same order (transport/scattering-inl.h).
  /// @param position where it begins [world, relative to the scene's origin]
  /// @param direction towards the light
  /// @param brightness of what it would bring unshadowed
  float survival(const Vec3f& position, const Vec3f& direction, float brightness) const {
    float expected = brightness;
    if (roots != nullptr && direction.dot(dominant) >= kSameDirection) {
      int cell = 0;
      for (int axis = 2; axis >= 0; --axis) {
        const float at = (position[axis] - corner[axis]) * per_cell[axis];
        const auto last = static_cast<float>(counts[axis] - 1);
        cell = cell * counts[axis] + static_cast<int>(std::min(std::max(at, 0.0F), last));
      }
      expected *= roots[cell];
    }
    if (!(expected < least)) return 1;
    return std::max(expected / least, kLeastSurvival);
  }
};

}  // namespace freepath
