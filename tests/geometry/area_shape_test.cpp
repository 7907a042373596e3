#include "freepath/geometry/area_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "freepath/geometry/spherical_triangle.h"
#include "tests/geometry/surface_rays.h"
#include "tests/geometry/surface_references.h"
#include "tests/statistics.h"

namespace freepath::testing {

namespace {

/// A part of the parameters of a shape, and its share of the area.
struct Cells {
  static constexpr int kSide = 6;
  std::vector<double> area = std::vector<double>(kSide * kSide);
  double total = 0;
};

/// By differences of the parameterisation: independent of what is tested.
Cells cells_of(const ShapeReference& shape, const Matrix4d& object_to_world) {
  constexpr int kSteps = 240;
  constexpr double kStep = 1.0 / kSteps;
  Cells cells;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double u = (i + 0.5) * kStep;
      const double v = (j + 0.5) * kStep;
      if (std::holds_alternative<TriangleMesh>(shape.geometry) && v > u) continue;
      const auto at = [&](double du, double dv) {
        return shape.at(shape.geometry, u + du * kStep, v + dv * kStep) * object_to_world;
      };
      double area = (at(0.5, 0) - at(-0.5, 0)).cross(at(0, 0.5) - at(0, -0.5)).length();
      if (std::holds_alternative<TriangleMesh>(shape.geometry) && i == j) area *= 0.5;
      const int cell = i * Cells::kSide / kSteps * Cells::kSide + j * Cells::kSide / kSteps;
      cells.area[cell] += area;
      cells.total += area;
    }
  }
  return cells;
}

class EveryAreaShape : public ::testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  void SetUp() override {
    shape_ = references()[std::get<0>(GetParam())];
    RandomSurfaces random(99 + std::get<0>(GetParam()));
    object_to_world_ = random.transform(0.5, true);
    if (!std::get<1>(GetParam())) object_to_world_.setScale(Vec3d(1.3));
    description_ = shape_of(shape_.geometry, object_to_world_, 5);
    description_.first_primitive = 7;
  }
  ShapeReference shape_;
  Matrix4d object_to_world_;
  SurfaceShape description_;
};

std::string name_of(const ::testing::TestParamInfo<std::tuple<int, bool>>& info) {
  static const char* const kNames[] = {"Sphere",   "PartialSphere", "Disk",  "Ring",
                                       "Cylinder", "PartialTube",   "Patch", "Triangle"};
  return std::string(kNames[std::get<0>(info.param)]) +
         (std::get<1>(info.param) ? "Distorted" : "");
}

INSTANTIATE_TEST_SUITE_P(Surfaces, EveryAreaShape,
                         ::testing::Combine(::testing::Range(0, 8), ::testing::Bool()), name_of);

constexpr double kLevel = 1e-3;  // of all tests of one kind together
constexpr std::size_t kTests = 16;

TEST_P(EveryAreaShape, IsDrawnFromByItsArea) {
  const Cells cells = cells_of(shape_, object_to_world_);
  const AreaShape area(description_, Vec3d(0));
  ASSERT_EQ(area.first_primitive(), 7U);
  ASSERT_EQ(area.primitive_count(), 1U);
  EXPECT_NEAR(area.area(7), cells.total, 1e-3 * cells.total);
  // Weighted by 1 / pdf, points are uniform: the area of each cell is a mean.
  RandomSurfaces random(1234 + std::get<0>(GetParam()));
  constexpr int kSamples = 100000;
  std::vector<RunningStatistics> cell(cells.area.size());
  RunningStatistics whole;
  for (int i = 0; i < kSamples; ++i) {
    const AreaSample drawn = area.sample(7, random.uniform(), random.uniform());
    ASSERT_GT(drawn.pdf, 0);
    whole.add(1 / drawn.pdf);
    const auto index = [](float x) {
      return std::clamp(static_cast<int>(x * Cells::kSide), 0, Cells::kSide - 1);
    };
    const std::size_t drawn_cell = index(drawn.u) * Cells::kSide + index(drawn.v);
    for (std::size_t k = 0; k < cell.size(); ++k) cell[k].add(k == drawn_cell ? 1 / drawn.pdf : 0);
  }
  EXPECT_NEAR(whole.mean(), cells.total, 5 * whole.standard_error() + 1e-3 * cells.total);
  for (std::size_t k = 0; k < cell.size(); ++k) {
    // The reference integrates by midpoints, cells on a diagonal with an error.
    EXPECT_NEAR(cell[k].mean(), cells.area[k],
                family_wise_threshold(kLevel, kTests * cell.size()) * cell[k].standard_error() +
                    2e-4 * cells.total)
        << "cell " << k;
  }
}

