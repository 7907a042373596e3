#pragma once
/// @file Rays sorted by the walker that they need.

#include <array>
#include <cstddef>
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
    std::vector<uint32_t> owners;  ///< What the caller calls each ray; there may be room for more.
    std::size_t count = 0;         ///< Number of rays.
  };

  /// @param capacity rays that there will be, or more
  /// @param weighted whether rays of several channels bring weights along
  WalkBatches(std::size_t capacity, bool weighted) : capacity_(capacity), weighted_(weighted) {}

  void clear();

  /// Where to put the next ray of a walker.
  struct Slot {
    Batch& batch;
    std::size_t slot;
  };
  Slot add(const Walker& walker, uint32_t owner) {
    if (last_ >= used_ || batches_[last_].walker != &walker) last_ = number_of(walker);
    Batch& batch = batches_[last_];
    const std::size_t slot = batch.count++;
    if (slot == batch.owners.size()) resize(batch, 2 * slot);
    batch.owners[slot] = owner;
    return {batch, slot};
  }

  /// Where to put the next rays of a walker, one behind the other; the caller writes their owners.
  Slot add_all(const Walker& walker, std::size_t count) {
    if (last_ >= used_ || batches_[last_].walker != &walker) last_ = number_of(walker);
    Batch& batch = batches_[last_];
    const std::size_t slot = batch.count;
    batch.count += count;
    if (batch.count > batch.owners.size()) resize(batch, 2 * batch.count);
    return {batch, slot};
  }

  /// Batches that hold rays, their streams of the right size. To be called after the last ray.
  std::vector<Batch*>& finish();

 private:
  /// The number of a walker's batch, which is made if there is none.
  uint32_t number_of(const Walker& walker) {
    uint32_t& guess = guess_of(walker);
    if (guess >= used_ || batches_[guess].walker != &walker) guess = find(walker);
    return guess;
  }
  uint32_t find(const Walker& walker);
  static void resize(Batch& batch, std::size_t rays);

  /// Where a walker's batch was last, by bits of its address: a guess.
  uint32_t& guess_of(const Walker& walker) {
    constexpr std::size_t kHash = 0x9E3779B97F4A7C15U;
    return guesses_[reinterpret_cast<std::uintptr_t>(&walker) * kHash >> (64 - kGuessBits)];
  }

  static constexpr int kGuessBits = 8;
  std::size_t capacity_;
  bool weighted_;
  std::array<uint32_t, 1U << kGuessBits> guesses_{};
  std::vector<Batch> batches_;  // of walkers, those beyond used_ to be used again
  uint32_t used_ = 0;
  uint32_t last_ = 0;  // of the ray before
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
