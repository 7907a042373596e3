// Free paths and transmittances of rays in arrays, on all threads.

#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/moments.h"
#include "freepath/base/random.h"
#include "freepath/base/threads.h"
#include "freepath/tracking/statistics_fields.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/counts.h"
#include "python/src/interruptible.h"
#include "python/src/media.h"
#include "python/src/ray_arrays.h"
#include "python/src/walk_options.h"

namespace freepath::python {

WalkSettings walk_settings(const WalkOptions& options) {
  WalkSettings settings;
  settings.tracker = options.tracker;
  settings.transmittance = options.transmittance;
  const auto choose = [](const char* name, const std::string& word, const auto& choices) {
    std::string known;
    for (const auto& [text, value] : choices) {
      if (word == text) return value;
      if (!known.empty()) known += ", ";
      known += text;
    }
    fail("{} '{}' is unknown; there are: {}", name, word, known);
  };
  settings.interpolation = choose("interpolation", options.interpolation,
                                  std::array{std::pair{"nearest", Interpolation::kNearest},
                                             std::pair{"trilinear", Interpolation::kTrilinear},
                                             std::pair{"stochastic", Interpolation::kStochastic}});
  settings.absorption = choose("absorption", options.absorption,
                               std::array{std::pair{"analog", Absorption::kAnalog},
                                          std::pair{"weighted", Absorption::kWeighted}});
  settings.emission = choose("emission", options.emission,
                             std::array{std::pair{"collision", EmissionTally::kCollision},
                                        std::pair{"analog", EmissionTally::kAnalog}});
  settings.simd = parse_simd(options.simd);
  settings.seed = options.seed;
  return settings;
}

nb::dict counts_to_python(const WalkStatistics& counts) {
  nb::dict result;
  visit_statistics(counts, [&](const char* name, const auto& count) { result[name] = count; });
  return result;
}

namespace {

/// Slots of a batch: streams of so many stay in the nearer caches.
constexpr std::size_t kBatch = 2048;

/// What a thread walks with.
struct ThreadStreams {
  RayStream rays;
  FlightStream flights;
  WalkStatistics counts;
};
using AllStreams = tbb::enumerable_thread_specific<ThreadStreams>;

WalkStatistics total(const AllStreams& spaces) {
  WalkStatistics sum;
  for (const ThreadStreams& space : spaces) sum.merge(space.counts);
  return sum;
}

/// Calls work(begin, end) for all batches of `count` things, on all threads, until it is stopped.
template <class Work>
void for_batches(std::size_t count, std::size_t batch, int threads, const std::atomic<bool>& stop,
                 const Work& work) {
  const std::size_t batches = (count + batch - 1) / batch;
  Threads(threads).execute([&] {
    tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t i) {
      if (!stop) work(i * batch, std::min(count, (i + 1) * batch));
    });
  });
}

/// What becomes of rays: arrays of one value each, or one for each channel.
struct Flights {
  Flights(std::size_t count, std::size_t channels, bool emits)
      : distance(count),
        event(count),
        component(count),
        lookups(count),
        weight(count * channels),
        emitted(emits ? count * channels : 0) {}

  ArrayMemory<float> distance;
  ArrayMemory<uint8_t> event;
  ArrayMemory<int8_t> component;
  ArrayMemory<uint32_t> lookups;
  ArrayMemory<float> weight;
  ArrayMemory<float> emitted;
};

/// Copies the flights of a batch to their places.
/// @param walked channels of the walk: 1 stands for all
void keep_flights(const FlightStream& from, std::size_t begin, std::size_t channels, int walked,
                  bool emits, Flights& to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t ray = begin + i;
    to.distance.data()[ray] = from.t[i];
    to.event.data()[ray] = static_cast<uint8_t>(from.event[i]);
    to.component.data()[ray] =
        from.event[i] == Event::kScatter ? static_cast<int8_t>(from.component[i]) : int8_t{-1};
    to.lookups.data()[ray] = from.lookups[i];
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t walked_channel = walked == 1 ? 0 : c;
      to.weight.data()[ray * channels + c] = from.weight[walked_channel][i];
      if (emits) to.emitted.data()[ray * channels + c] = from.emitted[walked_channel][i];
    }
  }
}

