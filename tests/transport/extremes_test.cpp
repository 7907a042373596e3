// Inputs at the edge of what there is: no NaN, no endless walk, and the right answer where there is
// one.

#include "tests/transport/extremes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/statistics.h"

namespace freepath::testing {
namespace {

RayList rays_through_box(int copies = 4) {
  RayList list;
  for (const Vec3f& direction : directions_26()) {
    list.add(direction * -50.0F + Vec3f(0.2F, -0.3F, 0.1F), direction, kInfinity, copies);
    list.add(Vec3f(0.2F, -0.3F, 0.1F), direction, kInfinity, copies);
  }
  return list;
}

TEST(Extremes, AMediumWithoutExtinctionOrDensityLetsEverythingPass) {
  RayList list = rays_through_box();
  const auto zeros = make_field(Vec3i(-12), Vec3i(11), [](const Vec3i&) { return 0.0F; });
  for (const Medium& medium : {medium_of(box_field(), 0), medium_of(zeros, 1)}) {
    with_every_method(medium, list.finish(), [](const FlightStream& flights, std::size_t i, bool) {
      expect_untouched(flights, i);
    });
  }
}

TEST(Extremes, AMillionMeanFreePathsLetNothingPass) {
  RayList list = rays_through_box(1);
  // Seen from outside, the filter's soft border is thick too.
  with_every_method(medium_of(box_field(), 1e6F / 24), list.finish(),
                    [](const FlightStream& flights, std::size_t i, bool transmittance) {
                      ASSERT_NE(flights.event[i], Event::kEscape);
                      if (transmittance) {
                        ASSERT_EQ(flights.weight[0][i], 0);
                      }
                    });
}

TEST(Extremes, AMillionthOfAMeanFreePathLetsEverythingPass) {
  RayList list = rays_through_box();
  with_every_method(medium_of(box_field(), 1e-6F / 24), list.finish(),
                    [](const FlightStream& flights, std::size_t i, bool) {
                      EXPECT_EQ(flights.event[i], Event::kEscape);
                      // The longest way is the diagonal: 25 √3 voxels with the filter's border.
                      EXPECT_NEAR(flights.weight[0][i], 1, 2e-6);
                    });
}

// The filter spreads a voxel into a tent, whose integral along an axis is what it weighs across.
TEST(Extremes, AFieldOfOneVoxelHasTheTransmittanceOfItsTent) {
  const auto field = make_field(Vec3i(7, 8, -9), Vec3i(7, 8, -9), [](auto&) { return 2.0F; });
  const Medium medium = medium_of(field, 0.5F);
  struct Offset {
    float y, z;
    double nearest, tent;  // optical depths
  };
  const Offset offsets[] = {
      {0, 0, 1, 1},      {0.25F, 0, 1, 0.75},    {0.25F, -0.5F + 1e-3F, 1, 0.375},
      {0.6F, 0, 0, 0.4}, {-0.8F, 0.9F, 0, 0.02}, {1.01F, 0, 0, 0}};
  constexpr std::size_t kPaths = 40'000;
  const double threshold = family_wise_threshold(1e-3, 200);
  for (const Simd simd : available_simd()) {
    for (const Interpolation interpolation : kInterpolations) {
      for (const Offset& offset : offsets) {
        WalkSettings settings;
        settings.simd = simd;
        settings.interpolation = interpolation;
        FlightStream flights;
        WalkStatistics statistics;
        Walker(medium, settings)
            .transmittance(repeat_ray(Vec3f(-20, 8 + offset.y, -9 + offset.z), Vec3f(1, 0, 0),
                                      kInfinity, kPaths),
                           flights, statistics);
        RunningStatistics result;
        for (std::size_t i = 0; i < kPaths; ++i) result.add(flights.weight[0][i]);
        const bool nearest = interpolation == Interpolation::kNearest;
        EXPECT_TRUE(check_mean(name_of(interpolation), result,
                               std::exp(-(nearest ? offset.nearest : offset.tent)),
                               {.z = threshold, .absolute = 1e-3}))
            << to_string(simd) << ", " << offset.y << ", " << offset.z;
      }
    }
  }
}

// Starts on faces, edges and corners of the bounds and of super-voxels, or in the midst; runs along
// them, or across.
TEST(Extremes, RaysOnFacesEdgesAndCornersFlyTheirLength) {
  constexpr float kLow = -12.5F;
  constexpr float kHigh = 11.5F;
  constexpr float kSigma = 0.1F;
  RayList list;
  for (const float x : {kLow, -8.5F, -0.5F, 0.0F, kHigh}) {
    for (const float y : {kLow, -4.5F, -0.5F, 1.3F, kHigh}) {
      for (const float z : {kLow, -0.5F, 3.5F, 0.2F, kHigh}) {
        for (const Vec3f& direction : directions_26()) list.add(Vec3f(x, y, z), direction);
      }
    }
  }
  // The same from outside.
  const std::size_t inside = list.rays.size();
  for (std::size_t i = 0; i < inside; ++i) {
    list.add(list.rays[i].origin - list.rays[i].direction * 64.0F, list.rays[i].direction);
  }
  for (const int super_voxel : {4, 8, 64}) {
    const auto check = [&](const FlightStream& flights, std::size_t i) {
      ASSERT_TRUE(is_sane(flights, i, true));
      const auto& [origin, direction, t_max] = list.rays[i];
      double begin = 0;
      double end = kInfinity;
      bool grazes = false;
      for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) {
          grazes = grazes || origin[axis] == kLow || origin[axis] == kHigh;
          continue;
        }
        const double to_low = (double(kLow) - origin[axis]) / direction[axis];
        const double to_high = (double(kHigh) - origin[axis]) / direction[axis];
        begin = std::max(begin, std::min(to_low, to_high));
        end = std::min(end, std::max(to_low, to_high));
      }
      // Within a face of the bounds a ray may count as inside or outside; through an edge, too.
      if (grazes && flights.event[i] == Event::kEscape) return;
      const double length = std::max(0.0, end - begin);
      const double free_path =
          RandomStream(0, static_cast<uint32_t>(i), 3, 0).exponential() / kSigma;
      constexpr double kSlack = 2e-4;
      if (free_path < length - kSlack) {
        EXPECT_EQ(flights.event[i], Event::kScatter) << i << origin << direction;
        EXPECT_NEAR(flights.t[i], begin + free_path, kSlack) << i << origin << direction;
      } else if (free_path > length + kSlack) {
        EXPECT_EQ(flights.event[i], Event::kEscape) << i << origin << direction;
      }
    };
    with_every_target(medium_of(box_field(), kSigma, super_voxel), list.finish(), check);
  }
}

