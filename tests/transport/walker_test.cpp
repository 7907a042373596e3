// What a flight is a function of: the ray and the seed, and nothing else.

#include "freepath/transport/walker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/transport/kernels.h"
#include "tests/statistics.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {
namespace {

/// A homogeneous box of 60³ voxels around the origin.
Medium homogeneous_box(float sigma_t) {
  Component component;
  component.density = make_field(Vec3i(-30), Vec3i(29), [](const Vec3i&) { return 1.0F; });
  component.sigma_s = Rgb(sigma_t);
  return Medium({component}, 16);
}

/// Two components, and before them one that neither scatters nor absorbs, if wanted.
Medium two_components(bool with_another, MediumChannels& channels) {
  std::vector<Component> components;
  channels.count = 1;
  channels.components.clear();
  for (int k = with_another ? 0 : 1; k < 3; ++k) {
    Component component;
    component.density = make_field(Vec3i(-12), Vec3i(11), [&](const Vec3i& p) {
      return 0.2F + hash_noise(p + Vec3i(100 * k, 0, 0));
    });
    components.push_back(component);
    ComponentChannels& values = channels.components.emplace_back();
    values.sigma_s[0] = k == 0 ? 0.0F : 0.05F * static_cast<float>(k);
    values.sigma_a[0] = k == 2 ? 0.04F : 0.0F;
  }
  return Medium(components, 8);
}

TEST(Walker, DoesNotLookAtComponentsOfNoMatter) {
  MediumChannels all;
  MediumChannels few;
  const Medium with = two_components(true, all);
  const Medium without = two_components(false, few);
  const RayStream rays = repeat_ray(Vec3f(-20, 0.3F, 0.2F), Vec3f(0.8F, 0.6F, 0), 60, 3000);
  for (const char* const tracker : {"delta", "decomposition", "multi-volume"}) {
    SCOPED_TRACE(tracker);
    WalkSettings settings;
    settings.tracker = tracker;
    FlightStream found;
    FlightStream expected;
    WalkStatistics counts;
    WalkStatistics expected_counts;
    Walker(with, all, settings).free_paths(rays, found, counts);
    Walker(without, few, settings).free_paths(rays, expected, expected_counts);
    EXPECT_EQ(counts.lookups, expected_counts.lookups);
    EXPECT_GT(counts.lookups, rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(found.t[i], expected.t[i]);
      ASSERT_EQ(found.event[i], expected.event[i]);
      ASSERT_EQ(found.weight[0][i], expected.weight[0][i]);
      if (found.event[i] != Event::kScatter) continue;
      ASSERT_EQ(found.component[i], expected.component[i] + 1);
    }
  }
}

// The first tentative collision is real, and its distance comes from the first number of the
// stream.
TEST(Walker, LanesDrawTheNumbersOfTheScalarGenerator) {
  constexpr float kSigma = 0.4F;
  constexpr std::size_t kRays = 5000;
  const Medium medium = homogeneous_box(kSigma);
  for (const uint64_t seed : {uint64_t{0}, uint64_t{12345}, uint64_t{0xFEDCBA9876543210}}) {
    RayStream rays = repeat_ray(Vec3f(-0.5F), Vec3f(0.6F, 0, 0.8F), 1e6F, kRays);
    RandomStream random(1, 2, 3, 4);
    for (std::size_t i = 0; i < kRays; ++i) {
      rays.pixel[i] = random.bits();
      rays.sample[i] = random.bits();
      rays.stream[i] = random.bits() >> 20;
    }
    for (const Simd simd : available_simd()) {
      WalkSettings settings;
      settings.interpolation = Interpolation::kNearest;
      settings.simd = simd;
      settings.seed = seed;
      FlightStream flights;
      WalkStatistics statistics;
      Walker(medium, settings).free_paths(rays, flights, statistics);
      for (std::size_t i = 0; i < kRays; ++i) {
        const float expected =
            RandomStream(seed, rays.pixel[i], rays.sample[i], rays.stream[i]).exponential() /
            kSigma;
        if (expected * 0.8F > 30) {
          ASSERT_EQ(flights.event[i], Event::kEscape);
          ASSERT_NEAR(flights.t[i], 37.5F, 1e-4F);
        } else {
          ASSERT_EQ(flights.event[i], Event::kScatter);
          ASSERT_NEAR(flights.t[i], expected, 1e-5F * expected) << to_string(simd);
        }
      }
    }
  }
}

/// Two components with emission and grey extinction, so that flights fill every column.
const Medium& colourful_medium() {
  static const Medium kMedium = [] {
    std::vector<Component> components(2);
    for (int k = 0; k < 2; ++k) {
      components[k].density = lumpy_field(k);
      components[k].sigma_s = Rgb(0.75F, 0.5F, 0.25F);
      components[k].sigma_a = Rgb(0.25F, 0.5F, 0.75F);
      components[k].emission = Rgb(1, 2, float(3 + k));
    }
    return Medium(std::move(components), 8);
  }();
  return kMedium;
}

/// Rays of all kinds: through the field, beside it, out of it, short ones; each its own stream.
RayStream various_rays(std::size_t count) {
  RandomStream random(9, 9, 9, 9);
  RayStream rays;
  rays.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Vec3f origin;
    Vec3f direction;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = 4 * random.uniform() - 2;
      direction[axis] = random.uniform() - 0.5F;
    }
    direction.normalize();
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = origin[axis];
      rays.direction[axis][i] = direction[axis];
    }
    rays.t_max[i] = i % 3 == 0 ? random.uniform() : 1e9F;
    rays.pixel[i] = random.bits();
    rays.sample[i] = random.bits();
    rays.stream[i] = random.bits();
  }
  return rays;
}