void check_channels(const PythonMedium& medium, const std::vector<int>& channels) {
  for (const int channel : channels) {
    if (channel < 0 || channel >= medium.channels.count) {
      fail("channel {} is none of the medium's, 0 to {}", channel, medium.channels.count - 1);
    }
  }
}

nb::tuple sample_free_paths(const PythonMedium& medium, const VectorArray& origins,
                            const VectorArray& directions, const NumberArray& t_max,
                            const WalkOptions& options, const std::vector<int>& channels,
                            int threads) {
  check_channels(medium, channels);
  const RayArrays source(origins, directions, t_max);
  const MediumChannels carried = medium.selected(channels);
  const auto count = static_cast<std::size_t>(carried.count);
  const bool emits = carried.emits();
  WalkSettings settings = walk_settings(options);
  settings.origin = medium.origin();
  settings.tracker = settle_tracker(settings.tracker, *medium.medium, carried).tracker;
  const Walker walker(*medium.medium, carried, settings);
  Flights flights(source.size(), count, emits);
  AllStreams spaces;
  run_interruptibly([&](const std::atomic<bool>& stop) {
    for_batches(source.size(), kBatch, threads, stop, [&](std::size_t begin, std::size_t end) {
      ThreadStreams& space = spaces.local();
      space.rays.resize(end - begin);
      for (std::size_t ray = begin; ray < end; ++ray) {
        const std::size_t slot = ray - begin;
        source.put(ray, settings.origin, slot, space.rays);
        space.rays.pixel[slot] = static_cast<uint32_t>(uint64_t{ray} >> 32);
        space.rays.sample[slot] = static_cast<uint32_t>(ray);
        space.rays.stream[slot] = stream_number(StreamPurpose::kWalk, 0);
      }
      walker.free_paths(space.rays, space.flights, space.counts);
      keep_flights(space.flights, begin, count, walker.channels(), emits, flights);
    });
  });
  const std::size_t n = source.size();
  return nb::make_tuple(
      std::move(flights.distance).to_numpy({n}), std::move(flights.event).to_numpy({n}),
      std::move(flights.component).to_numpy({n}), std::move(flights.weight).to_numpy({n, count}),
      std::move(flights.lookups).to_numpy({n}),
      emits ? std::move(flights.emitted).to_numpy({n, count}) : nb::object(nb::none()),
      counts_to_python(total(spaces)), settings.tracker);
}

/// Estimates of rays in parts of a batch at most, each by one thread; parts of a ray are added up
/// in their order, so that the sum does not depend on threads.
class TransmittanceParts {
 public:
  TransmittanceParts(std::size_t rays, uint32_t samples, std::size_t channels)
      : rays_(rays),
        samples_(samples),
        channels_(channels),
        parts_of_ray_((samples + kBatch - 1) / kBatch),
        rays_of_batch_(std::max<std::size_t>(1, kBatch / samples)),
        moments_(rays * parts_of_ray_ * channels) {}

  /// Batches of rays, or of samples of one ray.
  std::size_t batches() const {
    return (rays_ + rays_of_batch_ - 1) / rays_of_batch_ * parts_of_ray_;
  }
  struct Batch {
    std::size_t first_ray, last_ray;     // before
    uint32_t first_sample, last_sample;  // before
    std::size_t part;
  };
  Batch batch(std::size_t number) const {
    const std::size_t first = number / parts_of_ray_ * rays_of_batch_;
    const std::size_t part = number % parts_of_ray_;
    return {first, std::min(rays_, first + rays_of_batch_), static_cast<uint32_t>(part * kBatch),
            static_cast<uint32_t>(std::min<std::size_t>(samples_, (part + 1) * kBatch)), part};
  }
  Moments& moments(std::size_t ray, std::size_t part, std::size_t channel) {
    return moments_[(ray * parts_of_ray_ + part) * channels_ + channel];
  }
  /// Mean and standard error of a ray.
  Estimate estimate(std::size_t ray, std::size_t channel) {
    Moments sum;
    for (std::size_t part = 0; part < parts_of_ray_; ++part) sum.merge(moments(ray, part, channel));
    return sum.estimate(samples_);
  }

