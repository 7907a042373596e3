// Textures built from text, alone and within each other.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "freepath/materials/textures/texture_noise.h"
#include "tests/scene/built_scenes.h"
#include "tests/scene/expect_near.h"

namespace freepath::testing {
namespace {

/// What an error says of textures that begin in the second line.
std::string texture_error(const std::string& text) { return build_error("WorldBegin\n" + text); }

TEST(BuildTextures, HaveTheDefaultsOfPbrt) {
  const ParsedScene built(R"(WorldBegin
      Texture "constant" "float" "constant"
      Texture "scale" "float" "scale"
      Texture "mix" "float" "mix"
      Texture "checks" "float" "checkerboard"
      Texture "constant" "spectrum" "constant"
      Texture "scale" "spectrum" "scale"
      Texture "mix" "spectrum" "mix"
      Texture "checks" "spectrum" "checkerboard")");
  for (const std::string name : {"constant", "scale"}) {
    EXPECT_EQ(built.float_texture(name), 1);
    expect_near(built.spectrum_texture(name), Vec3f(1));
  }
  EXPECT_EQ(built.float_texture("mix"), 0.5F);
  expect_near(built.spectrum_texture("mix"), Vec3f(0.5F));
  EXPECT_EQ(built.float_texture("checks", 0.5F, 0.5F), 1);
  EXPECT_EQ(built.float_texture("checks", 1.5F, 0.5F), 0);
  expect_near(built.spectrum_texture("checks", 0.5F, 0.5F), Vec3f(1));
  expect_near(built.spectrum_texture("checks", 0.5F, 1.5F), Vec3f(0));
  EXPECT_TRUE(built.warnings().empty());
}

TEST(BuildTextures, OfNoiseAndDirectionHaveTheDefaultsOfPbrt) {
  const ParsedScene built(R"(WorldBegin
      Texture "bilerp" "float" "bilerp"
      Texture "bilerp" "spectrum" "bilerp" "rgb v10" [ .5 .5 .5 ]
      Texture "dots" "float" "dots"
      Texture "mix" "float" "directionmix" "float tex1" .25
      Translate 3 2 1 Scale 2 2 2
      Texture "fbm" "float" "fbm"
      Texture "wrinkled" "float" "wrinkled" "integer octaves" 2 "float roughness" .25
      Texture "windy" "float" "windy"
      Texture "marble" "spectrum" "marble" "float scale" 3 "float variation" .5
      Rotate 90 0 1 0
      Texture "turned" "float" "directionmix" "vector3 dir" [ 2 0 0 ])");
  EXPECT_EQ(built.float_texture("bilerp", 0.75F, 0.25F), 0.25F);  // t
  expect_near(built.spectrum_texture("bilerp", 1, 0), Vec3f(0.5F), 1e-3F);
  EXPECT_EQ(built.float_texture("dots", 0.5F, 0.5F), in_polka_dot(0.5F, 0.5F) ? 1 : 0);
  // The point is (0, 0, 0), (-1.5, -1, -0.5) in their space, its normal z.
  const Vec3d there(-1.5, -1, -0.5);
  EXPECT_EQ(built.float_texture("mix"), 1);
  EXPECT_NEAR(built.float_texture("turned"), 0, 1e-6);
  EXPECT_NEAR(built.float_texture("fbm"), fractal_motion(there, 0.5F, 8), 1e-6);
  EXPECT_NEAR(built.float_texture("wrinkled"), turbulence(there, 0.25F, 2), 1e-6);
  EXPECT_NEAR(built.float_texture("windy"),
              std::abs(fractal_motion(there * 0.1, 0.5F, 3)) * fractal_motion(there, 0.5F, 6),
              1e-6);
  expect_near(built.spectrum_texture("marble"),
              marble_color(static_cast<float>(
                  0.5 + 0.5 * std::sin(-3 + 0.5 * fractal_motion(there * 3, 0.5F, 8)))),
              1e-3F);
  EXPECT_TRUE(built.warnings().empty());
}

TEST(BuildTextures, AreMadeOfTexturesBeforeAndAfterThem) {
  const ParsedScene built(R"(WorldBegin
      Texture "outer" "spectrum" "mix" "texture tex1" "red" "texture tex2" "inner"
        "texture amount" "half"
      Texture "inner" "spectrum" "scale" "rgb tex" [ .5 .5 .5 ] "texture scale" "half"
      Texture "half" "float" "constant" "float value" .5
      Texture "red" "spectrum" "constant" "rgb value" [ .75 .25 .25 ]
      Texture "rough" "float" "checkerboard" "texture tex1" "half" "float tex2" .125
        "float uscale" 2 "float udelta" 1
      Material "diffuse" "texture reflectance" "outer"
      Material "conductor" "texture roughness" "rough")");
  // (0.75 + 0.25) / 2, and (0.25 + 0.25) / 2 of the others.
  expect_near(built.albedo(1), {0.5F, 0.25F, 0.25F}, 5e-4F);
  EXPECT_EQ(built.float_texture("rough", 0.75F, 0), 0.5F);
  EXPECT_EQ(built.float_texture("rough", 0.25F, 0), 0.125F);
  EXPECT_FALSE(built.scene().materials[2].is_specular());
}

TEST(BuildTextures, OfMetalsAreNoReflectances) {
  const ParsedScene built(R"(WorldBegin
      Texture "k" "spectrum" "scale" "texture tex" "three" "float scale" 2
      Texture "three" "spectrum" "constant" "rgb value" [ 3 3 3 ]
      Texture "one" "spectrum" "constant" "rgb value" [ 1 1 1 ]
      Material "conductor" "texture eta" "one" "texture k" "k"
      Material "diffuse" "texture reflectance" "one")");
  EXPECT_TRUE(built.warnings().empty());
  // k² / (4 + k²) of k = 6, for eta = 1 at normal incidence.
  expect_near(built.albedo(1), Vec3f(0.9F));
  expect_near(built.albedo(2), Vec3f(1));
  EXPECT_FALSE(built.context().reflectance_textures.contains("k"));
  EXPECT_TRUE(built.context().unbounded_textures.contains("one"));
  EXPECT_TRUE(built.context().reflectance_textures.contains("one"));
}

TEST(BuildTextures, RefuseToBeMadeOfThemselves) {
  EXPECT_EQ(texture_error(R"(Texture "a" "float" "scale" "texture tex" "b"
Texture "b" "float" "mix" "texture amount" "a")"),
            "scene.pbrt:2:1: texture 'a' is made of itself");
  // The names alone do not tell which kind is meant.
  EXPECT_EQ(texture_error(R"(Texture "a" "spectrum" "constant"
Texture "a" "float" "scale" "texture tex" "a")"),
            "scene.pbrt:3:1: texture 'a' is made of itself");
  EXPECT_EQ(texture_error(R"(Texture "a" "float" "constant"
Texture "a" "spectrum" "scale" "texture scale" "a")"),
            "");
}

TEST(BuildTextures, RefuseToBeNestedTooDeep) {
  const std::string first = "Texture \"t0\" \"float\" \"constant\"\n";
  const auto of_the_last = [](int i) {
    return fmt::format("Texture \"t{}\" \"float\" \"scale\" \"texture tex\" \"t{}\"\n", i, i - 1);
  };
  std::string up = first, down = first;
  for (int i = 1; i < 64; ++i) {
    up += of_the_last(i);
    down.insert(0, of_the_last(i));
  }
  EXPECT_EQ(texture_error(up), "");
  EXPECT_EQ(texture_error(down), "");
  EXPECT_EQ(texture_error(up + of_the_last(64)),
            "scene.pbrt:66:1: texture 't64' is part of a nest of more than 64 textures");
  EXPECT_EQ(texture_error(of_the_last(64) + down),
            "scene.pbrt:66:1: texture 't0' is part of a nest of more than 64 textures");
}

TEST(BuildTextures, SayWhichTextureIsMissing) {
  EXPECT_EQ(
      texture_error(R"(Texture "rust" "spectrum" "constant"
Material "conductor" "texture roughness" "rust")"),
      "scene.pbrt:3:22: parameter 'roughness' needs a float texture, and 'rust' is a spectrum "
      "texture");
  EXPECT_EQ(texture_error(R"(Texture "rust" "float" "constant"
Material "diffuse" "texture reflectance" "rust")"),
            "scene.pbrt:3:20: parameter 'reflectance' needs a spectrum texture, and 'rust' is a "
            "float texture");
  EXPECT_EQ(texture_error(R"(Texture "rust" "float" "constant"
Material "conductor" "texture roughness" "trust")"),
            "scene.pbrt:3:22: there is no texture 'trust'; did you mean 'rust'?");
}

TEST(BuildTextures, UnknownOnesAreErrors) {
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "chequerboard")"),
            "scene.pbrt:2:1: there is no texture of type 'chequerboard'; did you mean "
            "'checkerboard'?");
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "ptex")"),
            "scene.pbrt:2:1: the texture 'ptex' is not supported; there are: bilerp, "
            "checkerboard, constant, directionmix, dots, fbm, imagemap, marble, mix, scale, windy, "
            "wrinkled");
  for (const std::string type : {"fbm", "windy", "wrinkled"}) {
    EXPECT_EQ(texture_error("Texture \"t\" \"spectrum\" \"" + type + "\""),
              "scene.pbrt:2:1: the texture '" + type + "' is always of kind float");
  }
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "marble")"),
            "scene.pbrt:2:1: the texture 'marble' is always of kind spectrum");
}

