#include "freepath/sensors/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

float value(const Image& image, int column, const std::string& channel) {
  return image.pixel(column, 0)[find_channel(image, channel).value()];
}

TEST(Film, AveragesWhatThePathsFound) {
  Film film(2, 1);
  film.add(1, {.radiance = {1, 2, 3},
               .alpha = 1,
               .albedo = {0.5F, 0.25F, 1},
               .depth = 10,
               .depth_weight = 1,
               .lookups = 7});
  film.add(1, {.radiance = {3, 2, 0}, .lookups = 2});
  const Image image = film.to_image();
  EXPECT_EQ(value(image, 1, "R"), 2);
  EXPECT_EQ(value(image, 1, "G"), 2);
  EXPECT_EQ(value(image, 1, "B"), 1.5F);
  EXPECT_EQ(value(image, 1, "A"), 0.5F);
  EXPECT_EQ(value(image, 1, "albedo.G"), 0.125F);
  EXPECT_EQ(value(image, 1, "depth.Z"), 10);  // of the path that scattered
  EXPECT_EQ(value(image, 1, "lookups"), 4.5F);
  EXPECT_EQ(value(image, 1, "variance.R"), 1);      // (5 - 4) / (2 - 1)
  EXPECT_EQ(value(image, 1, "variance.G"), 0);      // equal samples
  EXPECT_EQ(value(image, 1, "variance.B"), 2.25F);  // (4.5 - 2.25) / (2 - 1)
  EXPECT_EQ(film.samples(1), 2);
}

// An error bar that is not known is not small.
TEST(Film, AVarianceThatIsNoFloatIsInfinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Film film(3, 1);
  film.add(0, {.radiance = {1e30F, 1, 1}});
  film.add(0, {.radiance = {-1e30F, 1, 1}});
  film.add(1, {.radiance = {1, 1, 1}});
  film.add(1, {.overflowed = true});
  film.add(1, {.radiance = {1, 1, 1}});
  film.add(2, {.overflowed = true});
  const Image image = film.to_image();
  EXPECT_EQ(value(image, 0, "variance.R"), kInfinity);
  EXPECT_EQ(value(image, 0, "variance.G"), 0);
  for (const char* channel : {"variance.R", "variance.G", "variance.B"}) {
    EXPECT_EQ(value(image, 1, channel), kInfinity);
    EXPECT_EQ(value(image, 2, channel), kInfinity);
  }
}

TEST(Film, VarianceIsThatOfTheMean) {
  Film film(1, 1);
  RandomStream random(1, 0, 0, 0);
  testing::RunningStatistics statistics;
  for (int i = 0; i < 10'000; ++i) {
    const float x = 1000.0F + random.uniform();
    statistics.add(x);
    film.add(0, {.radiance = {x, x, x}});
  }
  const double expected = statistics.standard_error() * statistics.standard_error();
  EXPECT_NEAR(value(film.to_image(), 0, "variance.R"), expected, 1e-4 * expected);
}

TEST(Film, ASingleSampleStandsInForItsVariance) {
  Film film(1, 1);
  film.add(0, {.radiance = {3, 0, 1}});
  EXPECT_EQ(value(film.to_image(), 0, "variance.R"), 9);
}

TEST(Film, CountsSamplesThatAreNotFiniteAndStaysFinite) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Film film(4, 1);
  EXPECT_EQ(film.non_finite_samples().samples, 0);
  film.add(2, {.radiance = {1, kNan, 1}});
  film.add(3, {.depth = kInfinity});
  film.add(3, {.radiance = {1, 1, 1}});
  // Two values whose squares and sum no float can hold.
  for (int i = 0; i < 2; ++i) film.add(0, {.radiance = {3e38F, 0, 0}});
  EXPECT_EQ(film.non_finite_samples().samples, 2);
  EXPECT_EQ(film.non_finite_samples().first_pixel, 2);
  EXPECT_EQ(film.samples(2), 0);
  EXPECT_EQ(film.samples(3), 1);
  const Image image = film.to_image();
  EXPECT_TRUE(std::all_of(image.values.begin(), image.values.end(),
                          [](float x) { return std::isfinite(x); }));
}

TEST(Film, CountsTheSamplesOfItsPixels) {
  Film film(3, 2);
  const auto counts = [&] {
    const Film::SampleCounts found = film.sample_counts();
    return std::array<std::size_t, 3>{found.fewest, found.most, found.pixels_without};
  };
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{0, 0, 6}));
  for (const std::size_t pixel : {0, 1, 2, 4, 5, 5}) film.add(pixel, {});
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{0, 2, 1}));
  film.add(3, {});
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{1, 2, 0}));
}

TEST(Film, KeepsTheMeansOfEvenAndOddSamples) {
  Film film(PixelWindow::whole(2, 1), {Layer::kHalves, Layer::kSamples});
  for (const float x : {1, 10, 3, 20, 5}) film.add(1, {.radiance = {x, 2 * x, 0}});
  const Image image = film.to_image();
  EXPECT_EQ(value(image, 1, "A.R"), 3);
  EXPECT_EQ(value(image, 1, "B.R"), 15);
  EXPECT_EQ(value(image, 1, "A.G"), 6);
  EXPECT_EQ(value(image, 1, "samples"), 5);
  EXPECT_EQ(value(image, 0, "B.R"), 0);
}

