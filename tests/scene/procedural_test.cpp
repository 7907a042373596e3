#include "freepath/scene/procedural.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include "freepath/base/error.h"

namespace freepath {
namespace {

using Generator = std::vector<Field> (*)(const ProceduralOptions&);

struct Kind {
  std::string name;
  Generator generate;
  double least_filled;  // of the box around what there is
};

/// For the names of tests.
std::ostream& operator<<(std::ostream& stream, const Kind& kind) { return stream << kind.name; }

class Procedural : public ::testing::TestWithParam<Kind> {};

bool same(const std::vector<Field>& a, const std::vector<Field>& b) {
  return std::ranges::equal(a, b, [](const Field& x, const Field& y) {
    return x.name == y.name && x.index_to_world == y.index_to_world &&
           x.voxels.origin() == y.voxels.origin() &&
           std::ranges::equal(x.voxels.index(), y.voxels.index()) &&
           std::ranges::equal(x.voxels.voxels(), y.voxels.voxels());
  });
}

TEST_P(Procedural, DependsOnSeedAndResolutionAlone) {
  const ProceduralOptions options{.resolution = 48, .seed = 7, .progress = {}};
  const auto first = GetParam().generate(options);
  {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(same(first, GetParam().generate(options)));
  }
  EXPECT_TRUE(same(first, GetParam().generate(options)));
  EXPECT_FALSE(same(first, GetParam().generate({.resolution = 48, .seed = 8, .progress = {}})));
}

TEST_P(Procedural, StandsOnTheGroundAndSpansAHundredUnits) {
  const auto fields = GetParam().generate({.resolution = 64, .seed = 0, .progress = {}});
  const BrickMap& map = fields[0].voxels;
  const Vec3d low = Vec3d(map.active_min()) * fields[0].index_to_world;
  const Vec3d high = Vec3d(map.active_max()) * fields[0].index_to_world;
  EXPECT_GE(low.y, 0);
  EXPECT_LT(low.y, 10);
  const Vec3d size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  EXPECT_LE(longest, 100);
  EXPECT_GT(longest, 85);
  EXPECT_NEAR(fields[0].index_to_world[0][0], 100.0 / 64, 1e-6);
}

TEST_P(Procedural, DensitiesFillTheRangeFromZeroToOne) {
  const auto fields = GetParam().generate({.resolution = 64, .seed = 1, .progress = {}});
  ASSERT_EQ(fields[0].name, "density");
  const BrickMap& map = fields[0].voxels;
  const auto [low, high] = std::ranges::minmax(map.voxels());
  EXPECT_GE(low, 0);
  EXPECT_GT(high, 0.6);
  EXPECT_LE(high, 1);
  const Vec3i size = map.active_max() - map.active_min() + Vec3i(1);
  const double filled =
      static_cast<double>(std::ranges::count_if(map.voxels(), [](float v) { return v > 0; })) /
      (double(size.x) * size.y * size.z);
  EXPECT_GT(filled, GetParam().least_filled);
}

TEST_P(Procedural, StoresNoEmptyBricks) {
  const auto fields = GetParam().generate({.resolution = 64, .seed = 1, .progress = {}});
  const auto voxels = fields[0].voxels.voxels();
  for (std::size_t brick = 1; brick < fields[0].voxels.brick_count(); ++brick) {
    const auto values = voxels.subspan(brick * BrickMap::kBrickVoxels, BrickMap::kBrickVoxels);
    EXPECT_TRUE(std::ranges::any_of(values, [](float v) { return v > 0; })) << brick;
  }
}

TEST_P(Procedural, ProgressRisesToOne) {
  double last = 0;
  ProceduralOptions options{.resolution = 32, .seed = 0, .progress = {}};
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  GetParam().generate(options);
  EXPECT_EQ(last, 1);
}

TEST_P(Procedural, ResolutionsOutOfRangeAreRefused) {
  for (const int resolution : {-1, 0, 15, 2049}) {
    EXPECT_THROW(GetParam().generate({.resolution = resolution, .seed = 0, .progress = {}}), Error);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Procedural,
    ::testing::Values(Kind{"cloud", generate_cloud, 0.2}, Kind{"smoke", generate_smoke, 0.04},
                      Kind{"fireball", generate_fireball, 0.2}, Kind{"fog", generate_fog, 0.9},
                      Kind{"noise", generate_noise, 0.4}, Kind{"puffs", generate_puffs, 0.04}),
    [](const auto& info) { return info.param.name; });

// The same function of place: coarse voxels hold what fine ones do there.
TEST(Puffs, AreTheSameAtAnyResolution) {
  const auto mass = [](int resolution) {
    const auto fields = generate_puffs({.resolution = resolution, .seed = 0, .progress = {}});
    double sum = 0;
    for (const float value : fields[0].voxels.voxels()) sum += value;
    return sum / std::pow(resolution, 3);
  };
  EXPECT_NEAR(mass(64) / mass(160), 1, 0.02);
}

TEST(Fireball, HasATemperatureWhereverThereIsDensity) {
  const auto fields = generate_fireball({.resolution = 48, .seed = 2, .progress = {}});
  ASSERT_EQ(fields.size(), 2U);
  EXPECT_EQ(fields[1].name, "temperature");
  const auto density = fields[0].voxels.voxels(), temperature = fields[1].voxels.voxels();
  ASSERT_TRUE(std::ranges::equal(fields[0].voxels.index(), fields[1].voxels.index()));
  for (std::size_t i = 0; i < density.size(); ++i) {
    if (density[i] == 0) continue;
    ASSERT_GE(temperature[i], 300);
    ASSERT_LE(temperature[i], 3000);
  }
  EXPECT_GT(std::ranges::max(temperature), 2500);
}

}  // namespace
}  // namespace freepath
