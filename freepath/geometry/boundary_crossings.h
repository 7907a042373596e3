#pragma once
/// @file Where a ray goes through boundaries of media.

#include <array>
#include <cstdint>
#include <span>

#include "freepath/geometry/ray_position.h"

namespace freepath {

/// Where a ray goes through a shape that is a mere boundary.
struct BoundaryCrossing {
  RayPosition position;
  uint32_t shape = 0;
  bool enters = false;  ///< direction · normal < 0

  bool is_same(const BoundaryCrossing& other) const {
    return shape == other.shape && enters == other.enters &&
           position.key.instance == other.position.key.instance && position.is_tied(other.position);
  }
};

/// The nearest crossings of a ray in the order of their positions, each once even where the ray
/// goes through the common edge of two triangles.
class BoundaryCrossings {
 public:
  static constexpr uint32_t kCapacity = 32;

  std::span<const BoundaryCrossing> all() const { return {crossings_.data(), count_}; }
  bool empty() const { return count_ == 0; }
  /// There are more, all of them beyond the last of these.
  bool overflowed() const { return overflowed_; }

  void clear();
  void add(const BoundaryCrossing& crossing);

 private:
  std::array<BoundaryCrossing, kCapacity> crossings_;
  uint32_t count_ = 0;
  bool overflowed_ = false;
};

}  // namespace freepath