/// The rays named by their slots, in that order.
RayStream select(const RayStream& rays, const std::vector<std::size_t>& slots) {
  RayStream selected;
  selected.resize(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      selected.origin[axis][i] = rays.origin[axis][slots[i]];
      selected.direction[axis][i] = rays.direction[axis][slots[i]];
    }
    selected.t_max[i] = rays.t_max[slots[i]];
    selected.pixel[i] = rays.pixel[slots[i]];
    selected.sample[i] = rays.sample[slots[i]];
    selected.stream[i] = rays.stream[slots[i]];
  }
  return selected;
}

/// All that a flight says, to be compared bit for bit.
std::vector<float> flight_values(const FlightStream& flights, std::size_t i, int channels) {
  std::vector<float> values = {flights.t[i], float(flights.event[i]), float(flights.lookups[i])};
  if (flights.event[i] == Event::kScatter) values.push_back(flights.component[i]);
  for (int channel = 0; channel < channels; ++channel) {
    values.push_back(flights.weight[channel][i]);
    values.push_back(flights.emitted[channel][i]);
  }
  return values;
}

struct Walked {
  std::vector<std::vector<float>> flights;
  WalkStatistics statistics;
};

/// How a stream is walked.
struct Method {
  WalkSettings settings;
  bool transmittance = false;
  std::string name;
};

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const Interpolation interpolation : kInterpolations) {
    const auto add = [&](const char* name, bool transmittance, Absorption absorption) {
      Method method;
      (transmittance ? method.settings.transmittance : method.settings.tracker) = name;
      method.settings.interpolation = interpolation;
      method.settings.absorption = absorption;
      method.transmittance = transmittance;
      method.name = std::string(name) + ", " + name_of(interpolation);
      methods.push_back(method);
    };
    for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
      add("delta", false, absorption);
      add("weighted-delta:rate-scale=0.7", false, absorption);
      add("weighted-delta:rate-scale=2", false, absorption);
    }
    for (const char* name : {"delta", "ratio", "ratio:roulette=0,rate-scale=0.7"}) {
      add(name, true, Absorption::kWeighted);
    }
  }
  return methods;
}

