// Films of type 'spectral': the radiance of buckets of wavelengths.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "freepath/spectra/wavelengths.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// A grey light seen through an absorber whose extinction rises from 0 at 360 nm to 2 at 830 nm.
std::string seen_through_absorber(const std::string& film_parameters) {
  return R"(Film "spectral" "integer xresolution" 8 "integer yresolution" 8 )" + film_parameters +
         R"(
    PixelFilter "box"
    LookAt 0.5 0.5 20  0.5 0.5 0  0 1 0
    Camera "perspective" "float fov" 2
    WorldBegin
    LightSource "infinite" "spectrum L" [ 300 1 900 1 ]
    MakeNamedMedium "filter" "string type" "homogeneous" "spectrum sigma_a" [ 360 0 830 2 ]
      "spectrum sigma_s" [ 300 0 900 0 ]
  )" + medium_box("filter", Vec3d(0), Vec3d(1));
}

/// What a bucket from `low` to `high` [nm] holds: the mean over wavelengths as they are drawn.
double expected_radiance(double low, double high) {
  constexpr int kNodes = 1000;
  double sum = 0;
  double weights = 0;
  for (int i = 0; i < kNodes; ++i) {
    const double wavelength = low + (high - low) * (i + 0.5) / kNodes;
    const double weight = wavelength_pdf(wavelength, WavelengthDensity::kVisible);
    sum += weight * std::exp(-2 * (wavelength - 360) / 470);
    weights += weight;
  }
  return sum / weights / kLuminousIntegral;
}

void expect_bucket(const Image& image, const std::string& channel, double low, double high) {
  ASSERT_TRUE(find_channel(image, channel)) << channel;
  const RunningStatistics pixels = statistics_of(image, channel);
  const double expected = expected_radiance(low, high);
  EXPECT_TRUE(check_mean(channel, pixels, expected, {.z = 4.5}));
  EXPECT_LT(pixels.standard_error(), 0.01 * expected) << channel;
}

TEST(SpectralFilm, HasTheSpectrumBehindAnAbsorber) {
  for (const int wavelengths : {4, 8}) {
    const Picture picture =
        render_text(seen_through_absorber("\"integer nbuckets\" 4"),
                    {.mode = ColorMode::kSpectral, .samples = 4096, .wavelengths = wavelengths});
    expect_sound(picture);
    expect_bucket(picture.image, "S0.418,750000nm", 360, 477.5);
    expect_bucket(picture.image, "S0.536,250000nm", 477.5, 595);
    expect_bucket(picture.image, "S0.653,750000nm", 595, 712.5);
    expect_bucket(picture.image, "S0.771,250000nm", 712.5, 830);
  }
}

TEST(SpectralFilm, HasTheBucketsThatItIsAskedFor) {
  const Picture picture = render_text(
      seen_through_absorber(R"("integer nbuckets" 2 "float lambdamin" 500 "float lambdamax" 600)"),
      {.mode = ColorMode::kSpectral, .samples = 2048});
  expect_bucket(picture.image, "S0.525,000000nm", 500, 550);
  expect_bucket(picture.image, "S0.575,000000nm", 550, 600);
  const Picture standard =
      render_text(seen_through_absorber(""), {.mode = ColorMode::kSpectral, .samples = 2});
  EXPECT_EQ(standard.image.channels.back(), "S0.815,312500nm");
  EXPECT_EQ(standard.image.channels.size(), picture.image.channels.size() + 14);
}

// Each channel's path adds to its own wavelength.
TEST(SpectralFilm, IsTheSameByAPathForEachWavelength) {
  const Picture picture = render_text("Integrator \"volpath\" \"string tracker\" \"delta\"\n" +
                                          seen_through_absorber("\"integer nbuckets\" 1"),
                                      {.mode = ColorMode::kSpectral, .samples = 1024});
  expect_bucket(picture.image, "S0.595,000000nm", 360, 830);
}

TEST(SpectralFilm, HasNoBucketsInRgb) {
  const Picture picture = render_text(seen_through_absorber(""), {.samples = 2});
  EXPECT_FALSE(find_channel(picture.image, "S0.815,312500nm"));
}

}  // namespace
}  // namespace freepath::testing