// Along faces and edges of super-voxels, where one that is empty may lie beside one that is not.
TEST(Extremes, RaysAlongFacesAndEdgesSeeTheirTransmittance) {
  const auto field = make_field(Vec3i(-12), Vec3i(11), [](const Vec3i& p) {
    return hash_noise(Vec3i(p.x >> 2, p.y >> 2, p.z >> 2)) < 0.6F ? 0 : hash_noise(p);
  });
  const Medium medium = medium_of(field, 0.4F);
  const TestRay rays[] = {{Vec3f(-20, -0.5F, 3.5F), Vec3f(1, 0, 0), 40},
                          {Vec3f(-0.5F, 20, 3.5F), Vec3f(0, -1, 0), 40},
                          {Vec3f(3.5F, 1.2F, -20), Vec3f(0, 0, 1), 40},
                          // As sines and cosines leave them.
                          {Vec3f(0.3F, 20, 3.7F), Vec3f(6e-17F, -1, -1.1e-32F), 40},
                          {Vec3f(0.3F, -20, 3.7F), Vec3f(-1e-31F, 1, -1e-38F), 40},
                          {Vec3f(-20, 0.7F, 1.2F), Vec3f(1, -0.0F, -1e-40F), 40},
                          {Vec3f(-20.5F, -20.5F, 3.5F), Vec3f(1, 1, 0).normalized(), 60},
                          {Vec3f(-20.5F), Vec3f(1).normalized(), 80}};
  constexpr std::size_t kPaths = 30'000;
  const double threshold = family_wise_threshold(1e-3, 50);
  for (const TestRay& ray : rays) {
    const double depth = 0.4 * optical_depth(*field, Vec3d(ray.origin), Vec3d(ray.direction),
                                             ray.t_max, Interpolation::kTrilinear, 50'000);
    for (const Simd simd : available_simd()) {
      for (const Interpolation interpolation :
           {Interpolation::kTrilinear, Interpolation::kStochastic}) {
        WalkSettings settings;
        settings.simd = simd;
        settings.interpolation = interpolation;
        FlightStream flights;
        WalkStatistics statistics;
        Walker(medium, settings).transmittance(repeat_ray(ray, kPaths, 0), flights, statistics);
        RunningStatistics result;
        for (std::size_t i = 0; i < kPaths; ++i) result.add(flights.weight[0][i]);
        EXPECT_TRUE(check_mean(name_of(interpolation), result, std::exp(-depth),
                               {.z = threshold, .absolute = 1e-5}))
            << to_string(simd) << ray.origin << ray.direction;
      }
    }
  }
}

TEST(Extremes, RaysThatMissOrHaveNoLengthEscapeUntouched) {
  RayList list;
  for (const Vec3f& direction : directions_26()) {
    list.add(direction * 30.0F, direction);       // behind
    list.add(Vec3f(0.0F), direction, 0);          // no length
    list.add(direction * -50.0F, direction, 10);  // ends before
    list.add(direction * -50.0F + direction.cross(Vec3f(9, 40, -17)).normalized() * 25.0F,
             direction);  // beside
  }
  with_every_method(
      medium_of(box_field(), 5), list.finish(),
      [](const FlightStream& flights, std::size_t i, bool) { expect_untouched(flights, i); });
}

TEST(Extremes, RaysEndWhereTheyAreToldTo) {
  RayList list;
  for (const Vec3f& direction : directions_26()) {
    for (const float t_max : {1e-3F, 0.5F, 3.0F, 4.0F, 10.0F}) {
      list.add(Vec3f(0.1F, -0.2F, 0.3F), direction, t_max, 10);
    }
  }
  with_every_target(medium_of(box_field(), 0.3F), list.finish(),
                    [&](const FlightStream& flights, std::size_t i) {
                      const float t_max = list.rays[i].t_max;
                      expect_homogeneous(flights, i, 0.3F, t_max, 1e-5);
                      if (flights.event[i] == Event::kEscape) {
                        EXPECT_EQ(flights.t[i], t_max);
                      }
                    });
}

TEST(Extremes, RaysWithoutFiniteNumbersEscapeUntouched) {
  RayList list;
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    for (int axes = 1; axes < 8; ++axes) {
      Vec3f origin(0.1F);
      Vec3f direction = Vec3f(1, 2, 3).normalized();
      for (int axis = 0; axis < 3; ++axis) {
        if ((axes >> axis & 1) == 0) continue;
        origin[axis] = bad;
        direction[axis] = bad;
      }
      list.add(origin, Vec3f(1, 0, 0));
      list.add(origin, Vec3f(1, 2, 3).normalized());
      list.add(Vec3f(0.1F), direction);
      list.add(origin, direction);
    }
  }
  Component component;
  component.density = lumpy_field();
  const RayStream& rays = list.finish();
  for (const Medium& medium : {medium_of(box_field(), 5), Medium({component})}) {
    expect_to_end([&] {
      with_every_method(medium, rays, [](const FlightStream& flights, std::size_t i, bool) {
        expect_untouched(flights, i);
      });
    });
  }
}