/// Walks a stream in batches.
Walked fly(const Method& method, const RayStream& rays, std::size_t batch) {
  const bool shares = shares_paths(colourful_medium(), method.settings);
  const Walker walker(colourful_medium(), method.settings, shares ? Walker::kAllChannels : 0);
  Walked flown;
  FlightStream flights;
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    std::vector<std::size_t> slots(std::min(batch, rays.size() - begin));
    std::iota(slots.begin(), slots.end(), begin);
    const RayStream part = select(rays, slots);
    const int channels = method.transmittance ? 1 : walker.channels();
    if (method.transmittance) {
      walker.transmittance(part, flights, flown.statistics);
    } else {
      walker.free_paths(part, flights, flown.statistics);
    }
    for (std::size_t i = 0; i < slots.size(); ++i) {
      flown.flights.push_back(flight_values(flights, i, channels));
    }
  }
  return flown;
}

void expect_same_statistics(const WalkStatistics& a, const WalkStatistics& b,
                            const std::string& name) {
  EXPECT_EQ(a.rays, b.rays) << name;
  EXPECT_EQ(a.tentative_collisions, b.tentative_collisions) << name;
  EXPECT_EQ(a.null_collisions, b.null_collisions) << name;
  EXPECT_EQ(a.real_collisions, b.real_collisions) << name;
  EXPECT_EQ(a.lookups, b.lookups) << name;
  EXPECT_EQ(a.super_voxel_steps, b.super_voxel_steps) << name;
  EXPECT_EQ(a.bound_violations, b.bound_violations) << name;
  EXPECT_EQ(a.negative_weights, b.negative_weights) << name;
  EXPECT_EQ(a.largest_weight, b.largest_weight) << name;
}

TEST(Walker, FlightsDependNeitherOnSlotsNorOnBatchesNorOnNeighbours) {
  constexpr std::size_t kRays = 1500;
  const RayStream rays = various_rays(kRays);
  std::vector<std::size_t> order(kRays);
  std::iota(order.begin(), order.end(), std::size_t{0});
  RandomStream random(1, 0, 0, 0);
  for (std::size_t i = kRays - 1; i > 0; --i) std::swap(order[i], order[random.bits() % (i + 1)]);
  for (const Method& method : all_methods()) {
    const Walked together = fly(method, rays, kRays);
    const Walked shuffled = fly(method, select(rays, order), kRays);
    for (std::size_t i = 0; i < kRays; ++i) {
      ASSERT_EQ(shuffled.flights[i], together.flights[order[i]]) << method.name;
    }
    expect_same_statistics(shuffled.statistics, together.statistics, method.name);
    for (const std::size_t batch : {1, 7, 16, 17, 400}) {
      const Walked apart = fly(method, rays, batch);
      ASSERT_EQ(apart.flights, together.flights) << method.name << ", batches of " << batch;
      expect_same_statistics(apart.statistics, together.statistics, method.name);
    }
  }
}

/// Every tracker and estimator that walks in lanes, under every interpolation.
std::vector<Method> all_lane_methods() {
  std::vector<Method> methods;
  const auto add = [&](const MethodInfo& info, bool transmittance) {
    for (const Interpolation interpolation : kInterpolations) {
      Method method;
      (transmittance ? method.settings.transmittance : method.settings.tracker) = info.name;
      method.settings.interpolation = interpolation;
      method.transmittance = transmittance;
      method.name = std::string(info.name) + ", " + name_of(interpolation);
      methods.push_back(method);
    }
  };
  const auto is_in_lanes = [](const std::vector<Kernel>& kernels, std::string_view name) {
    return std::any_of(kernels.begin(), kernels.end(), [&](const Kernel& kernel) {
      return kernel.info.name == name && !kernel.uniform_emission;
    });
  };
  const KernelTable& table = kernels(Simd::kOneLane);
  for (const MethodInfo& info : tracker_infos()) {
    if (is_in_lanes(table.trackers, info.name)) add(info, false);
  }
  for (const MethodInfo& info : transmittance_infos()) {
    if (is_in_lanes(table.transmittance, info.name)) add(info, true);
  }
  return methods;
}

