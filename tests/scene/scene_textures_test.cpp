// Textures as they are seen on a plane in parallel light of irradiance pi, where each place has the
// radiance of its reflectance.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

/// The unit square of (u, v) on a film of so many pixels; v runs upwards.
std::string textured(const std::string& textures, const std::string& material, int pixels) {
  return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(pixels) +
         "Scale -1 1 1\nLookAt .5 .5 3  .5 .5 0  0 1 0\n"  // with x to the right
         "Camera \"orthographic\" \"float screenwindow\" [ -.5 .5 -.5 .5 ]\nWorldBegin\n"
         "LightSource \"distant\" \"rgb L\" [ 1 1 1 ] \"float scale\" 3.14159265 "
         "\"point3 from\" [ 0 0 1 ] \"point3 to\" [ 0 0 0 ]\n" +
         textures + "\n" + material +
         " Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]\n";
}

const std::string kReflectance = R"(Material "diffuse" "texture reflectance" "t" )";

/// Every pixel, row by row from the top.
void expect_pixels(const std::string& name, const std::string& scene, int pixels,
                   const std::vector<Vec3d>& expected, uint32_t samples = 20000) {
  const Picture picture = render_text(scene, {.samples = samples});
  expect_sound(picture);
  ASSERT_EQ(expected.size(), picture.image.pixel_count());
  const char* const names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    const int value = *find_channel(picture.image, names[c]);
    const int variance = *find_channel(picture.image, std::string("variance.") + names[c]);
    for (int i = 0; i < pixels * pixels; ++i) {
      const float* const pixel = picture.image.pixel(i % pixels, i / pixels);
      EXPECT_TRUE(check_mean(fmt::format("{} {} of pixel {}", name, names[c], i), pixel[value],
                             std::sqrt(pixel[variance]), samples, expected[i][c],
                             {.absolute = 1e-4, .largest_relative_error = 0.0025}));
    }
  }
}

std::vector<Vec3d> greys(std::initializer_list<double> values) {
  std::vector<Vec3d> colours;
  for (const double value : values) colours.emplace_back(value);
  return colours;
}

TEST(SceneTexture, ConstantsScalesAndMixes) {
  const std::string textures =
      R"(Texture "a" "spectrum" "constant" "rgb value" [ .8 .4 .2 ]
         Texture "b" "spectrum" "constant" "rgb value" [ .1 .3 .5 ]
         Texture "amount" "float" "constant" "float value" .25
      )";
  const auto seen = [&](const char* name, const std::string& texture, const Vec3d& colour) {
    expect_pixels(name, textured(textures + texture, kReflectance, 1), 1, {colour});
  };
  seen("constant", R"(Texture "t" "spectrum" "constant" "rgb value" [ .7 .5 .3 ])", {.7, .5, .3});
  seen("scale", R"(Texture "t" "spectrum" "scale" "texture tex" "a" "texture scale" "amount")",
       {.2, .1, .05});
  seen("mix",
       R"(Texture "t" "spectrum" "mix" "texture tex1" "a" "texture tex2" "b" )"
       R"("texture amount" "amount")",
       Vec3d(.8, .4, .2) * .75 + Vec3d(.1, .3, .5) * .25);
}

TEST(SceneTexture, CheckerboardChangesWithUAndV) {
  const std::string board =
      R"(Texture "t" "spectrum" "checkerboard" "float uscale" 2 "float vscale" 4 )"
      R"("float vdelta" 1 "rgb tex1" [ .8 .4 .2 ] "rgb tex2" [ .1 .3 .5 ])";
  const Vec3d one(.8, .4, .2);
  const Vec3d two(.1, .3, .5);
  std::vector<Vec3d> expected;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const int u = column / 2;
      const int v = (3 - row) + 1;
      expected.push_back((u + v) % 2 == 0 ? one : two);
    }
  }
  expect_pixels("board", textured(board, kReflectance, 4), 4, expected);
}