TEST(BuildTextures, WrongParametersAreErrorsOrWarnings) {
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "constant" "rgb value" [ 1 1 1 ])"),
            "scene.pbrt:2:32: parameter 'value' must be of type float, not rgb");
  EXPECT_EQ(texture_error(R"(Texture "t" "spectrum" "constant" "float value" 1)"),
            "scene.pbrt:2:35: parameter 'value' must be of type rgb, spectrum or blackbody, not "
            "float");
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "checkerboard" "integer dimension" 4)"),
            "scene.pbrt:2:36: there is no checkerboard of dimension 4; use 2 or 3");
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "checkerboard" "string mapping" "plane")"),
            "scene.pbrt:2:36: there is no mapping 'plane'; did you mean 'planar'?");
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "fbm" "integer octaves" 65)"),
            "scene.pbrt:2:27: parameter 'octaves' is 65; it must be from 0 to 64");
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "directionmix" "vector3 dir" [ 0 0 0 ])"),
            "scene.pbrt:2:36: parameter 'dir' is 0, which is no direction");
  const ParsedScene built(R"(WorldBegin
Texture "t" "float" "constant" "float valu" 2)");
  ASSERT_EQ(built.warnings().size(), 1U);
  EXPECT_EQ(built.warnings()[0],
            "scene.pbrt:2:32: Texture 'constant' has no parameter 'valu'; did you mean 'value'?");
}