 private:
  std::size_t rays_;
  uint32_t samples_;
  std::size_t channels_, parts_of_ray_, rays_of_batch_;
  std::vector<Moments> moments_;
};

nb::tuple estimate_transmittance(const PythonMedium& medium, const VectorArray& origins,
                                 const VectorArray& directions, const NumberArray& t_max,
                                 const WalkOptions& options, uint32_t samples,
                                 const std::vector<int>& channels, int threads) {
  check_channels(medium, channels);
  const RayArrays source(origins, directions, t_max);
  const MediumChannels carried = medium.selected(channels);
  const auto count = static_cast<std::size_t>(carried.count);
  WalkSettings settings = walk_settings(options);
  settings.origin = medium.origin();
  settings.tracker = "spectral";  // has no part in it, and shares paths between channels
  const Walker walker(*medium.medium, carried, settings);
  const int walked = walker.transmittance_channels();
  TransmittanceParts parts(source.size(), samples, static_cast<std::size_t>(walked));
  ArrayMemory<double> means(source.size() * count), errors(source.size() * count);
  AllStreams spaces;
  run_interruptibly([&](const std::atomic<bool>& stop) {
    for_batches(parts.batches(), 1, threads, stop, [&](std::size_t number, std::size_t /*end*/) {
      const TransmittanceParts::Batch batch = parts.batch(number);
      ThreadStreams& space = spaces.local();
      const uint32_t each = batch.last_sample - batch.first_sample;
      space.rays.resize((batch.last_ray - batch.first_ray) * each);
      std::size_t slot = 0;
      for (std::size_t ray = batch.first_ray; ray < batch.last_ray; ++ray) {
        for (uint32_t sample = batch.first_sample; sample < batch.last_sample; ++sample, ++slot) {
          source.put(ray, settings.origin, slot, space.rays);
          space.rays.pixel[slot] = static_cast<uint32_t>(ray);
          space.rays.sample[slot] = sample;
          space.rays.stream[slot] = stream_number(StreamPurpose::kShadowWalk, 0);
        }
      }
      walker.transmittance(space.rays, space.flights, space.counts);
      for (std::size_t ray = batch.first_ray; ray < batch.last_ray; ++ray) {
        const std::size_t first = (ray - batch.first_ray) * each;
        for (int c = 0; c < walked; ++c) {
          Moments& moments = parts.moments(ray, batch.part, static_cast<std::size_t>(c));
          for (std::size_t i = first; i < first + each; ++i) {
            moments.add(double{space.flights.weight[c][i]});
          }
        }
      }
    });
    for (std::size_t ray = 0; ray < source.size() && !stop; ++ray) {
      for (std::size_t c = 0; c < count; ++c) {
        const Estimate estimate = parts.estimate(ray, walked == 1 ? 0 : c);
        means.data()[ray * count + c] = estimate.mean;
        errors.data()[ray * count + c] = estimate.error;
      }
    }
  });
  const std::size_t n = source.size();
  return nb::make_tuple(std::move(means).to_numpy({n, count}),
                        std::move(errors).to_numpy({n, count}), counts_to_python(total(spaces)));
}

}  // namespace

void bind_sampling(nb::module_& module) {
  nb::class_<WalkOptions>(module, "WalkOptions")
      .def(nb::init<>())
      .def_rw("tracker", &WalkOptions::tracker)
      .def_rw("transmittance", &WalkOptions::transmittance)
      .def_rw("interpolation", &WalkOptions::interpolation)
      .def_rw("absorption", &WalkOptions::absorption)
      .def_rw("emission", &WalkOptions::emission)
      .def_rw("simd", &WalkOptions::simd)
      .def_rw("seed", &WalkOptions::seed);
  module.def("sample_free_paths", &sample_free_paths, nb::arg("medium"), nb::arg("origins"),
             nb::arg("directions"), nb::arg("t_max"), nb::arg("options"), nb::arg("channels"),
             nb::arg("threads"));
  module.def("transmittance", &estimate_transmittance, nb::arg("medium"), nb::arg("origins"),
             nb::arg("directions"), nb::arg("t_max"), nb::arg("options"), nb::arg("samples"),
             nb::arg("channels"), nb::arg("threads"));
}

}  // namespace freepath::python