/// Cubes of side 1/4 that are moved half a cube along x: the squares are those where they meet the
/// plane. The origin of rays lies elsewhere.
TEST(SceneTexture, CheckerboardsOfCubesLieInTheirSpace) {
  const std::string board =
      R"(AttributeBegin Translate .125 0 .1 Scale .25 .25 .25
         Texture "t" "spectrum" "checkerboard" "integer dimension" 3 )"
      R"("rgb tex1" [ .8 .4 .2 ] "rgb tex2" [ .1 .3 .5 ] AttributeEnd)";
  const Vec3d one(.8, .4, .2);
  const Vec3d two(.1, .3, .5);
  std::vector<Vec3d> expected;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 8; ++column) {
      const int x = (column + 1) / 2 - 1;  // floor((column / 8 - 1/8) · 4)
      const int y = (7 - row) / 2;
      const int z = -1;
      expected.push_back((x + y + z) % 2 == 0 ? one : two);
    }
  }
  expect_pixels("cubes", textured(board, kReflectance, 8), 8, expected, 1000);
}

// Around the middle of the unit square, seen along the axis of the mapping, the angle goes from 0
// to 1 in four quarters, whose means are 1/8, 3/8, 5/8 and 7/8.
TEST(SceneTexture, MappingsGoAroundTheirAxis) {
  const auto seen = [](const std::string& mapping, const std::string& values,
                       const std::vector<Vec3d>& expected) {
    expect_pixels(
        mapping,
        textured("AttributeBegin Translate .5 .5 -2 Texture \"t\" \"spectrum\" \"bilerp\" "
                 "\"string mapping\" \"" +
                     mapping + "\" " + values + " AttributeEnd",
                 kReflectance, 2),
        2, expected);
  };
  const auto share = [](int eighths) { return 0.5 + 0.5 * eighths / 8; };
  seen("spherical", R"("rgb v00" [ .5 .5 .5 ] "rgb v10" [ .5 .5 .5 ])",
       greys({share(3), share(1), share(5), share(7)}));
  // It begins at -x, and t, which is the height 2, has no part in it.
  seen("cylindrical", R"("rgb v00" [ .5 .5 .5 ] "rgb v01" [ .5 .5 .5 ] "rgb v10" [ 1 1 1 ])",
       greys({share(7), share(5), share(1), share(3)}));
}

TEST(SceneTexture, PlanarMappingIsByTwoVectors) {
  const std::string board =
      R"(Texture "t" "spectrum" "checkerboard" "string mapping" "planar" "vector3 v1" [ 2 0 0 ] )"
      R"("vector3 v2" [ 0 4 0 ] "float vdelta" 1 )"
      R"("rgb tex1" [ .8 .4 .2 ] "rgb tex2" [ .1 .3 .5 ])";
  std::vector<Vec3d> expected;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      expected.push_back((column / 2 + (3 - row) + 1) % 2 == 0 ? Vec3d(.8, .4, .2)
                                                               : Vec3d(.1, .3, .5));
    }
  }
  expect_pixels("planar", textured(board, kReflectance, 4), 4, expected, 1000);
}

// Pixels see the means of quarters, which are the values at their middles.
TEST(SceneTexture, BilerpIsTheMeanOfItsCorners) {
  expect_pixels(
      "bilerp",
      textured(R"(Texture "t" "spectrum" "bilerp" "rgb v00" [ .1 .1 .1 ] "rgb v01" [ .2 .2 .2 ] )"
               R"("rgb v10" [ .4 .4 .4 ] "rgb v11" [ .8 .8 .8 ])",
               kReflectance, 2),
      2,
      greys({(3 * .1 + .4 + 9 * .2 + 3 * .8) / 16, (.1 + 3 * .4 + 3 * .2 + 9 * .8) / 16,
             (9 * .1 + 3 * .4 + 3 * .2 + .8) / 16, (3 * .1 + 9 * .4 + .2 + 3 * .8) / 16}));
}

TEST(SceneTexture, DirectionsMix) {
  expect_pixels("directionmix",
                textured(R"(Texture "t" "spectrum" "directionmix" "vector3 dir" [ 3 0 4 ] )"
                         R"("rgb tex1" [ .8 .4 .2 ] "rgb tex2" [ .1 .3 .5 ])",
                         kReflectance, 1),
                1, {Vec3d(.8, .4, .2) * .8 + Vec3d(.1, .3, .5) * .2}, 1000);
}