/// An image of two pixels beside each other, in a file that is there while this lives.
class TwoPixels {
 public:
  TwoPixels() : path_(std::filesystem::path(::testing::TempDir()) / name()) {
    Image image;
    image.width = 2;
    image.height = 1;
    image.channels = {"R", "G", "B"};
    image.values = {0.25F, 0.5F, 0.75F, 1, 0, 0};
    write_exr(path_.string(), image);
  }
  TwoPixels(const TwoPixels&) = delete;
  TwoPixels& operator=(const TwoPixels&) = delete;
  ~TwoPixels() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  std::string path() const { return path_.string(); }

 private:
  /// Tests may run at the same time.
  static std::string name() { return fmt::format("freepath_two_pixels_{}.exr", getpid()); }

  std::filesystem::path path_;
};

TEST(BuildTextures, ReadImages) {
  const TwoPixels pixels;
  const ParsedScene built(fmt::format(R"(WorldBegin
      Texture "plain" "spectrum" "imagemap" "string filename" "{0}"
      Texture "mean" "float" "imagemap" "string filename" "{0}" "float scale" 2
      Texture "inverse" "spectrum" "imagemap" "string filename" "{0}" "bool invert" true
        "string wrap" "black" "string encoding" "linear" "float uscale" -1 "float udelta" 1
      Material "diffuse" "texture reflectance" "plain")",
                                      pixels.path()));
  expect_near(built.albedo(1, 0.25F, 0.5F), {0.25F, 0.5F, 0.75F});
  expect_near(built.albedo(1, 1.75F, 0.5F), {1, 0, 0});
  EXPECT_NEAR(built.float_texture("mean", 0.25F, 0.5F), 1, 1e-6F);
  expect_near(built.spectrum_texture("inverse", 0.25F, 0.5F), {0, 1, 1});
  expect_near(built.spectrum_texture("inverse", 9, 0.5F), {1, 1, 1});
  EXPECT_TRUE(built.warnings().empty());
}

TEST(BuildTextures, SayWhatIsWrongWithImages) {
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "imagemap" "string filename" "none.png")"),
            "scene.pbrt:2:32: there is no file 'none.png' (looked for 'none.png')");
  EXPECT_EQ(texture_error(R"(Texture "t" "float" "imagemap")"),
            "scene.pbrt:2:1: 'filename' is missing: the file to read");
  const TwoPixels pixels;
  const auto error_with = [&](const std::string& parameter) {
    return texture_error(fmt::format(R"(Texture "t" "float" "imagemap" {} "string filename" "{}")",
                                     parameter, pixels.path()));
  };
  EXPECT_EQ(error_with(R"("string wrap" "mirror")"),
            "scene.pbrt:2:32: the wrap \"mirror\" is not known; use \"repeat\", \"black\" or "
            "\"clamp\"");
  EXPECT_EQ(error_with(R"("string encoding" "log")"),
            "scene.pbrt:2:32: the encoding \"log\" is not known; use \"sRGB\", \"linear\" or "
            "\"gamma 2.2\"");
  const ParsedScene built(fmt::format(R"(WorldBegin
Texture "t" "float" "imagemap" "string filter" "EWA" "float maxanisotropy" 16
        "string filename" "{}")",
                                      pixels.path()));
  ASSERT_EQ(built.warnings().size(), 1U);
  EXPECT_EQ(built.warnings()[0],
            "scene.pbrt:2:32: the filter 'EWA' is not supported; images are looked up bilinearly");
}

}  // namespace
}  // namespace freepath::testing
