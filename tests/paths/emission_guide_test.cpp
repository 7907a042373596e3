// Directions towards emissive media: their density against quadrature and against what is drawn.

#include "freepath/paths/emission_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "freepath/base/random.h"
#include "tests/media/make_field.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::check_mean;
using testing::chi_square_test;
using testing::RunningStatistics;

const Vec3d kOrigin(10, -20, 30);

/// Two glowing lumps and a shell around nothing, in voxels that stand crookedly in the world and
/// are no cubes.
float lumps(const Vec3i& voxel) {
  const Vec3d point(voxel);
  if ((point - Vec3d(2, 3, 4)).length() < 3.5) return 2;
  if ((point - Vec3d(20, 9, 14)).length() < 2.2) return 0.5F;
  const double shell = (point - Vec3d(12, 12, 6)).length();
  return shell > 5 && shell < 6.2 ? 0.25F : 0.0F;
}

Matrix4d crooked() {
  Matrix4d transform;
  transform.setScale(Vec3d(0.04, 0.06, 0.03));
  transform *= Matrix4d().rotate(Vec3d(0.3, -0.5, 0.8));
  Matrix4d shift;
  shift.setTranslation(kOrigin + Vec3d(-0.3, -0.2, 0.1));
  return transform * shift;
}

BoundMedium make_bound(const std::shared_ptr<const Field>& density) {
  Component component;
  component.density = density;
  component.sigma_a = Rgb(2.0F, 1.0F, 0.5F);
  component.sigma_s = Rgb(0.1F);
  component.emission = Rgb(1.0F, 0.5F, 0.25F);
  auto medium = std::make_shared<const Medium>(std::vector<Component>{component});
  return {medium, channels_of(*medium)};
}

/// A guide at crooked cells, and positions in and out of the grid.
struct Fixture {
  std::shared_ptr<const Field> density =
      testing::make_field(Vec3i(0), Vec3i(23, 19, 17), lumps, crooked());
  EmissionGuide guide{make_bound(density), kOrigin};

  Vec3f at(const Vec3d& index) const { return Vec3f(index * crooked() - kOrigin); }
  std::vector<Vec3f> positions() const {
    return {at({2, 3, 4}),  at({12, 12, 6}),   at({11, 2, 15}),
            at({-9, 4, 4}), at({40, 30, -20}), at({24, 20, 18})};
  }
};

Vec3f cylinder_direction(double u, double v) {
  const double z = 1 - 2 * u;
  const double sine = std::sqrt(std::max(0.0, 1 - z * z));
  const double azimuth = 2 * std::numbers::pi * v;
  return Vec3f(Vec3d(sine * std::cos(azimuth), sine * std::sin(azimuth), z));
}

TEST(EmissionGuide, PdfIntegratesToOneByQuadrature) {
  const Fixture fixture;
  constexpr int kSteps = 1500;
  for (const Vec3f& position : fixture.positions()) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        sum +=
            fixture.guide.pdf(position, cylinder_direction((i + 0.5) / kSteps, (j + 0.5) / kSteps));
      }
    }
    EXPECT_NEAR(sum * 4 * std::numbers::pi / kSteps / kSteps, 1, 2e-3);
  }
}

TEST(EmissionGuide, PdfIntegratesToOneByMonteCarlo) {
  const Fixture fixture;
  RandomStream random(1, 2, 3, 4);
  for (const Vec3f& position : fixture.positions()) {
    RunningStatistics statistics;
    for (int i = 0; i < 400'000; ++i) {
      const Vec3f direction = sample_sphere(random.uniform(), random.uniform());
      statistics.add(fixture.guide.pdf(position, direction) / kUniformSpherePdf);
    }
    EXPECT_TRUE(check_mean("integral of the pdf", statistics, 1, {.largest_relative_error = 0.05}));
  }
}

/// Counts of directions in bins of equal solid angle against the pdf integrated over the bins.
TEST(EmissionGuide, DirectionsHaveTheirDensity) {
  const Fixture fixture;
  constexpr int kBins = 12;
  constexpr int kSteps = 80;  // within a bin
  constexpr int kSamples = 200'000;
  RandomStream random(5, 6, 7, 8);
  for (const Vec3f& position : fixture.positions()) {
    std::vector<double> expected;
    double total = 0;
    for (int bin = 0; bin < kBins * kBins; ++bin) {
      double sum = 0;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const Vec3i from(bin / kBins, bin % kBins, 0);
        const Vec3i step(i / kSteps, i % kSteps, 0);
        const double u = (from.x + (step.x + 0.5) / kSteps) / kBins;
        const double v = (from.y + (step.y + 0.5) / kSteps) / kBins;
        sum += fixture.guide.pdf(position, cylinder_direction(u, v));
      }
      expected.push_back(sum);
      total += sum;
    }
    for (double& value : expected) value *= kSamples / total;
    std::vector<uint64_t> counts(expected.size());
    for (int i = 0; i < kSamples; ++i) {
      const auto drawn = fixture.guide.sample(position, random);
      ASSERT_TRUE(drawn);
      const Vec3f& d = drawn->direction;
      const double u = 0.5 - 0.5 * d.z;
      double v = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
      if (v < 0) v += 1;
      const int row = std::min(static_cast<int>(u * kBins), kBins - 1);
      ++counts[row * kBins + std::min(static_cast<int>(v * kBins), kBins - 1)];
    }
    EXPECT_TRUE(check_chi_square("directions", chi_square_test(counts, expected)));
  }
}