TEST_P(EveryAreaShape, KnowsTheDensityOfAPointThatARayMeets) {
  const AreaShape area(description_, Vec3d(0));
  const Surfaces surfaces = surfaces_of(description_);
  RandomSurfaces random(77 + std::get<0>(GetParam()));
  int seen = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3f from(random.in_box(4));
    const AreaSample by_area = area.sample(7, random.uniform(), random.uniform());
    const AreaSample drawn = area.sample_from(from, 7, random.uniform(), random.uniform());
    for (const auto& [sample, is_seen_from] : {std::pair(by_area, false), {drawn, true}}) {
      if (sample.pdf == 0) continue;
      const Vec3f towards = sample.position - from;
      const auto hit = surfaces.intersect(from, towards, 0, kFar);
      const float cosine = std::abs(towards.normalized().dot(sample.normal));
      if (cosine < 0.05F) continue;  // the rounding of the position decides
      // Misses at the rim, and other parts that are nearer.
      if (!hit || std::abs(hit->t - 1) > 1e-3F) continue;
      ++seen;
      EXPECT_GT(hit->point.normal.dot(sample.normal), 0.999F);
      EXPECT_NEAR(hit->point.u, sample.u, 2e-3);
      EXPECT_NEAR(hit->point.v, sample.v, 2e-3);
      const float pdf = is_seen_from ? area.pdf_from(from, hit->point) : area.pdf(hit->point);
      EXPECT_NEAR(pdf / sample.pdf, 1, 2e-3);
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST_P(EveryAreaShape, FillsTheSolidAngleThatIsSeen) {
  const AreaShape area(description_, Vec3d(0));
  const Surfaces surfaces = surfaces_of(description_);
  RandomSurfaces random(55 + std::get<0>(GetParam()));
  const double sphere = 4 * std::numbers::pi;
  for (int i = 0; i < 4; ++i) {
    Vec3f from(random.direction() * random.uniform(2.5, 4));
    if (i == 3) from = Vec3f(random.in_box(0.3));  // within closed shapes
    RunningStatistics drawn;
    for (int i = 0; i < 40000; ++i) {
      const AreaSample sample = area.sample_from(from, 7, random.uniform(), random.uniform());
      const Vec3f towards = sample.position - from;
      const auto hit = surfaces.intersect(from, towards, 0, 0.999F);
      drawn.add(sample.pdf > 0 && !hit ? 1 / sample.pdf : 0);
    }
    RunningStatistics met;
    for (int i = 0; i < 40000; ++i) {
      const auto hit = surfaces.intersect(from, Vec3f(random.direction()), 0, kFar);
      met.add(hit ? sphere : 0);
    }
    EXPECT_NEAR(drawn.mean(), met.mean(),
                family_wise_threshold(kLevel, 4 * kTests) *
                        std::hypot(drawn.standard_error(), met.standard_error()) +
                    1e-3 * met.mean())
        << "from " << from;
  }
}

TEST(AreaShape, SphereFromOutsideIsDrawnUniformlyInItsCone) {
  SurfaceShape sphere = shape_of(Sphere{0.5});
  const AreaShape area(sphere, Vec3d(0));
  for (const float distance : {0.51F, 1.0F, 10.0F, 1000.0F}) {
    const Vec3f from(0, 0, distance);
    const double sine = 0.5 / distance;
    const double one_minus_cosine = sine * sine / (1 + std::sqrt(1 - sine * sine));
    const AreaSample drawn = area.sample_from(from, 0, 0.3F, 0.6F);
    EXPECT_NEAR(drawn.pdf * 2 * std::numbers::pi * one_minus_cosine, 1, 1e-5);
    // The share of the cone within the direction is the first number.
    const Vec3d direction = (Vec3d(drawn.position) - Vec3d(from)).normalized();
    const double sine2 = 1 - direction.z * direction.z;
    const double share = sine2 / (1 - direction.z) / one_minus_cosine;
    EXPECT_NEAR(share, 0.3, distance > 100 ? 0.02 : 1e-4);
  }
}

TEST(SphericalTriangle, HasTheSolidAngleOfAnOctant) {
  EXPECT_NEAR(SphericalTriangle({2, 0, 0}, {0, 3, 0}, {0, 0, 1}).solid_angle(),
              std::numbers::pi / 2, 1e-14);
}

TEST(SphericalTriangle, IsDrawnFromUniformly) {
  // Shares of the octant in which each of z, x and y is the largest, and moments: the mean of z is
  // the projected area over the area, (π/4) / (π/2).
  const SphericalTriangle octant({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  RandomSurfaces random(3);
  std::array<RunningStatistics, 3> mean;
  std::vector<uint64_t> counts(3 * 8);
  constexpr int kSamples = 80000;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3d d = octant.sample(random.uniform(), random.uniform());
    ASSERT_NEAR(d.length(), 1, 1e-12);
    ASSERT_GE(std::min({d.x, d.y, d.z}), -1e-12);
    for (int axis = 0; axis < 3; ++axis) {
      mean[axis].add(d[axis]);
      ++counts[axis * 8 + std::clamp(static_cast<int>(d[axis] * 8), 0, 7)];
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis].mean(), 0.5, 4 * mean[axis].standard_error());
    // By Archimedes each coordinate of a direction is uniform.
    const std::vector<double> expected(8, kSamples / 8.0);
    EXPECT_GT(chi_square_test({&counts[axis * 8], 8}, expected).p_value, 1e-4);
  }
}

}  // namespace

}  // namespace freepath::testing