// A ray that ends nobody knows where goes nowhere, even where it begins in a dense medium.
TEST(Extremes, RaysWhoseEndIsNotANumberEscapeUntouched) {
  RayList list;
  for (const Vec3f& direction : directions_26()) {
    list.add(Vec3f(0.1F), direction, kNan);
    list.add(direction * -50.0F, direction, -kNan);
  }
  const RayStream& rays = list.finish();
  const Medium medium = medium_of(box_field(), 5);
  expect_to_end([&] {
    with_every_method(medium, rays, [](const FlightStream& flights, std::size_t i, bool) {
      expect_untouched(flights, i);
      EXPECT_EQ(flights.t[i], 0) << "ray " << i;
    });
  });
}

TEST(Extremes, StreamsOfAnySize) {
  const Medium medium = medium_of(lumpy_field(), 2);
  for (const Simd simd : available_simd()) {
    WalkSettings settings;
    settings.simd = simd;
    const Walker walker(medium, settings);
    FlightStream all;
    WalkStatistics statistics;
    walker.free_paths(repeat_ray(test_rays()[0], 1000, 0), all, statistics);
    EXPECT_EQ(statistics.rays, 1000U);
    for (const std::size_t count : {0, 1, 15, 16, 17, 999}) {
      FlightStream some;
      walker.free_paths(repeat_ray(test_rays()[0], count, 0), some, statistics);
      ASSERT_EQ(some.size(), count);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(some.t[i], all.t[i]);
        EXPECT_EQ(some.event[i], all.event[i]);
        EXPECT_EQ(some.weight[0][i], all.weight[0][i]);
      }
    }
    FlightStream none;
    walker.free_paths(RayStream{}, none, statistics);
    walker.transmittance(RayStream{}, none, statistics);
    EXPECT_EQ(none.size(), 0U);
  }
}

// A ray without a direction passes nothing. Walked in a hole of a super-voxel that is not empty,
// null collisions would follow each other for ever.
TEST(Extremes, RaysWithoutADirectionEscapeUntouched) {
  const auto holes = make_field(Vec3i(-12), Vec3i(11), [](const Vec3i& p) {
    return (p.x + p.y + p.z) % 2 == 0 ? 0.0F : 1.0F;
  });
  RayList list;
  for (const Vec3f& origin : {Vec3f(0.0F), Vec3f(1, 0, 0), Vec3f(-12.5F), Vec3f(100.0F)}) {
    for (const float t_max : {0.0F, 1.0F, kInfinity}) list.add(origin, Vec3f(0.0F), t_max, 5);
    list.add(origin, Vec3f(1e-38F, 0, 0), kInfinity, 5);  // too short to move a point
  }
  const RayStream& rays = list.finish();
  for (const Medium& medium : {medium_of(box_field(), 1), medium_of(holes, 1)}) {
    expect_to_end([&] {
      with_every_method(medium, rays, [](const FlightStream& flights, std::size_t i, bool) {
        expect_untouched(flights, i);
      });
    });
  }
}

}  // namespace
}  // namespace freepath::testing
