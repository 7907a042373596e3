#pragma once
/// @file Rays sorted by the walker that they need.

#include <cstdint>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// Collects rays for several walkers, one stream for each. Its memory is used again.
class WalkBatches {
 public:
  /// Rays of one walker, and what they stand for.
  struct Batch {
    const Walker* walker = nullptr;
    RayStream rays;
    std::vector<uint32_t> owners;  ///< What the caller calls each ray.
  };

  /// @param capacity rays to make room for at once; there may be more
  /// @param weighted whether rays of several channels bring weights along
  WalkBatches(std::size_t capacity, bool weighted) : capacity_(capacity), weighted_(weighted) {}

  void clear();

  /// Where to put the next ray of a walker.
  struct Place {
    Batch& batch;
    std::size_t slot;
  };
  Place add(const Walker& walker, uint32_t owner);

  /// Those that hold rays, their streams of the right size. To be called after the last ray.
  std::vector<Batch*>& finish();

 private:
  std::size_t capacity_;
  bool weighted_;
  std::vector<Batch> batches_;  // of walkers, those beyond used_ to be used again
  std::size_t used_ = 0;
  std::size_t last_ = 0;
  std::vector<Batch*> finished_;
};

/// Writes a ray into a stream.
inline void set_ray(RayStream& rays, std::size_t slot, const Vec3f& origin, const Vec3f& direction,
                    float t_max) {
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][slot] = origin[axis];
    rays.direction[axis][slot] = direction[axis];
  }
  rays.t_max[slot] = t_max;
}

}  // namespace freepath
