// Rays and media far away, tiny or huge: right as far as single precision goes, sane beyond.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/transport/extremes.h"

namespace freepath::testing {
namespace {

TEST(Distances, DistantOriginsKeepTheLengthOfTheirRays) {
  // A box of 24 of the given unit, seen from the given distance. The distance of a hit is not known
  // better than a float of that size is; nor is the length inside.
  struct Distance {
    double unit, distance;
  };
  for (const Distance& test : {Distance{1, 1e3}, Distance{1, 1e6}, Distance{1e4, 1e9}}) {
    const auto sigma = static_cast<float>(0.1 / test.unit);
    RayList list;
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0F, 1.0F}) {
        Vec3f direction(0.0F);
        direction[axis] = side;
        Vec3f origin(0.0F);
        origin[axis] = static_cast<float>(-side * test.distance);
        list.add(origin, direction, kInfinity, 50);
      }
    }
    const double slack = test.distance * 0x1p-22;
    with_every_target(medium_of(box_field(test.unit), sigma), list.finish(),
                      [&](const FlightStream& flights, std::size_t i) {
                        ASSERT_TRUE(is_sane(flights, i, true));
                        const double free_path =
                            RandomStream(0, static_cast<uint32_t>(i), 3, 0).exponential() / sigma;
                        const double length = 24 * test.unit;
                        if (free_path < length - slack) {
                          EXPECT_EQ(flights.event[i], Event::kScatter) << test.distance;
                          EXPECT_NEAR(flights.t[i], test.distance - 12 * test.unit + free_path,
                                      test.unit + slack);
                        } else if (free_path > length + slack) {
                          EXPECT_EQ(flights.event[i], Event::kEscape) << test.distance;
                        }
                      });
  }
}

/// The part of a ray within a box, grown by what the filter and rounding may reach beyond it.
struct Stretch {
  double begin = 0, end = 0;
};

Stretch stretch_in(const Box3d& box, double margin, const TestRay& ray) {
  Stretch stretch{0, ray.t_max};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - margin - ray.origin[axis];
    const double high = box.max[axis] + margin - ray.origin[axis];
    const double speed = ray.direction[axis];
    if (speed == 0) {
      if (low > 0 || high < 0) return {0, -1};
      continue;
    }
    stretch.begin = std::max(stretch.begin, std::min(low / speed, high / speed));
    stretch.end = std::min(stretch.end, std::max(low / speed, high / speed));
  }
  return stretch;
}

// What is further away than single precision resolves has no right answer, but not any answer will
// do: nothing collides but within the medium, as far as floats can tell, or where the ray ends.
TEST(Distances, VeryDistantRaysCollideInTheMediumOrNowhere) {
  RayList list;
  for (const float distance : {1e6F, 1e9F, 1e20F, 1e38F}) {
    for (const Vec3f& direction : directions_26()) {
      list.add(direction * -distance, direction, kInfinity, 2);
      list.add(direction * -distance, direction, 2 * distance, 2);
      list.add(Vec3f(distance), direction, kInfinity, 2);
      list.add(Vec3f(0.3F), direction * distance, kInfinity, 2);
    }
  }
  for (const double translation : {0.0, 1e6, 1e9, 1e30}) {
    const Box3d box(Vec3d(translation - 12.5), Vec3d(translation + 11.5));
    std::size_t collisions = 0;
    std::size_t misses = 0;
    with_every_method(
        medium_of(box_field(1, Vec3d(translation)), 0.1F), list.finish(),
        [&](const FlightStream& flights, std::size_t i, bool) {
          const TestRay& ray = list.rays[i];
          const double farthest =
              std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)});
          const double margin = 0.5 + (farthest + translation) * 0x1p-21;
          const auto [begin, end] = stretch_in(box, margin, ray);
          if (!(begin < end)) {
            expect_untouched(flights, i);
            ++misses;
          } else if (flights.event[i] != Event::kEscape) {
            const double slack = 1e-6 * begin;
            EXPECT_GE(flights.t[i], begin - slack) << "ray " << i << ", box at " << translation;
            EXPECT_LE(flights.t[i], end + slack) << "ray " << i << ", box at " << translation;
            ++collisions;
          }
          EXPECT_LE(flights.t[i], ray.t_max);
          // A direction of 1e6 and more leaves a millionth of a mean free path.
          if (ray.direction.length() > 2 && translation == 0) {
            EXPECT_EQ(flights.event[i], Event::kEscape) << "ray " << i;
          }
        });
    EXPECT_GT(misses, 0U);
    // Rays through the middle, from as far as floats still tell it, mostly do collide.
    if (translation == 0) {
      EXPECT_GT(collisions, 0.5 * 26 * 4 * 8 * 3 * static_cast<double>(available_simd().size()));
    }
  }
}

TEST(Distances, FieldsFarFromTheOriginKeepTheirLengths) {
  constexpr double kFar = 1e5;  // floats are 2^-7 apart here
  const Medium medium = medium_of(box_field(1, Vec3d(kFar, -kFar, kFar)), 0.1F);
  RayList list;
  for (const Vec3f& direction : directions_26()) {
    list.add(Vec3f(kFar, -kFar, kFar), direction, 8.0F, 20);
  }
  with_every_target(medium, list.finish(), [&](const FlightStream& flights, std::size_t i) {
    expect_homogeneous(flights, i, 0.1F, 8, 1e-3);
  });
}

// Rays that are told relative to a point near the medium know no distance.
TEST(Distances, AnOriginNearTheFieldKeepsAllDigits) {
  RayList list;
  for (const Vec3f& direction : directions_26()) list.add(Vec3f(0.25F), direction, 8.0F, 20);
  list.finish();
  for (const double distance : {1e6, 1e9, 1e12}) {
    const Vec3d position(distance, -distance, 3 * distance);
    with_every_target(
        medium_of(box_field(1, position), 0.1F), list.stream,
        [&](const FlightStream& flights, std::size_t i) {
          expect_homogeneous(flights, i, 0.1F, 8, 1e-5);
        },
        position);
  }
}

TEST(Distances, TinyAndHugeVoxelsDifferInScaleAlone) {
  for (const double unit : {1e-6, 1e-3, 1e3, 1e6}) {
    const auto scale = static_cast<float>(unit);
    RayList list;
    for (const Vec3f& direction : directions_26()) {
      list.add(Vec3f(0.1F, -0.2F, 0.3F) * scale, direction, 8 * scale, 20);
    }
    with_every_target(medium_of(box_field(unit), 0.1F / scale), list.finish(),
                      [&](const FlightStream& flights, std::size_t i) {
                        expect_homogeneous(flights, i, 0.1F / scale, 8 * unit, 1e-5 * unit);
                      });
  }
}

}  // namespace
}  // namespace freepath::testing