TEST(EmissionGuide, SampleReturnsThePdfOfItsDirection) {
  const Fixture fixture;
  RandomStream random(9, 9, 9, 9);
  for (const Vec3f& position : fixture.positions()) {
    for (int i = 0; i < 1000; ++i) {
      const auto drawn = fixture.guide.sample(position, random);
      ASSERT_TRUE(drawn);
      EXPECT_NEAR(drawn->direction.length(), 1, 1e-6);
      EXPECT_GT(drawn->pdf, 0);
      EXPECT_EQ(drawn->pdf, fixture.guide.pdf(position, drawn->direction));
    }
  }
}

/// Every point that trilinear interpolation makes glow lies in a cell with some probability.
TEST(EmissionGuide, ReachesAllThatEmits) {
  const Fixture fixture;
  const EmissionCells& cells = fixture.guide.cells();
  RandomStream random(3, 3, 3, 3);
  int glowing = 0;
  for (int i = 0; i < 300'000; ++i) {
    Vec3d index(random.uniform(), random.uniform(), random.uniform());
    index = index * Vec3d(26, 22, 20) - Vec3d(1);
    if (fixture.density->voxels.interpolate(index) <= 1e-4) continue;
    ++glowing;
    const Vec3f position = apply(cells.grid.world_to_grid, fixture.at(index));
    Vec3i cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = std::clamp(static_cast<int>(position[axis]), 0, cells.grid.counts[axis] - 1);
    }
    ASSERT_GT(cells.power[cells.grid.index(cell)], 0);
  }
  EXPECT_GT(glowing, 10'000);
}

/// The sum of density · mean of sigma_a · L_e over all voxels, times their volume.
TEST(EmissionGuide, PowerIsWhatTheMediumEmits) {
  const Fixture fixture;
  double sum = 0;
  for (const float value : fixture.density->voxels.voxels()) sum += value;
  const double mean = (2.0 * 1.0 + 1.0 * 0.5 + 0.5 * 0.25) / 3;
  const double expected = sum * mean * std::abs(crooked().determinant());
  EXPECT_NEAR(fixture.guide.power(), expected, 0.05 * expected);
}

TEST(EmissionGuide, DarkMediaHaveNoDirections) {
  BoundMedium bound = make_bound(testing::make_field(Vec3i(0), Vec3i(4), [](auto&) { return 1; }));
  bound.channels.components[0].emission = {};
  const EmissionGuide guide(bound, Vec3d(0));
  RandomStream random(1, 1, 1, 1);
  EXPECT_EQ(guide.power(), 0);
  EXPECT_FALSE(guide.sample(Vec3f(0), random));
  EXPECT_EQ(guide.pdf(Vec3f(0), Vec3f(1, 0, 0)), 0);
}

/// A temperature that glows in a part of the density alone, through a table of its radiance.
TEST(EmissionGuide, FollowsTemperature) {
  const auto density = testing::make_field(
      Vec3i(0), Vec3i(15), [](auto&) { return 1.0F; }, crooked());
  const auto temperature = testing::make_field(
      Vec3i(0), Vec3i(15), [](const Vec3i& v) { return v.x < 4 ? 1.0F : 0.1F; }, crooked());
  BoundMedium bound = make_bound(density);
  for (RadianceField& radiance : bound.channels.components[0].radiance) {
    radiance = {temperature,
                std::make_shared<const std::vector<float>>(std::vector<float>{0, 0, 0, 0, 0, 1}), 0,
                0.2F};
  }
  const EmissionGuide guide(bound, kOrigin);
  const Vec3f far((Vec3d(15, 8, 8) * crooked()) - kOrigin);
  const Vec3f edge((Vec3d(5.2, 8, 8) * crooked()) - kOrigin);
  const Vec3f towards = (edge - far).normalized();
  EXPECT_GT(guide.pdf(far, towards), 0);
  EXPECT_EQ(guide.pdf(far, -towards), 0);
}

}  // namespace
}  // namespace freepath
