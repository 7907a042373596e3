// The colours of films: their space, which files tell, and their balance of white.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "freepath/spectra/rgb_color_space.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

/// A sky and nothing else, before which a film is described.
std::string sky(const std::string& before, const std::string& light) {
  return before + R"(
    PixelFilter "box"
    Camera "perspective"
    WorldBegin
    LightSource "infinite" )" +
         light;
}

constexpr const char* kFilmOfSky = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4 )";

Picture seen(const std::string& text, ColorMode mode) {
  return render_text(text, {.mode = mode, .samples = 1024});
}

void expect_colour(const Picture& picture, const std::array<double, 3>& expected,
                   double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.mean[c], expected[c], tolerance) << c;
}

// By Bradford's published matrix from D50 to D65: D65 as seen by a film for D50.
TEST(FilmColours, WhiteIsBalanced) {
  const std::string film = std::string(kFilmOfSky) + R"("float whitebalance" )";
  for (const ColorMode mode : kColorModes) {
    SCOPED_TRACE(name_of(mode));
    expect_colour(seen(sky(film + "5000", "\"rgb L\" [ 1 1 1 ]"), mode), {0.8276, 1.0223, 1.3695},
                  0.003);
    expect_colour(seen(sky(film + "6500", "\"rgb L\" [ 1 1 1 ]"), mode), {1, 1, 1}, 0.003);
    // Daylight of the balance's own temperature is white.
    expect_colour(seen(sky(film + "5000", "\"spectrum L\" \"stdillum-D50\""), mode), {1, 1, 1},
                  0.003);
    const Picture lamp = seen(sky(film + "2856", "\"spectrum L\" \"stdillum-A\""), mode);
    EXPECT_NEAR(lamp.mean[0], 1, 0.01);
    EXPECT_NEAR(lamp.mean[2], 1, 0.02);
  }
}

TEST(FilmColours, CamerasAreBalancedForDaylight) {
  const std::string film = std::string(kFilmOfSky) + R"("string sensor" "canon_eos_100d" )";
  const Picture day = seen(sky(film, "\"rgb L\" [ 1 1 1 ]"), ColorMode::kRgb);
  expect_colour(day, {1, 1, 1}, 0.003);
  ASSERT_EQ(day.warnings.size(), 1U);
  EXPECT_NE(day.warnings[0].find("canon_eos_100d"), std::string::npos);
  expect_colour(
      seen(sky(film + "\"float whitebalance\" 5000", "\"rgb L\" [ 1 1 1 ]"), ColorMode::kRgb),
      {0.8276, 1.0223, 1.3695}, 0.003);
}

TEST(FilmColours, BalancesOfNoLightAreRefused) {
  for (const char* const temperature : {"-1", "500", "30000"}) {
    EXPECT_THROW(seen(sky(std::string(kFilmOfSky) + "\"float whitebalance\" " + temperature,
                          "\"rgb L\" [ 1 1 1 ]"),
                      ColorMode::kRgb),
                 Error);
  }
}

