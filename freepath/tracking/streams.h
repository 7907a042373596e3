#pragma once
/// @file The streams that a walk reads and writes: structures of arrays, one slot a ray.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/tracking/statistics.h"

namespace freepath {

/// Arrays of a stream are padded to this many slots, so that lanes may read past the last ray.
inline constexpr std::size_t kStreamPadding = 16;

/// Rays to walk. A random number of a ray is a function of (seed, pixel, sample, stream) and of how
/// many it has drawn, never of its slot.
struct RayStream {
  std::array<std::vector<float>, 3> origin;     ///< [world]
  std::array<std::vector<float>, 3> direction;  ///< [world]; t counts its lengths, so make it unit.
  std::vector<float> t_max;                     ///< End of the ray [world], may be infinite.
  std::vector<uint32_t> pixel;
  std::vector<uint32_t> sample;
  std::vector<uint32_t> stream;  ///< See stream_number().
  /// Throughput of the paths so far, where it is set: flights go on from these weights and not from
  /// 1, and methods that look at the path's history see it.
  std::array<std::vector<float>, kMaxChannels> weight;
  /// Relative densities of those paths, had each channel been the hero (FlightStream::density).
  std::array<std::vector<float>, kMaxChannels> density;

  std::size_t size() const { return count_; }
  /// Whether the rays bring weights along.
  bool weighted() const { return !weight[0].empty(); }
  /// Makes room for weights and densities, or takes it away.
  void set_weighted(bool wanted) {
    for (auto* group : {&weight, &density}) {
      for (auto& values : *group) values.resize(wanted ? t_max.size() : 0, 1.0F);
    }
  }
  void resize(std::size_t count) {
    count_ = count;
    const std::size_t padded = count + kStreamPadding;
    if (padded <= t_max.size()) return;
    for (auto& values : origin) values.resize(padded);
    for (auto& values : direction) values.resize(padded);
    t_max.resize(padded);
    for (auto* values : {&pixel, &sample, &stream}) values->resize(padded);
    if (weighted()) set_weighted(true);
  }

 private:
  std::size_t count_ = 0;
};

/// What became of the rays, in the same slots. Weights start at 1, or at those of the rays; a walk
/// of one channel writes the first weight alone.
struct FlightStream {
  std::vector<float> t;  ///< Distance flown [world].
  std::vector<Event> event;
  std::vector<uint8_t> component;  ///< Number of the component that scatters.
  std::array<std::vector<float>, kMaxChannels> weight;
  std::array<std::vector<float>, kMaxChannels> emitted;  ///< Emitted radiance collected on the way.
  /// Relative densities, with hero-wavelength: of the path, to be handed on with its next ray.
  std::array<std::vector<float>, kMaxChannels> density;
  std::vector<uint32_t> lookups;

  std::size_t size() const { return count_; }
  void resize(std::size_t count) {
    count_ = count;
    if (count + kStreamPadding <= t.size()) return;
    const std::size_t padded = count + kStreamPadding;
    t.resize(padded);
    event.resize(padded);
    component.resize(padded);
    for (auto& values : weight) values.resize(padded);
    for (auto& values : emitted) values.resize(padded);
    for (auto& values : density) values.resize(padded, 1.0F);
    lookups.resize(padded);
  }

 private:
  std::size_t count_ = 0;
};

}  // namespace freepath
