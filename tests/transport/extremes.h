#pragma once
/// @file Media and rays for tests of extreme inputs, and walks of them by every method and target.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freepath/base/random.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline Medium medium_of(std::shared_ptr<Field> field, float sigma_t, int super_voxel = 4) {
  Component component;
  component.density = std::move(field);
  component.sigma_a = Rgb(0.25F * sigma_t);
  component.sigma_s = Rgb(0.75F * sigma_t);
  component.emission = Rgb(1.0F);
  return Medium({component}, super_voxel);
}

/// 24³ voxels of density 1 from -12.5 to 11.5, where super-voxels of 4 have faces; times `scale`.
inline std::shared_ptr<Field> box_field(double scale = 1, const Vec3d& translation = Vec3d(0.0)) {
  Matrix4d matrix;
  matrix.setScale(Vec3d(scale));
  matrix *= Matrix4d().setTranslation(translation);
  return make_field(
      Vec3i(-12), Vec3i(11), [](const Vec3i&) { return 1.0F; }, matrix);
}

/// A ray with a stream of its own for each call.
struct RayList {
  RayStream stream;
  std::vector<TestRay> rays;

  void add(const Vec3f& origin, const Vec3f& direction, float t_max = kInfinity, int copies = 1) {
    for (int i = 0; i < copies; ++i) rays.push_back({origin, direction, t_max});
  }
  const RayStream& finish() {
    stream.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        stream.origin[axis][i] = rays[i].origin[axis];
        stream.direction[axis][i] = rays[i].direction[axis];
      }
      stream.t_max[i] = rays[i].t_max;
      stream.pixel[i] = static_cast<uint32_t>(i);
      stream.sample[i] = 3;
      stream.stream[i] = 0;
    }
    return stream;
  }
};

/// Whether the numbers of a flight are such as a flight may have.
inline ::testing::AssertionResult is_sane(const FlightStream& flights, std::size_t i, bool tally) {
  const bool sane = flights.t[i] >= 0 && std::isfinite(flights.weight[0][i]) &&
                    (!tally || std::isfinite(flights.emitted[0][i])) &&
                    (flights.event[i] == Event::kEscape || flights.event[i] == Event::kScatter ||
                     flights.event[i] == Event::kAbsorb);
  auto result = sane ? ::testing::AssertionSuccess() : ::testing::AssertionFailure();
  return result << "ray " << i << ": t " << flights.t[i] << ", weight " << flights.weight[0][i]
                << ", emitted " << flights.emitted[0][i];
}

/// Runs a check in a child process, which fails instead of hanging if a walk has no end.
inline void expect_to_end(const std::function<void()>& check) {
  constexpr unsigned kSeconds = 300;  // far more than any walk takes, on any machine
  EXPECT_EXIT(
      {
        alarm(kSeconds);
        check();
        _exit(::testing::Test::HasFailure() ? 1 : 0);
      },
      ::testing::ExitedWithCode(0), "");
}

/// Methods that put the density inside an exponential.
inline bool refuses_stochastic(std::string_view tracker) {
  return tracker == "regular" || tracker == "ray-marching";
}

/// Walks the rays by every method, interpolation and target; checks that flights are sane, and what
/// else `check(flights, i, transmittance)` asks of each.
inline void with_every_method(
    const Medium& medium, const RayStream& rays,
    const std::function<void(const FlightStream&, std::size_t, bool)>& check) {
  constexpr const char* kMethods[][2] = {{"delta", "delta"},
                                         {"weighted-delta", "ratio"},
                                         {"weighted-delta:rate-scale=0.7", "ratio:roulette=0"},
                                         {"weighted-delta:rate-scale=2", "ratio:rate-scale=3"},
                                         {"regular", "regular"},
                                         {"ray-marching", "p-series:rate-scale=0.7"},
                                         {"delta", "p-series"},
                                         {"delta", "unbiased-ray-marching"}};
  for (const Simd simd : available_simd()) {
    for (const Interpolation interpolation : kInterpolations) {
      for (const auto& [tracker, estimator] : kMethods) {
        if (interpolation == Interpolation::kStochastic && refuses_stochastic(tracker)) continue;
        SCOPED_TRACE(std::string(to_string(simd)) + ", " + name_of(interpolation) + ", " + tracker +
                     ", " + estimator);
        WalkSettings settings;
        settings.simd = simd;
        settings.interpolation = interpolation;
        settings.tracker = tracker;
        settings.transmittance = estimator;
        const Walker walker(medium, settings);
        FlightStream flights;
        WalkStatistics statistics;
        walker.free_paths(rays, flights, statistics);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          ASSERT_TRUE(is_sane(flights, i, true));
          check(flights, i, false);
        }
        walker.transmittance(rays, flights, statistics);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          ASSERT_TRUE(is_sane(flights, i, false));
          check(flights, i, true);
        }
      }
    }
  }
}

inline void expect_untouched(const FlightStream& flights, std::size_t i) {
  EXPECT_EQ(flights.event[i], Event::kEscape) << "ray " << i;
  EXPECT_EQ(flights.weight[0][i], 1) << "ray " << i;
  EXPECT_EQ(flights.lookups[i], 0U) << "ray " << i;
}

/// In a homogeneous box a flight is the first number of its stream: it ends at `exponential/sigma`,
/// or escapes if that lies beyond `length`. `slack` is what rounding may move a distance by.
inline void expect_homogeneous(const FlightStream& flights, std::size_t i, float sigma,
                               double length, double slack) {
  const double free_path = RandomStream(0, static_cast<uint32_t>(i), 3, 0).exponential() / sigma;
  if (free_path < length - slack) {
    EXPECT_EQ(flights.event[i], Event::kScatter) << "ray " << i << ", " << free_path;
    EXPECT_NEAR(flights.t[i], free_path, slack) << "ray " << i;
  } else if (free_path > length + slack) {
    EXPECT_EQ(flights.event[i], Event::kEscape) << "ray " << i << ", " << free_path;
  }
}

/// Walks the rays by delta tracking without interpolation on every target.
inline void with_every_target(const Medium& medium, const RayStream& rays,
                              const std::function<void(const FlightStream&, std::size_t)>& check,
                              const Vec3d& origin = Vec3d(0)) {
  for (const Simd simd : available_simd()) {
    SCOPED_TRACE(to_string(simd));
    WalkSettings settings;
    settings.simd = simd;
    settings.interpolation = Interpolation::kNearest;
    settings.origin = origin;
    FlightStream flights;
    WalkStatistics statistics;
    Walker(medium, settings).free_paths(rays, flights, statistics);
    for (std::size_t i = 0; i < rays.size(); ++i) check(flights, i);
  }
}

inline std::vector<Vec3f> directions_26() {
  std::vector<Vec3f> directions;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) {
          directions.push_back(Vec3f(float(x), float(y), float(z)).normalized());
        }
      }
    }
  }
  return directions;
}

}  // namespace freepath::testing
