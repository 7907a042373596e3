// Environment, sky and sun as the mixture that the integrator draws of.

#include "freepath/lights/scene_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/lights/sky.h"
#include "freepath/spectra/rgb_color_space.h"
#include "tests/lights/sky_images.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::grey_image;
using testing::rough_image;

/// A direction drawn towards the lights.
struct RgbSample {
  Vec3f direction;
  Rgb radiance;
  float pdf;
};

/// An environment and perhaps a sun, as the lights of a scene in R, G and B.
class Lights {
 public:
  explicit Lights(const std::optional<ImageEnvironment>& environment,
                  const std::optional<Sun>& sun = {})
      : table_(rgb_color_space("srgb")),
        values_(table_.in_rgb()),
        sun_(sun),
        lights_(description(environment, sun), table_) {}

  /// All light, or what draws find too.
  LightValue evaluate(const Vec3f& direction) const {
    const LightSeen seen = see(direction);
    return {colour(seen.all()), seen.pdf};
  }
  LightValue evaluate_drawn(const Vec3f& direction) const {
    const LightSeen seen = see(direction);
    return {colour(seen.radiance), seen.pdf};
  }
  float pdf(const Vec3f& direction) const { return evaluate(direction).pdf; }
  RgbSample sample(float u0, float u1, float u2) const {
    const LightSample draw = lights_.sample(Vec3f(0), values_, u0, u1, u2);
    return {draw.direction, colour(draw.radiance), draw.pdf};
  }
  bool is_drawn() const { return lights_.is_drawn(); }
  const std::optional<Sun>& sun() const { return sun_; }

 private:
  LightSeen see(const Vec3f& direction) const {
    return lights_.escape(Vec3f(0), direction, values_);
  }
  static Rgb colour(const SampledSpectrum& rgb) { return {rgb[0], rgb[1], rgb[2]}; }
  static SceneLightsDescription description(const std::optional<ImageEnvironment>& environment,
                                            const std::optional<Sun>& sun) {
    SceneLightsDescription lights;
    if (environment) lights.lights.emplace_back(EnvironmentLight{.environment = *environment});
    if (sun) lights.lights.emplace_back(SunLight{.sun = *sun});
    return lights;
  }

  SpectrumTable table_;
  SpectrumValues values_;
  std::optional<Sun> sun_;
  SceneLights lights_;
};

/// Integral over all directions, by the midpoint rule in azimuth and height. The rows of an image
/// are split evenly if `rows` is a multiple of theirs.
double integrate(const std::function<double(const Vec3f&)>& f, int columns, int rows) {
  double sum = 0;
  for (int row = 0; row < rows; ++row) {
    const double top = std::cos(std::numbers::pi * row / rows);
    const double bottom = std::cos(std::numbers::pi * (row + 1) / rows);
    const double solid_angle = 2 * std::numbers::pi * (top - bottom) / columns;
    for (int column = 0; column < columns; ++column) {
      const Vec3f d = lat_long_direction((column + 0.5F) / static_cast<float>(columns),
                                         static_cast<float>(0.5 * (top + bottom)), UpAxis::kY);
      sum += f(d) * solid_angle;
    }
  }
  return sum;
}

/// Samples fall where the density says: bins of latitude and longitude, against its integral. The
/// sun's disc, smaller than any bin, has a bin of its own.
void expect_samples_follow_pdf(const std::string& name, const Lights& lights) {
  constexpr int kColumns = 24;
  constexpr int kRows = 12;
  constexpr int kFine = 24;  // points for a bin and axis
  constexpr int kSamples = 500'000;
  const auto bin = [](const Vec3f& d) {
    const LatLong position = lat_long(d, UpAxis::kY);
    return std::clamp(static_cast<int>(position.v * kRows), 0, kRows - 1) * kColumns +
           std::clamp(static_cast<int>(position.u * kColumns), 0, kColumns - 1);
  };
  const auto in_sun = [&](const Vec3f& d) {
    return lights.sun() && lights.sun()->disc().contains(d);
  };
  std::vector<double> expected(kRows * kColumns + 1, 0.0);
  std::vector<uint64_t> counts(expected.size(), 0);
  // Quadrature points that happen to lie in the disc are left to its bin.
  integrate(
      [&](const Vec3f& d) {
        const double fine_rows = kRows * kFine;
        const double row =
            std::min(fine_rows - 1, std::floor(lat_long(d, UpAxis::kY).v * fine_rows));
        const double solid_angle = 2 * std::numbers::pi / (kColumns * kFine) *
                                   (std::cos(std::numbers::pi * row / fine_rows) -
                                    std::cos(std::numbers::pi * (row + 1) / fine_rows));
        if (!in_sun(d)) expected[bin(d)] += kSamples * lights.pdf(d) * solid_angle;
        return 0.0;
      },
      kColumns * kFine, kRows * kFine);
  if (lights.sun()) {
    expected.back() =
        kSamples * lights.pdf(lights.sun()->direction()) * lights.sun()->disc().solid_angle();
  }
  RandomStream random(11, 12, 13, 14);
  for (int i = 0; i < kSamples; ++i) {
    const float u0 = random.uniform();
    const float u1 = random.uniform();
    const RgbSample sample = lights.sample(u0, u1, random.uniform());
    ASSERT_NEAR(sample.direction.length(), 1, 1e-6);
    ++counts[in_sun(sample.direction) ? counts.size() - 1 : bin(sample.direction)];
  }
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  EXPECT_NEAR(total, kSamples, 1e-3 * kSamples) << name << ": the density does not integrate to 1";
  for (double& value : expected) value *= kSamples / total;
  EXPECT_TRUE(testing::check_chi_square(name, testing::chi_square_test(counts, expected)));
}