// One lane and SSE4 have no fused multiply-add.
TEST(Walker, EveryTargetGivesTheSameBits) {
  const RayStream rays = various_rays(5'000);
  const std::vector<Method> methods = all_lane_methods();
  ASSERT_GE(methods.size(), 3 * (8U + 4U));
  ASSERT_GE(available_simd().size(), 2U);
  for (Method method : methods) {
    method.settings.simd = Simd::kOneLane;
    const Walked one = fly(method, rays, rays.size());
    for (const Simd simd : available_simd()) {
      if (simd == Simd::kOneLane) continue;
      method.settings.simd = simd;
      const Walked other = fly(method, rays, rays.size());
      const std::string name = method.name + ", " + std::string(to_string(simd));
      ASSERT_EQ(one.flights, other.flights) << name;
      expect_same_statistics(one.statistics, other.statistics, name);
    }
  }
}

TEST(Walker, CountsAddUp) {
  const RayStream rays = various_rays(20'000);
  for (const Method& method : all_methods()) {
    const Walked flown = fly(method, rays, 1000);
    const WalkStatistics& s = flown.statistics;
    EXPECT_EQ(s.rays, rays.size());
    EXPECT_EQ(s.null_collisions + s.real_collisions, s.tentative_collisions);
    EXPECT_EQ(s.lookups, 2 * s.tentative_collisions) << "two components";
    EXPECT_EQ(s.bound_violations, 0U) << method.name;
    double lookups = 0;
    uint64_t ended = 0;
    for (const std::vector<float>& flight : flown.flights) {
      if (Event(static_cast<uint8_t>(flight[1])) != Event::kEscape) ++ended;
      lookups += flight[2];
    }
    EXPECT_EQ(s.real_collisions, ended) << method.name;
    EXPECT_EQ(lookups, static_cast<double>(s.lookups)) << method.name;
    const bool below_bound = method.name.find("0.7") != std::string::npos;
    EXPECT_EQ(s.negative_weights > 0, below_bound) << method.name;
  }
}

TEST(Walker, SeedsMakeOtherFlights) {
  const RayStream rays = various_rays(100);
  Method method = all_methods()[0];
  const Walked before = fly(method, rays, 100);
  for (const uint64_t seed : {uint64_t{1}, uint64_t{1} << 32}) {
    method.settings.seed = seed;
    EXPECT_NE(fly(method, rays, 100).flights, before.flights);
  }
}

TEST(Walker, RefusesAllChannelsWhereTheExtinctionIsChromatic) {
  Component component;
  component.density = lumpy_field();
  component.sigma_s = Rgb(1, 2, 3);
  const Medium medium({component});
  EXPECT_THROW(Walker(medium, WalkSettings{}), Error);
  for (int channel = 0; channel < kChannels; ++channel) {
    EXPECT_EQ(Walker(medium, WalkSettings{}, channel).channels(), 1);
  }
}

TEST(Walker, RefusesUnknownMethods) {
  WalkSettings settings;
  settings.tracker = "ratio";
  EXPECT_THROW(Walker(colourful_medium(), settings), Error);
  settings.tracker = "delta";
  settings.transmittance = "weighted-delta";
  EXPECT_THROW(Walker(colourful_medium(), settings), Error);
}

TEST(Simd, NamesAreReadBack) {
  for (const Simd simd : available_simd()) EXPECT_EQ(parse_simd(to_string(simd)), simd);
  EXPECT_EQ(parse_simd("best"), Simd::kBest);
  EXPECT_EQ(to_string(Simd::kBest), to_string(available_simd().front()));
  EXPECT_EQ(available_simd().back(), Simd::kOneLane);
  EXPECT_THROW(parse_simd("mmx"), Error);
}

}  // namespace
}  // namespace freepath::testing