/// A sample with something of everything, of very different sizes.
PathSample any_sample(RandomStream& random) {
  const auto any = [&] { return random.uniform() * std::exp2(30 * random.uniform() - 15); };
  return {.radiance = {any(), -any(), any()},
          .alpha = random.uniform(),
          .albedo = {any(), any(), any()},
          .depth = any(),
          .depth_weight = random.uniform(),
          .lookups = static_cast<float>(static_cast<int>(1000 * random.uniform()))};
}

LayerSample any_layers(RandomStream& random) {
  LayerSample layers;
  for (Rgb* part : {&layers.normal, &layers.position, &layers.transmittance, &layers.background,
                    &layers.unscattered, &layers.at_most_once}) {
    *part = any_sample(random).radiance;
  }
  return layers;
}

// Whatever the parts: odd and even first samples, parts of one sample, in any order.
TEST(Film, PartsMergeToTheSameBits) {
  constexpr uint32_t kSamples = 100;
  const WavelengthBuckets buckets{4, 400, 800};
  const std::array<double, 4> wavelengths = {420, 530, 640, 750};
  const PixelWindow window = PixelWindow::whole(3, 2);
  const auto fill = [&](Film& film, uint32_t count) {
    for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
      for (uint32_t sample = film.first_sample(); sample < film.first_sample() + count; ++sample) {
        RandomStream random(5, static_cast<uint32_t>(pixel), sample, 0);
        const PathSample path = any_sample(random);
        film.add(pixel, path, any_layers(random));
        film.add_spectrum(pixel, wavelengths,
                          SampledSpectrum(random.uniform(), 2, 3, random.uniform()));
      }
    }
  };
  Film whole(window, LayerSet::all(), buckets);
  fill(whole, kSamples);
  RandomStream random(11, 0, 0, 0);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Film> parts;
    for (uint32_t first = 0; first < kSamples;) {
      const auto wanted = static_cast<uint32_t>(1 + 30 * random.uniform());
      const uint32_t count = std::min(kSamples - first, wanted);
      parts.emplace_back(window, LayerSet::all(), buckets, first);
      fill(parts.back(), count);
      first += count;
    }
    Film merged(window, LayerSet::all(), buckets);
    for (std::size_t i = parts.size(); i > 0; --i) {
      std::swap(parts[i - 1], parts[static_cast<std::size_t>(random.uniform() * i)]);
      for (std::size_t pixel = 0; pixel < merged.pixel_count(); ++pixel) {
        merged.merge_pixel(pixel, parts[i - 1], pixel);
      }
    }
    ASSERT_EQ(merged.to_image().values, whole.to_image().values) << parts.size();
  }
}

TEST(Film, TakesMemoryForItsLayersAlone) {
  EXPECT_EQ(Film::bytes_per_pixel({}), Film::bytes_per_pixel(LayerSet::standard()));
  // Three sums, each of two bins and the number of the higher one.
  EXPECT_EQ(Film::bytes_per_pixel({Layer::kNormal}), Film::bytes_per_pixel({}) + 51);
  EXPECT_LE(Film::bytes_per_pixel({}), 256U);
  EXPECT_LE(Film::bytes_per_pixel(LayerSet::all()), 640U);
}

TEST(Film, RefusesToBeEmpty) {
  EXPECT_THROW(Film(0, 10), Error);
  EXPECT_THROW(Film(10, -1), Error);
}

// A bucket holds the mean of what came into it, whatever came into others.
TEST(Film, GathersSpectralRadianceInBuckets) {
  const WavelengthBuckets buckets{4, 400, 800};
  Film film(PixelWindow::whole(2, 1), {}, buckets);
  EXPECT_EQ(Film::bytes_per_pixel({}, buckets), Film::bytes_per_pixel({}) + 96);
  const std::array<double, 4> wavelengths = {420, 499.9, 800, 399.9};
  film.add_spectrum(1, wavelengths, SampledSpectrum(1, 4, 7, 100));
  film.add_spectrum(1, std::span(wavelengths).first(1), SampledSpectrum(4, 9, 9, 9));
  const Image image = film.to_image();
  const std::vector<std::string> expected = {"R",
                                             "G",
                                             "B",
                                             "A",
                                             "S0.450,000000nm",
                                             "S0.550,000000nm",
                                             "S0.650,000000nm",
                                             "S0.750,000000nm"};
  EXPECT_EQ(image.channels, expected);
  EXPECT_EQ(image.values[8 + 4], 3);  // of 1, 4 and 4
  EXPECT_EQ(image.values[8 + 5], 0);
  EXPECT_EQ(image.values[8 + 6], 0);
  EXPECT_EQ(image.values[8 + 7], 7);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(image.values[i], 0);
}

}  // namespace
}  // namespace freepath
