#include "freepath/spectra/rgb_color_space.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// A published matrix, whose columns are R, G and B, with the white point it was computed for.
struct PublishedSpace {
  std::string name;
  Chromaticity white;
  std::array<std::array<double, 3>, 3> matrix;
};

/// From the primaries and white points of the standards; in agreement with the digits printed in
/// IEC 61966-2-1, SMPTE EG 432-1, ITU-R BT.2020, and the Academy's S-2014-004 and ST 2065-1.
const std::array<PublishedSpace, 5>& published_spaces() {
  static const std::array<PublishedSpace, 5> kSpaces = {{
      {"srgb",
       {0.3127, 0.3290},
       {{{0.4123907993, 0.3575843394, 0.1804807884},
         {0.2126390059, 0.7151686788, 0.0721923154},
         {0.0193308187, 0.1191947798, 0.9505321522}}}},
      {"dci-p3",
       {0.3127, 0.3290},
       {{{0.4865709486, 0.2656676932, 0.1982172852},
         {0.2289745641, 0.6917385218, 0.0792869141},
         {0.0000000000, 0.0451133819, 1.0439443689}}}},
      {"rec2020",
       {0.3127, 0.3290},
       {{{0.6369580483, 0.1446169036, 0.1688809752},
         {0.2627002120, 0.6779980715, 0.0593017165},
         {0.0000000000, 0.0280726930, 1.0609850577}}}},
      {"aces-cg",
       {0.32168, 0.33767},
       {{{0.6624541811, 0.1340042065, 0.1561876870},
         {0.2722287168, 0.6740817658, 0.0536895174},
         {-0.0055746495, 0.0040607335, 1.0103391003}}}},
      {"aces2065-1",
       {0.32168, 0.33767},
       {{{0.9525523959, 0.0000000000, 0.0000936786},
         {0.3439664498, 0.7281660966, -0.0721325464},
         {0.0000000000, 0.0000000000, 1.0088251844}}}},
  }};
  return kSpaces;
}

TEST(RgbColorSpace, MatricesAreThePublishedOnes) {
  for (const auto& [name, white, expected] : published_spaces()) {
    const RgbColorSpace& space = rgb_color_space(name);
    const Matrix3d nominal = rgb_to_xyz_matrix(space.primaries(), white);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        // Ours are for vectors as rows.
        EXPECT_NEAR(nominal[column][row], expected[row][column], 1e-9) << name;
        // With the white point of the tabulated illuminant itself.
        EXPECT_NEAR(space.rgb_to_xyz()[column][row], expected[row][column], 7e-4) << name;
      }
    }
    EXPECT_NEAR(space.white().x, white.x, 1.2e-4) << name;
    EXPECT_NEAR(space.white().y, white.y, 1.2e-4) << name;
  }
}

TEST(RgbColorSpace, MatricesAreInverseToEachOther) {
  for (const std::string_view name : rgb_color_space_names()) {
    const RgbColorSpace& space = rgb_color_space(name);
    EXPECT_EQ(space.name(), name);
    const Vec3d rgb(0.2, 0.7, 1.3);
    EXPECT_NEAR((space.from_xyz(space.to_xyz(rgb)) - rgb).length(), 0, 1e-14) << name;
  }
}

TEST(RgbColorSpace, IlluminantIsWhite) {
  for (const std::string_view name : rgb_color_space_names()) {
    const RgbColorSpace& space = rgb_color_space(name);
    const Vec3d rgb = space.from_xyz(observe(space.illuminant()));
    EXPECT_NEAR((rgb - Vec3d(1)).length(), 0, 1e-12) << name;
    Vec3d sum(0);
    for (const Vec3d& weight : space.reflectance_weights()) sum += weight;
    EXPECT_NEAR((sum - Vec3d(1)).length(), 0, 1e-12) << name;
  }
}

TEST(RgbColorSpace, UnknownNameIsAnErrorWithTheNearest) {
  try {
    rgb_color_space("rec2200");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no colour space 'rec2200'; did you mean 'rec2020'?");
  }
  EXPECT_THROW(rgb_color_space("cmyk"), Error);
}

}  // namespace
}  // namespace freepath
