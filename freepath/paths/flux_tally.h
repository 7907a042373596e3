#pragma once
/// @file What paths of light have brought, summed.

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "freepath/base/moments.h"
#include "freepath/base/vector.h"
#include "freepath/paths/flux_meter.h"

namespace freepath {

/// Paths that are traced and summed together: what they bring lies in a core's second cache.
inline constexpr uint64_t kPathsPerChunk = 2048;

/// What one path of light, with all its branches, has brought to cells of a FluxMeter.
class FluxRecord {
 public:
  struct Deposit {
    uint32_t cell = 0;
    double weight = 0;
  };
  /// What sets a branch of a path apart from the others.
  struct Branch {
    Vec3f origin, direction;
    float weight, density;
    uint32_t pixel, level, flights, scatterings;
  };

  void add(uint32_t cell, double weight) {
    for (uint32_t i = 0; i < count_; ++i) {
      if (at(i).cell == cell) {
        at(i).weight += weight;
        return;
      }
    }
    if (count_ >= kFew) more_.resize(count_ - kFew + 1);
    at(count_++) = {cell, weight};
  }
  void clear() {
    count_ = 0;
    branches = 1;
    more_.clear();
    waiting.clear();
  }
  /// Calls f(Deposit) for each.
  template <class Function>
  void for_each(Function f) const {
    for (uint32_t i = 0; i < count_; ++i) f(i < kFew ? few_[i] : more_[i - kFew]);
  }

  uint32_t branches = 1;  ///< Branches so far, the path itself included.
  /// Branches that were split off and have yet to fly: one after the other, the latest first, so
  /// that no sum depends on what else is under way.
  std::vector<Branch> waiting;

 private:
  Deposit& at(uint32_t i) { return i < kFew ? few_[i] : more_[i - kFew]; }

  static constexpr uint32_t kFew = 4;  // most paths have no more
  uint32_t count_ = 0;
  std::array<Deposit, kFew> few_;
  std::vector<Deposit> more_;
};

/// Sums over paths, in the order of their numbers, whoever traces them. A path and its branches are
/// one value, so that errors are those of independent paths.
class FluxTally {
 public:
  explicit FluxTally(const FluxMeter& meter);

  /// Adds the paths of a chunk. Safe to be called from any thread, once for each chunk; chunks that
  /// come before their turn wait.
  /// @param chunk their number, counted from 0
  void add(uint64_t chunk, std::span<const FluxRecord> records);

  /// Paths whose sums are complete: those of chunks without one missing before.
  uint64_t paths() const;
  /// The whole domain. To be called after the last path, as all that follow.
  Estimate all(uint32_t kind, bool possible) const;
  /// A column, as a fraction of what falls on one.
  Estimate column(uint32_t cell, bool possible) const;
  /// What leaves by the top and at the bottom together.
  Estimate leaving(bool possible) const { return leaving_.estimate(paths_, possible); }
  /// Largest magnitude of what a path brought to the top or the bottom.
  double largest_weight() const { return largest_weight_; }

 private:
  /// A chunk in few bytes: of each path its deposits.
  struct Chunk {
    std::vector<uint32_t> ends;  // of the paths' deposits
    std::vector<FluxRecord::Deposit> deposits;
  };
  void merge(const Chunk& chunk);

  const FluxMeter& meter_;
  mutable std::mutex mutex_;
  std::map<uint64_t, Chunk> waiting_;
  uint64_t next_ = 0;  // chunk
  uint64_t paths_ = 0;
  std::vector<Moments> all_;      // by kind
  std::vector<Moments> columns_;  // by cell; none where there is one column
  Moments leaving_;
  double largest_weight_ = 0;
};

}  // namespace freepath
