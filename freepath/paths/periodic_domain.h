#pragma once
/// @file A domain that repeats sideways, as the cells of atmospheric models do.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "freepath/base/vector.h"

namespace freepath {

/// A box whose sides along some axes are one: what leaves by one comes in by the opposite one.
/// Nothing of the scene is outside it along the other axes. Positions are relative to the scene's
/// origin [world].
class PeriodicDomain {
 public:
  /// Rays that pass so many sides play Russian roulette, so that one which is level ends at last.
  static constexpr uint32_t kSidesPerRoulette = 1024;
  static constexpr float kSurvival = 0.5F;

  /// @param repeats along which axes; one at least
  /// @throws Error for a box that is empty or not finite along one of them
  PeriodicDomain(const Box3d& box, const std::array<bool, 3>& repeats);

  const Box3f& box() const { return box_; }
  const std::array<bool, 3>& repeats() const { return repeats_; }

  /// The way from a point of the domain to the side that a ray comes in again at; infinite where it
  /// leaves for good before.
  float way_to_side(const Vec3f& origin, const Vec3f& direction) const {
    float side = std::numeric_limits<float>::infinity();
    float end = side;
    for (int axis = 0; axis < 3; ++axis) {
      const float d = direction[axis];
      if (d == 0) continue;
      const float way = ((d > 0 ? box_.max : box_.min)[axis] - origin[axis]) / d;
      float& nearest = repeats_[axis] ? side : end;
      nearest = way < nearest ? way : nearest;
    }
    if (!(side < end)) return std::numeric_limits<float>::infinity();
    return side > 0 ? side : 0;
  }

  /// Where a ray that has come to a side goes on.
  /// @param way way_to_side of that ray
  Vec3f beyond_side(const Vec3f& origin, const Vec3f& direction, float way) const;

  /// A point and its like in the domain are one: the latter.
  Vec3f fold(const Vec3d& point) const;

  /// Where a ray from anywhere comes into the domain.
  struct Entry {
    Vec3f origin;
    float way = 0;  ///< Distance from where the ray began.
  };
  /// Nothing for a ray that never does.
  std::optional<Entry> enter(const Vec3d& origin, const Vec3f& direction) const;

 private:
  Box3d exact_;
  Box3f box_;
  std::array<bool, 3> repeats_;
};

}  // namespace freepath