/// What is drawn of f · radiance and what directions find that are drawn uniformly add up to its
/// integral, by the balance heuristic.
void expect_estimates_integral(const std::string& name, const Lights& lights) {
  // A lobe that no light is symmetric to, as a phase function would weight the light.
  const Vec3f axis = Vec3f(1, 0.4F, -0.7F).normalized();
  const auto f = [&](const Vec3f& d) { return 1.0 + d.dot(axis) + 0.3 * d.y * d.z; };
  double expected = integrate(
      [&](const Vec3f& d) {
        const LightValue value = lights.evaluate(d);
        const bool in_sun = lights.sun() && lights.sun()->disc().contains(d);
        return f(d) *
               (luminance(value.radiance) - (in_sun ? luminance(lights.sun()->radiance()) : 0.0F));
      },
      1536, 768);
  if (lights.sun())
    expected += f(lights.sun()->direction()) * luminance(lights.sun()->irradiance());
  RandomStream random(21, 22, 23, 24);
  testing::RunningStatistics estimates;
  for (int i = 0; i < 500'000; ++i) {
    const float u0 = random.uniform();
    const float u1 = random.uniform();
    const RgbSample sample = lights.sample(u0, u1, random.uniform());
    double estimate = 0;
    if (sample.pdf > 0) {
      const double density = sample.pdf + kUniformSpherePdf;
      estimate += f(sample.direction) * luminance(sample.radiance) / density;
    }
    const float height = random.uniform();
    const Vec3f found = sample_sphere(height, random.uniform());
    const LightValue value = lights.evaluate_drawn(found);
    estimate += f(found) * luminance(value.radiance) / (value.pdf + kUniformSpherePdf);
    // Of what is never drawn chance finds all.
    const Rgb rest = lights.evaluate(found).radiance - value.radiance;
    estimate += f(found) * luminance(rest) / kUniformSpherePdf;
    estimates.add(estimate);
  }
  EXPECT_TRUE(testing::check_mean(name, estimates, expected, {.absolute = 1e-4 * expected}));
}

struct SamplingCase {
  std::string name;
  Lights lights;
};

std::vector<SamplingCase> all_lights() {
  const Sun sun({.elevation = 30, .azimuth = 200}, UpAxis::kY);
  const ImageEnvironment rough(rough_image(), UpAxis::kY, "rough");
  const ImageEnvironment peak(grey_image(64, 32,
                                         [](int column, int row) {
                                           const int from_middle =
                                               std::abs(column - 40) + std::abs(row - 9);
                                           return from_middle < 3 ? 200.0F : 1 + 0.02F * column;
                                         }),
                              UpAxis::kY, "peak");
  const ImageEnvironment black(grey_image(8, 4, [](int, int) { return 0.0F; }), UpAxis::kY, "b");
  const ImageEnvironment one(grey_image(1, 1, [](int, int) { return 2.0F; }), UpAxis::kY, "1");
  return {{"sun alone", Lights({}, sun)},
          {"image", Lights(rough)},
          {"image with a peak", Lights(peak)},
          {"image with a peak and sun", Lights(peak, sun)},
          {"image and sun", Lights(rough, sun)},
          {"black image and sun", Lights(black, sun)},
          {"image of one pixel", Lights(one)},
          {"sky", Lights(make_sky({.elevation = 30, .azimuth = 200}, UpAxis::kY))},
          {"sky and sun", Lights(make_sky({.elevation = 30, .azimuth = 200}, UpAxis::kY), sun)}};
}

