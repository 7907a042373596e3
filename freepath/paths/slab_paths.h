#pragma once
/// @file Paths through plane-parallel layers, many at once, and what they carry out.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/media/phase/phase_function.h"
#include "freepath/paths/slab.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// Sums over paths of what left a slab.
struct SlabSums {
  /// First and second moments over paths.
  struct Moments {
    double sum = 0;
    double squares = 0;
    uint64_t contributions = 0;  ///< Paths that brought anything.
    void add(double weight);
    void merge(const Moments& other);
    /// Mean and standard error.
    /// @param possible whether paths can bring anything at all
    SlabEstimate estimate(uint64_t count, bool possible) const;
  };
  Moments top, bottom, unscattered, total;
  double largest_weight = 0;
  uint64_t paths = 0;

  void merge(const SlabSums& other);
};

/// Traces chunks of paths. One for each thread; its memory is used again.
///
/// Where a path comes down through a plane of SlabMedium::splits it becomes two of half the weight;
/// on the way up one of two is ended, and the other has twice the weight. Both are unbiased
/// whatever the planes are, and so is stopping at a plane, since flights have no memory. What a
/// path and its branches bring is one sample, so that the standard errors are those of independent
/// paths. A path's branches are traced one after the other, the latest first: no sum depends on the
/// batch.
class SlabPaths {
 public:
  SlabPaths(const SlabMedium& slab, const Walker& walker, const SlabSettings& settings);

  /// Traces the paths [first, first + count) and sums them in the order of their numbers.
  SlabSums trace(uint64_t first, uint64_t count);

 private:
  /// A branch of a path in flight, the first of which is the path itself.
  struct Branch {
    uint32_t number = 0;  ///< Among the branches of its path.
    float weight = 1;     ///< Times 2^level.
    uint32_t level = 0;   ///< Planes that lie above.
    uint32_t flights = 0;
    bool scattered = false;
    float z = 0;
    Vec3f direction{0};
  };
  /// A path in flight. Its branch's ray stands in the same slot of rays_.
  struct Path {
    uint64_t number = 0;  ///< Within the chunk.
    uint32_t branches = 1;
    Branch branch;
  };
  /// What a path has brought.
  struct Outcome {
    double top = 0;
    double bottom = 0;
    double unscattered = 0;
  };

  RandomStream random(const Path& path, StreamPurpose purpose) const;
  uint32_t pixel_key(const Path& path) const;
  void start_path(uint64_t number, Path& path) const;
  void set_ray(std::size_t slot);
  /// Takes in what became of the flight in a slot. False if its branch has ended.
  bool advance(std::size_t slot);
  void leave(const Path& path, bool top);
  /// Whether a branch goes on beyond the plane that it has come to.
  bool cross_plane(std::size_t slot);
  bool scatter(Path& path, float t, std::size_t component);
  SlabSums sum() const;

  const SlabMedium& slab_;
  const Walker& walker_;
  const SlabSettings& settings_;
  std::vector<PhaseFunction> phases_;  // of the components
  uint64_t first_path_ = 0;
  std::vector<Path> paths_;
  std::vector<std::vector<Branch>> waiting_;  // branches of the paths, in the same slots
  std::vector<Outcome> outcomes_;
  RayStream rays_;
  FlightStream flights_;
  WalkStatistics statistics_;
};

}  // namespace freepath
