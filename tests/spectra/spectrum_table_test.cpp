// What spectra are in the channels of paths: R, G, B, or random wavelengths.

#include "freepath/spectra/spectrum_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "freepath/spectra/named_spectra.h"

namespace freepath {
namespace {

/// The mean of to_rgb over wavelengths that stratify the spectrum.
template <class Radiance>
Vec3d mean_rgb(const SpectrumTable& table, const Radiance& radiance) {
  constexpr int kSamples = 4096;
  Vec3d sum(0);
  for (int i = 0; i < kSamples; ++i) {
    const PathWavelengths wavelengths =
        sample_wavelengths<kMaxChannels>((i + 0.5) / kSamples, WavelengthDensity::kVisible);
    const SpectrumValues values = table.at(wavelengths);
    sum += Vec3d(values.to_rgb(radiance(values)));
  }
  return sum / kSamples;
}

Vec3d vector_of(const SampledSpectrum& rgb) { return {rgb[0], rgb[1], rgb[2]}; }

void expect_near(const Vec3d& value, const Vec3d& expected, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << "channel " << i;
}

TEST(SpectrumTable, LightComesBackAsTheColourThatItWasMadeOf) {
  SpectrumTable table(rgb_color_space("srgb"));
  const Vec3d color(0.3, 1.7, 0.9);
  const SpectrumId light =
      table.add(RgbSpectrum::illuminant(color, table.space()), SpectrumRole::kIlluminant);
  expect_near(mean_rgb(table, [&](const SpectrumValues& v) { return v[light]; }), color, 2e-3);
  const SampledSpectrum rgb = table.in_rgb()[light];
  expect_near(Vec3d(rgb[0], rgb[1], rgb[2]), color, 2e-3);
  EXPECT_EQ(rgb[3], 0);
}

TEST(SpectrumTable, InRgbColoursAreExactlyWhatTheyAreGivenAs) {
  const Vec3d color(0.32, 0.48, 0.8);
  const SampledSpectrum expected(0.32F, 0.48F, 0.8F);
  const RgbColorSpace& srgb = rgb_color_space("srgb");
  SpectrumTable table(srgb);
  const SpectrumId light =
      table.add(RgbSpectrum::illuminant(color, srgb), SpectrumRole::kIlluminant);
  const SpectrumId paint =
      table.add(RgbSpectrum::reflectance(color, srgb), SpectrumRole::kReflectance);
  const SpectralDistribution sigma = RgbSpectrum::unbounded(color * 10.0, srgb);
  const SpectrumId scaled = table.add(sigma.scaled(0.1), SpectrumRole::kReflectance);
  const SpectrumValues rgb = table.in_rgb();
  EXPECT_EQ(rgb[light], expected);
  EXPECT_EQ(rgb[paint], expected);
  EXPECT_EQ(rgb[scaled], expected);
  EXPECT_EQ(rgb.value_of(sigma, SpectrumRole::kReflectance, 2), 8.0F);
  EXPECT_EQ(rgb.illuminant(Vec3f(0.32F, 0.48F, 0.8F)), expected);
}

TEST(SpectrumTable, InRgbColoursOfAnotherSpaceAreConverted) {
  const RgbColorSpace& of_film = rgb_color_space("srgb");
  const Vec3d color(0.32, 0.48, 0.4);
  for (const std::string_view name : {"dci-p3", "rec2020", "aces-cg"}) {
    SCOPED_TRACE(name);
    const RgbColorSpace& space = rgb_color_space(name);
    SpectrumTable table(of_film);
    const SpectrumId light =
        table.add(RgbSpectrum::illuminant(color, space), SpectrumRole::kIlluminant);
    const SpectrumId paint =
        table.add(RgbSpectrum::reflectance(color, space), SpectrumRole::kReflectance);
    const SpectrumId grey =
        table.add(RgbSpectrum::reflectance(Vec3d(0.3), space), SpectrumRole::kReflectance);
    const SpectrumValues rgb = table.in_rgb();
    const Vec3d converted = of_film.from_xyz(space.to_xyz(color));
    expect_near(vector_of(rgb[light]), converted, 1e-7);
    // A surface is lit by the white of the film.
    const Vec3d white = of_film.from_xyz(space.to_xyz(Vec3d(1)));
    expect_near(vector_of(rgb[paint]), converted / white, name == "aces-cg" ? 0.01 : 1e-7);
    EXPECT_EQ(rgb[grey], SampledSpectrum(0.3F, 0.3F, 0.3F));
  }
}

TEST(SpectrumTable, WhatIsSeenIsTheMeanOverWavelengths) {
  for (const std::string_view name : {"srgb", "rec2020"}) {
    SCOPED_TRACE(name);
    SpectrumTable table(rgb_color_space(name));
    for (const Vec3d& color :
         {Vec3d(0.32, 0.48, 0.8), Vec3d(0.8, 0.1, 0.3), Vec3d(0.02, 0.025, 0.03), Vec3d(1, 0, 0)}) {
      const SpectrumId light = table.add(RgbSpectrum::illuminant(color, rgb_color_space("srgb")),
                                         SpectrumRole::kIlluminant);
      const SpectrumValues seen = table.seen_in_rgb();
      const double size = std::max({color.x, color.y, color.z});
      const Vec3d mean = mean_rgb(table, [&](const SpectrumValues& v) { return v[light]; });
      // Constant colours are seen by the quadrature at every nanometre.
      expect_near(vector_of(seen[light]), mean, 5e-5 * size);
      const Vec3f pixel(color);
      expect_near(vector_of(seen.illuminant(pixel)),
                  mean_rgb(table, [&](const SpectrumValues& v) { return v.illuminant(pixel); }),
                  3e-5 * size);
      // Lights of images and constant ones are the same.
      expect_near(vector_of(seen.illuminant(pixel)), vector_of(seen[light]), 5e-5 * size);
    }
    EXPECT_EQ(table.seen_in_rgb().channels(), 3);
  }
}

TEST(SpectrumTable, AReflectanceHasItsColourUnderTheWhiteOfTheSpace) {
  SpectrumTable table(rgb_color_space("srgb"));
  const Vec3d color(0.8, 0.1, 0.3);
  const SpectrumId paint =
      table.add(RgbSpectrum::reflectance(color, table.space()), SpectrumRole::kReflectance);
  const SpectrumId white = table.add(table.space().illuminant(), SpectrumRole::kIlluminant);
  expect_near(mean_rgb(table, [&](const SpectrumValues& v) { return v[paint] * v[white]; }), color,
              2e-3);
  const SampledSpectrum rgb = table.in_rgb()[paint];
  expect_near(Vec3d(rgb[0], rgb[1], rgb[2]), color, 2e-3);
}

TEST(SpectrumTable, ColoursOfTexturesComeBackAndGreysAreConstant) {
  const RgbColorSpace& of_textures = rgb_color_space("srgb");
  for (const std::string_view name : {"srgb", "rec2020"}) {
    SCOPED_TRACE(name);
    SpectrumTable table(rgb_color_space(name));
    const SpectrumId white = table.add(of_textures.illuminant(), SpectrumRole::kIlluminant);
    for (const Vec3f& color :
         {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1), Vec3f(0.2, 0.5, 0.9)}) {
      expect_near(mean_rgb(table, [&](const SpectrumValues& v) { return v.illuminant(color); }),
                  table.space().from_xyz(of_textures.to_xyz(Vec3d(color))), 5e-3);
      const SampledSpectrum rgb = table.in_rgb().illuminant(color);
      expect_near(Vec3d(rgb[0], rgb[1], rgb[2]),
                  table.space().from_xyz(of_textures.to_xyz(Vec3d(color))), 1e-5);
      expect_near(
          mean_rgb(table, [&](const SpectrumValues& v) { return v.reflectance(color) * v[white]; }),
          table.space().from_xyz(of_textures.to_xyz(Vec3d(color))), 5e-3);
    }
    const SpectrumValues values =
        table.at(sample_wavelengths<kMaxChannels>(0.1, WavelengthDensity::kVisible));
    for (int i = 0; i < kMaxChannels; ++i) {
      EXPECT_NEAR(values.reflectance(Vec3f(0.5F))[i], 0.5, 5e-3)
          << values.wavelengths()[i] << " nm";
    }
  }
}

TEST(SpectrumTable, ARefractiveIndexIsTheSameInRGB) {
  SpectrumTable table(rgb_color_space("srgb"));
  const SpectrumId glass = table.add(named_spectrum("glass-BK7"), SpectrumRole::kIndex);
  const SampledSpectrum rgb = table.in_rgb()[glass];
  EXPECT_NEAR(rgb[0], 1.5167, 5e-4);  // Schott's n_d, at 587.6 nm, is 1.5168
  EXPECT_EQ(rgb[0], rgb[1]);
  EXPECT_FALSE(table.is_constant(glass));
  EXPECT_TRUE(table.is_constant(table.add(1.5, SpectrumRole::kIndex)));
}

TEST(SampledSpectrum, LargestMagnitudeKeepsNaN) {
  EXPECT_EQ(largest_magnitude(SampledSpectrum(1, -3, 2)), 3);
  EXPECT_TRUE(std::isnan(largest_magnitude(SampledSpectrum(std::nanf(""), 1, 2))));
  EXPECT_TRUE(std::isnan(largest_magnitude(SampledSpectrum(1, 2, 3, std::nanf("")))));
}

}  // namespace
}  // namespace freepath