TEST(Lights, SamplesFollowADensityThatIntegratesToOne) {
  int drawn = 0;
  for (const SamplingCase& c : all_lights()) {
    if (!c.lights.is_drawn()) continue;
    expect_samples_follow_pdf(c.name, c.lights);
    ++drawn;
  }
  EXPECT_GE(drawn, 6);
}

TEST(Lights, SamplesEstimateTheIntegralOfTheLight) {
  for (const SamplingCase& c : all_lights()) expect_estimates_integral(c.name, c.lights);
}

TEST(Lights, ASampleCarriesWhatEvaluationGivesOfLightsThatAreDrawn) {
  for (const SamplingCase& c : all_lights()) {
    if (!c.lights.is_drawn()) continue;
    RandomStream random(31, 32, 33, 34);
    int moved = 0;  // over the edge of a pixel, by rounding
    for (int i = 0; i < 20'000; ++i) {
      const float u0 = random.uniform();
      const float u1 = random.uniform();
      const RgbSample sample = c.lights.sample(u0, u1, random.uniform());
      const LightValue value = c.lights.evaluate_drawn(sample.direction);
      const auto is_near = [](float a, float b) { return std::abs(a - b) <= 1e-3F * std::abs(b); };
      if (!is_near(sample.pdf, value.pdf)) {
        ++moved;
      } else {
        ASSERT_TRUE(is_near(luminance(sample.radiance), luminance(value.radiance))) << c.name;
      }
      ASSERT_TRUE(std::isfinite(sample.pdf) && is_finite(sample.radiance)) << c.name;
    }
    EXPECT_LE(moved, 5) << c.name;
  }
}

TEST(Lights, ExtremesOfTheUniformNumbersAreDirections) {
  constexpr float kLast = 1.0F - 0x1p-24F;
  for (const SamplingCase& c : all_lights()) {
    for (const float u0 : {0.0F, kLast}) {
      for (const float u1 : {0.0F, kLast}) {
        for (const float u2 : {0.0F, kLast}) {
          const RgbSample sample = c.lights.sample(u0, u1, u2);
          EXPECT_NEAR(sample.direction.length(), 1, 1e-6) << c.name;
          EXPECT_TRUE(std::isfinite(sample.pdf)) << c.name;
        }
      }
    }
  }
}

TEST(Lights, AreNotDrawnWhereTheyAreBlack) {
  const ImageEnvironment black(grey_image(8, 4, [](int, int) { return 0.0F; }), UpAxis::kY, "b");
  EXPECT_FALSE(Lights(black).is_drawn());
  EXPECT_TRUE(Lights(black, Sun({}, UpAxis::kY)).is_drawn());
  EXPECT_EQ(black.evaluate({0, 1, 0}).pdf, kUniformSpherePdf);
}

TEST(Lights, DrawImagesOnlyForTheirPeaks) {
  // Most skies are even enough; beside a sun, which is drawn, some more are.
  EXPECT_FALSE(Lights(make_sky({.elevation = 60}, UpAxis::kY)).is_drawn());
  const SunParameters low{.elevation = 30, .azimuth = 200};
  EXPECT_TRUE(Lights(make_sky(low, UpAxis::kY)).is_drawn());
  const Lights both(make_sky(low, UpAxis::kY), Sun(low, UpAxis::kY));
  EXPECT_EQ(both.pdf(sky_direction(25, 200, UpAxis::kY)), 0);
  EXPECT_GT(both.pdf(sky_direction(30, 200, UpAxis::kY)), 0);
  // A cap of a radius [rows] that brings some part of the light.
  const auto cap = [](float radius, float share) {
    const auto in_cap = [&](int, int row) {
      return static_cast<float>(row) < radius ? 1.0F : 0.0F;
    };
    const float part = 0.5F * (1 - std::cos(std::numbers::pi_v<float> * radius / 180));
    return ImageEnvironment(grey_image(360, 180,
                                       [&](int column, int row) {
                                         return 1 - share + in_cap(column, row) * share / part;
                                       }),
                            UpAxis::kY, "cap");
  };
  EXPECT_FALSE(Lights(cap(90, 1)).is_drawn());
  EXPECT_FALSE(Lights(cap(30, 0.02F)).is_drawn());
  EXPECT_TRUE(Lights(cap(10, 0.5F)).is_drawn());
  const Lights peaked(cap(10, 0.5F));
  EXPECT_GT(peaked.pdf({0, 1, 0}), 100 * kUniformSpherePdf);
  EXPECT_EQ(peaked.pdf({0, -1, 0}), 0) << "what is below the mean is found by chance";
}

}  // namespace
}  // namespace freepath