// R, G, B of the ACES space's red, and what sRGB's primaries make of it, by the matrices that their
// standards give.
TEST(FilmColours, FilesTellTheSpaceOrAreConverted) {
  const std::string text =
      sky("ColorSpace \"aces2065-1\"\n" + std::string(kFilmOfSky), "\"rgb L\" [ .5 .1 .1 ]");
  for (const ColorMode mode : kColorModes) {
    SCOPED_TRACE(name_of(mode));
    const Picture picture = seen(text, mode);
    // The table of spectra is 3 % off for so saturated a colour.
    const double fit = mode == ColorMode::kSpectral ? 0.04 : 0;
    expect_colour(picture, {0.5, 0.1, 0.1}, 0.004 + 0.5 * fit);
    ASSERT_TRUE(picture.image.chromaticities);

    const TemporaryFile exr("space.exr");
    write_exr(exr.path().string(), picture.image);
    const Image read = read_image(exr.path().string());
    ASSERT_TRUE(read.chromaticities);
    const auto& [primaries, white] = *read.chromaticities;
    EXPECT_NEAR(primaries.red.x, 0.7347, 1e-6);
    EXPECT_NEAR(primaries.blue.y, -0.077, 1e-6);
    EXPECT_NEAR(white.x, 0.32168, 2e-4);
    EXPECT_NEAR(white.y, 0.33767, 2e-4);

    const Image converted = in_srgb(read);
    EXPECT_FALSE(converted.chromaticities);
    const std::array<double, 3> expected{1.1279, -0.0117, 0.0847};
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(converted.pixel(1, 1)[c], expected[c], 0.004 + 1.2 * fit) << c;

    const TemporaryFile png("space.png");
    write_png(png.path().string(), picture.image);
    const Image eight_bits = read_image(png.path().string());
    EXPECT_EQ(eight_bits.pixel(1, 1)[0], 1);
    EXPECT_EQ(eight_bits.pixel(1, 1)[1], 0);
    EXPECT_NEAR(eight_bits.pixel(1, 1)[2], 0.0847, 0.008);
  }
  // The bytes: linear blue is 0.08466 by the matrices of SMPTE ST 2065-1 and IEC 61966-2-1 with no
  // adaptation of white, as in pbrt-v4 (ConvertRGBColorSpace), which sRGB encodes as 82.1 of 255.
  // Adapted by Bradford's responses from ACES' white (near D60) to D65 it would be 86.4.
  Image exact{.width = 1, .height = 1, .channels = {"R", "G", "B"}, .values = {0.5F, 0.1F, 0.1F}};
  const RgbColorSpace& aces = rgb_color_space("aces2065-1");
  exact.chromaticities = RgbChromaticities{aces.primaries(), aces.white()};
  const TemporaryFile png("exact.png");
  write_png(png.path().string(), exact);
  const Image read = read_image(png.path().string());
  EXPECT_EQ(read.pixel(0, 0)[0], 1);
  EXPECT_EQ(read.pixel(0, 0)[1], 0);
  EXPECT_EQ(std::lround(255 * srgb_from_linear(read.pixel(0, 0)[2])), 82);
  EXPECT_FALSE(
      seen(sky(kFilmOfSky, "\"rgb L\" [ .5 .1 .1 ]"), ColorMode::kRgb).image.chromaticities);
}

// Images of lights and textures are converted by what their files tell.
TEST(FilmColours, SpacesOfImagesAreHeeded) {
  const RgbColorSpace& space = rgb_color_space("rec2020");
  Image image{.width = 8, .height = 8, .channels = {"R", "G", "B"}};
  for (int i = 0; i < 64; ++i) image.values.insert(image.values.end(), {0.4F, 0.4F, 0.3F});
  const TemporaryFile file("rec2020.exr");
  image.chromaticities = RgbChromaticities{space.primaries(), space.white()};
  write_exr(file.path().string(), image);
  const Vec3d expected = rgb_color_space("srgb").from_xyz(space.to_xyz(Vec3d(0.4F, 0.4F, 0.3F)));
  const std::string name = "\"string filename\" \"" + file.path().string() + "\"";
  expect_colour(seen(sky(kFilmOfSky, name), ColorMode::kRgb), {expected.x, expected.y, expected.z},
                0.001);
  const std::string wall = R"(
    Texture "paint" "spectrum" "imagemap" )" +
                           name + R"(
    Material "diffuse" "texture reflectance" "paint"
    Shape "sphere" "float radius" 3
  )";
  const Picture painted = render_text(kUnlimited + sky(kFilmOfSky, "\"rgb L\" [ 0 0 0 ]") + wall +
                                          R"(AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
                                             Shape "disk" "float radius" 0.001)",
                                      {.samples = 1});
  const int red = *find_channel(painted.image, "albedo.R");
  EXPECT_NEAR(painted.image.pixel(1, 1)[red], expected.x, 0.001);
  EXPECT_NEAR(painted.image.pixel(1, 1)[red + 2], expected.z, 0.001);
}

}  // namespace
}  // namespace freepath::testing
