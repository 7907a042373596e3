// Choosing one of many lights: the probabilities are those of the draws, and miss no light.

#include "freepath/lights/light_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "freepath/base/distributions.h"
#include "freepath/base/random.h"
#include "freepath/base/tangent_frame.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

/// Facing and all-round lights of all sizes, in clusters, some in one place.
std::vector<LightBounds> random_lights(std::size_t count) {
  RandomStream random(1, 1, 2, 3);
  std::vector<LightBounds> lights;
  for (std::size_t i = 0; i < count; ++i) {
    LightBounds light;
    const float u0 = random.uniform();
    const Vec3f cluster(static_cast<float>(i % 3) * 5, 0, static_cast<float>(i % 2) * 3);
    const Vec3f center = cluster + Vec3f(random.uniform(), random.uniform(), random.uniform());
    const Vec3f half = i % 4 == 0 ? Vec3f(0) : Vec3f(0.2F * random.uniform());
    light.box = Box3f(center - half, center + half);
    if (i % 5 == 4) light.box = lights[i - 1].box;
    light.normals.axis = sample_sphere(u0, random.uniform());
    light.normals.cosine = i % 3 == 0 ? -1 : (i % 3 == 1 ? 1 : random.uniform());
    light.cosine_reach = i % 2 == 0 ? 0 : 0.8F;
    light.two_sided = i % 7 == 0;
    light.power = i % 11 == 10 ? 0 : 0.1 + random.uniform();
    lights.push_back(light);
  }
  return lights;
}

std::vector<Vec3f> random_positions(int count) {
  RandomStream random(4, 4, 4, 4);
  std::vector<Vec3f> positions;
  for (int i = 0; i < count; ++i) {
    const float x = random.uniform();
    const float y = random.uniform();
    positions.emplace_back(14 * x - 2, 6 * y - 3, 8 * random.uniform() - 2);
  }
  return positions;
}

TEST(LightSampler, TheProbabilitiesSumToOne) {
  for (const std::size_t count : {1U, 2U, 16U, 17U, 18U, 300U}) {
    const std::vector<LightBounds> lights = random_lights(count);
    const LightSampler chooser(lights);
    for (const Vec3f& position : random_positions(200)) {
      double sum = 0;
      for (uint32_t light = 0; light < count; ++light) {
        const float probability = chooser.probability(position, light);
        if (lights[light].power == 0) {
          EXPECT_EQ(probability, 0);
        }
        sum += probability;
      }
      // Down a branch where nothing shines the draw ends without a light.
      EXPECT_LE(sum, 1 + 1e-5);
      EXPECT_GE(sum, count <= LightSampler::kFewLights ? 1 - 1e-5 : 0);
    }
  }
}

TEST(LightSampler, DrawsHaveTheirProbabilities) {
  for (const std::size_t count : {5U, 16U, 17U, 100U}) {
    const LightSampler chooser(random_lights(count));
    for (const Vec3f& position : random_positions(5)) {
      constexpr int kSamples = 50'000;
      std::vector<double> expected(count + 1);
      for (uint32_t light = 0; light < count; ++light) {
        expected[light] = kSamples * chooser.probability(position, light);
      }
      const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
      expected[count] = std::max(0.0, kSamples - total);
      if (expected[count] < 1e-3 * kSamples) expected[count] = 0.01;
      std::vector<uint64_t> counts(count + 1, 0);
      RandomStream random(7, 7, 7, 7);
      for (int i = 0; i < kSamples; ++i) {
        const LightChoice choice = chooser.choose(position, random.uniform());
        if (choice.probability == 0) {
          ++counts[count];
          continue;
        }
        ++counts[choice.light];
        ASSERT_NEAR(choice.probability, chooser.probability(position, choice.light),
                    1e-5 * choice.probability);
      }
      EXPECT_TRUE(testing::check_chi_square("choice", testing::chi_square_test(counts, expected)));
    }
  }
}

TEST(LightSampler, NoLightIsMissedWhereItShines) {
  const std::vector<LightBounds> lights = random_lights(300);
  const LightSampler chooser(lights);
  RandomStream random(8, 8, 8, 8);
  int shining = 0;
  for (const Vec3f& position : random_positions(2000)) {
    const auto index = static_cast<uint32_t>(random.uniform() * 300);
    const LightBounds& light = lights[index];
    // A point of the light and a normal there, within its bounds.
    const Vec3f u(random.uniform(), random.uniform(), random.uniform());
    const Vec3f point = light.box.min + light.box.size() * u;
    const TangentFrame frame(light.normals.axis);
    const float drop = random.uniform() * (1 - light.normals.cosine);
    const float sine = std::sqrt(drop * (2 - drop));
    const float azimuth = 2 * std::numbers::pi_v<float> * random.uniform();
    const Vec3f normal =
        frame.to_world(sine * std::cos(azimuth), sine * std::sin(azimuth), 1 - drop);
    float cosine = normal.dot((position - point).normalized());
    if (light.two_sided) cosine = std::abs(cosine);
    if (light.power == 0 || cosine <= light.cosine_reach) continue;
    ++shining;
    EXPECT_GT(chooser.probability(position, index), 0);
  }
  EXPECT_GT(shining, 300);
}

TEST(LightSampler, PrefersWhatIsNear) {
  std::vector<LightBounds> lights(40);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    lights[i].box = Box3f(Vec3f(static_cast<float>(i), 0, 0));
    lights[i].normals.cosine = -1;
    lights[i].power = 1;
  }
  const LightSampler chooser(lights);
  const Vec3f position(20, 0.1F, 0);
  EXPECT_GT(chooser.probability(position, 20), 10.0F / 40);  // ten times its share by power
  EXPECT_GT(chooser.probability(position, 0), 0);
}

TEST(LightBounds, AConeAroundTwoHoldsBoth) {
  RandomStream random(6, 6, 6, 6);
  for (int i = 0; i < 2000; ++i) {
    DirectionCone cones[2];
    for (DirectionCone& cone : cones) {
      const float u0 = random.uniform();
      cone = {sample_sphere(u0, random.uniform()), 2 * random.uniform() - 1};
    }
    const DirectionCone both = unite(cones[0], cones[1]);
    for (const DirectionCone& cone : cones) {
      const double between = std::acos(std::clamp(double{both.axis.dot(cone.axis)}, -1.0, 1.0));
      const double reach = between + std::acos(double{cone.cosine});
      EXPECT_TRUE(both.cosine == -1 || reach <= std::acos(double{both.cosine}) + 1e-3);
    }
  }
}

}  // namespace
}  // namespace freepath