/// A file of grey pixels, row by row from the top.
void write_greys(const std::string& path, int edge, const std::vector<double>& values) {
  Image image{edge, edge, {"R", "G", "B"}};
  for (const double value : values) {
    for (int c = 0; c < 3; ++c) image.values.push_back(static_cast<float>(value));
  }
  if (path.ends_with(".png")) {
    write_png(path, image);
  } else {
    write_exr(path, image);
  }
}

/// Between the centres of its pixels an image is bilinear: over each it has 6/8 of its value and
/// 1/8 of those at both sides.
std::vector<Vec3d> seen_greys(int edge, const std::vector<double>& values) {
  const auto at = [&](int column, int row) {
    return values[(row + edge) % edge * edge + (column + edge) % edge];
  };
  constexpr std::array<double, 3> kWeights = {1.0 / 8, 6.0 / 8, 1.0 / 8};
  std::vector<Vec3d> seen;
  for (int row = 0; row < edge; ++row) {
    for (int column = 0; column < edge; ++column) {
      double sum = 0;
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
          sum += kWeights[i + 1] * kWeights[j + 1] * at(column + i, row + j);
        }
      }
      seen.emplace_back(sum);
    }
  }
  return seen;
}

TEST(SceneTexture, ImageIsBilinearAndRepeats) {
  const std::vector<double> values = {.1, .8, .3, .6, .5, .9, .2, .4, .7};
  const TemporaryFile file("nine.exr");
  write_greys(file.path().string(), 3, values);
  const std::string texture =
      R"(Texture "t" "spectrum" "imagemap" "string filename" ")" + file.path().string() + "\" ";
  expect_pixels("image", textured(texture, kReflectance, 3), 3, seen_greys(3, values));
  // Moved by a pixel to the right and inverted.
  const std::vector<double> moved = {.8, .3, .1, .5, .9, .6, .4, .7, .2};
  std::vector<double> inverted;
  inverted.reserve(moved.size());
  for (const double value : moved) inverted.push_back(1 - value);
  expect_pixels(
      "moved",
      textured(texture + R"("float udelta" .3333333333 "bool invert" true)", kReflectance, 3), 3,
      seen_greys(3, inverted));
}

// The integer 188 of 255 is encoded 0.5029, and 128 0.2159 [IEC61966].
TEST(SceneTexture, ImageOfIntegersIsDecoded) {
  const auto linear = [](int integer) { return std::pow((integer / 255.0 + 0.055) / 1.055, 2.4); };
  const std::vector<double> values = {linear(188), linear(128), linear(128), linear(188)};
  const TemporaryFile file("four.png");
  write_greys(file.path().string(), 2, values);
  const std::string texture =
      R"(Texture "t" "spectrum" "imagemap" "string filename" ")" + file.path().string() + "\" ";
  expect_pixels("sRGB", textured(texture, kReflectance, 2), 2, seen_greys(2, values));
  expect_pixels("linear", textured(texture + R"("string encoding" "linear")", kReflectance, 2), 2,
                seen_greys(2, {188 / 255.0, 128 / 255.0, 128 / 255.0, 188 / 255.0}));
  expect_pixels("gamma", textured(texture + R"("string encoding" "gamma 2")", kReflectance, 2), 2,
                seen_greys(2, {std::pow(188 / 255.0, 2), std::pow(128 / 255.0, 2),
                               std::pow(128 / 255.0, 2), std::pow(188 / 255.0, 2)}));
}

// A float texture as the amount of a mix, which is 0 or 1.
TEST(SceneTexture, FloatsDecideBetweenMaterials) {
  const std::string parts =
      R"(Texture "t" "float" "checkerboard" "float uscale" 2 "float vscale" 2
         MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [ .2 .2 .2 ]
         MakeNamedMaterial "b" "string type" "diffuse" "rgb reflectance" [ .6 .6 .6 ]
      )";
  expect_pixels(
      "mix",
      textured(parts, R"(Material "mix" "string materials" [ "a" "b" ] "texture amount" "t")", 2),
      2, greys({.2, .6, .6, .2}));
}

}  // namespace
}  // namespace freepath::testing
