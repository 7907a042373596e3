#pragma once
/// @file The streams that a walk reads and writes: structures of arrays, one slot a ray.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/spectrum.h"
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

  std::size_t size() const { return count_; }
  void resize(std::size_t count) {
    count_ = count;
    const std::size_t padded = count + kStreamPadding;
    if (padded <= t_max.size()) return;
    for (auto& values : origin) values.resize(padded);
    for (auto& values : direction) values.resize(padded);
    t_max.resize(padded);
    for (auto* values : {&pixel, &sample, &stream}) values->resize(padded);
  }

 private:
  std::size_t count_ = 0;
};

/// What became of the rays, in the same slots. Weights start at 1; a walk of one channel writes the
/// first weight alone.
struct FlightStream {
  std::vector<float> t;  ///< Distance flown [world].
  std::vector<Event> event;
  std::vector<uint8_t> component;  ///< Of a scattering.
  std::array<std::vector<float>, kChannels> weight;
  std::array<std::vector<float>, kChannels> emitted;  ///< Emitted radiance collected on the way.
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
    lookups.resize(padded);
  }

 private:
  std::size_t count_ = 0;
};

}  // namespace freepath
