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

void expect_near(const Vec3d& value, const Vec3d& expected, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << "channel " << i;
}

TEST(SpectrumTable, LightComesBackAsTheColourThatItWasMadeOf) {
  SpectrumTable table(rgb_color_space("srgb"));
  const Vec3d color(0.3, 1.7, 0.9);
  const SpectrumId light =
      table.add(RgbSpectrum::illuminant(color, table.space()), SpectrumRole::kIlluminant);
  expect_near(mean_rgb(table, [&](const SpectrumValues& v) { return v[light]; }), color, 2e-3);
  const Channels rgb = table.in_rgb()[light];
  expect_near(Vec3d(rgb[0], rgb[1], rgb[2]), color, 2e-3);
  EXPECT_EQ(rgb[3], 0);
}

TEST(SpectrumTable, AReflectanceHasItsColourUnderTheWhiteOfTheSpace) {
  SpectrumTable table(rgb_color_space("srgb"));
  const Vec3d color(0.8, 0.1, 0.3);
  const SpectrumId paint =
      table.add(RgbSpectrum::reflectance(color, table.space()), SpectrumRole::kReflectance);
  const SpectrumId white = table.add(table.space().illuminant(), SpectrumRole::kIlluminant);
  expect_near(mean_rgb(table, [&](const SpectrumValues& v) { return v[paint] * v[white]; }), color,
              2e-3);
  const Channels rgb = table.in_rgb()[paint];
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
      const Channels rgb = table.in_rgb().illuminant(color);
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
  const Channels rgb = table.in_rgb()[glass];
  EXPECT_NEAR(rgb[0], 1.5167, 5e-4);  // Schott's n_d, at 587.6 nm, is 1.5168
  EXPECT_EQ(rgb[0], rgb[1]);
  EXPECT_FALSE(table.is_constant(glass));
  EXPECT_TRUE(table.is_constant(table.add(1.5, SpectrumRole::kIndex)));
}

TEST(Channels, LargestMagnitudeKeepsNaN) {
  EXPECT_EQ(largest_magnitude(Channels(1, -3, 2)), 3);
  EXPECT_TRUE(std::isnan(largest_magnitude(Channels(std::nanf(""), 1, 2))));
  EXPECT_TRUE(std::isnan(largest_magnitude(Channels(1, 2, 3, std::nanf("")))));
}

}  // namespace
}  // namespace freepath
