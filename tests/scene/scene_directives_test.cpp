// Directives that say the same thing in two ways give the same picture, pixel for pixel.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "freepath/spectra/rgb_color_space.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

using Files = std::map<std::string, std::string>;

/// A picture by the seed and the samples of the scene itself, and what is said of the scene.
Picture picture_of_text(const std::string& text, ColorMode mode, const Files& files = {}) {
  Diagnostics diagnostics;
  const BuiltScene built = build_scene(parse(text, diagnostics, files), diagnostics);
  Picture picture = picture_of(
      built, {.mode = mode, .samples = built.picture.samples, .seed = built.picture.seed});
  picture.warnings = diagnostics.warnings();
  return picture;
}

/// What stands before a camera that looks along z from -4, and lights.
std::string stood_before(const std::string& world, const std::string& before = "") {
  return film(12) + "Sampler \"sobol\" \"integer pixelsamples\" 4\n" + before +
         "\nLookAt 0 0 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 45\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [ .3 .3 .3 ]\n"
         "LightSource \"distant\" \"rgb L\" [ 2 2 2 ] \"point3 from\" [ 1 2 -1 ] "
         "\"point3 to\" [ 0 0 0 ]\n" +
         world;
}

/// Something without any symmetry.
const std::string kThing = R"( Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1.2 0  0 0 .7 ] )"
                           "\"integer indices\" [ 0 2 1  0 1 3  0 3 2  1 2 3 ]\n";

/// Two texts and what they need.
struct Twins {
  const char* name;
  std::string one, other;
  std::size_t warnings = 0;  ///< Of the first.
};

double largest_difference(const Picture& a, const Picture& b) {
  double largest = a.image.values.size() == b.image.values.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < a.image.values.size() && largest < INFINITY; ++i) {
    largest = std::max<double>(largest, std::abs(a.image.values[i] - b.image.values[i]));
  }
  return largest;
}

/// The same but for rounding; and not the picture of an empty world.
void expect_same(const Twins& twins, const std::string& empty, const Files& files = {}) {
  for (const ColorMode mode : kColorModes) {
    const Picture one = picture_of_text(twins.one, mode, files);
    const Picture other = picture_of_text(twins.other, mode, files);
    EXPECT_EQ(one.warnings.size(), twins.warnings) << twins.name;
    EXPECT_TRUE(other.warnings.empty()) << twins.name << ": " << other.warnings.front();
    EXPECT_LT(largest_difference(one, other), 1e-4) << twins.name << " " << name_of(mode);
    EXPECT_GT(largest_difference(one, picture_of_text(empty, mode)), 0.1) << twins.name;
  }
}

void expect_same_worlds(const std::vector<Twins>& table, const Files& files = {}) {
  for (Twins twins : table) {
    twins.one = stood_before(twins.one);
    twins.other = stood_before(twins.other);
    expect_same(twins, stood_before(""), files);
  }
}

/// The sixteen numbers of a transform: the images of the axes and of the origin.
std::string matrix(const std::string& numbers) { return "Transform [ " + numbers + " ]"; }

TEST(SceneDirectives, Transforms) {
  const std::string turn = "0 1 0 0  -1 0 0 0  0 0 1 0  0 0 0 1";
  const std::string transform = "Translate .3 -.2 .4";
  const std::string placed = matrix("1 0 0 0  0 1 0 0  0 0 1 0  .3 -.2 .4 1");
  expect_same_worlds({
      {"Identity", "Translate 5 5 5 Identity" + kThing, kThing},
      {"Translate", transform + kThing, placed + kThing},
      {"Scale", "Scale .5 .7 -.9" + kThing,
       matrix(".5 0 0 0  0 .7 0 0  0 0 -.9 0  0 0 0 1") + kThing},
      {"Rotate", "Rotate 90 0 0 2" + kThing, matrix(turn) + kThing},
      // Right is up x ahead = z x -x = -y; the matrix takes the world to the view.
      {"LookAt", "LookAt .4 .2 0  0 .2 0  0 0 1" + kThing,
       matrix("0 0 -1 0  -1 0 0 0  0 1 0 0  .2 0 .4 1") + kThing},
      {"ConcatTransform", transform + " ConcatTransform [ " + turn + " ]" + kThing,
       transform + " Rotate 90 0 0 1" + kThing},
      {"CoordSysTransform",
       transform + R"( CoordinateSystem "here" Rotate 50 1 1 0 CoordSysTransform "here")" + kThing,
       placed + kThing},
      {"camera", "CoordSysTransform \"camera\" Translate .3 -.2 4.4" + kThing, placed + kThing},
      {"world", "Translate 9 9 9 CoordSysTransform \"world\"" + kThing, kThing},
      {"ActiveTransform",
       "ActiveTransform StartTime Translate .3 0 .4 ActiveTransform EndTime Translate .3 0 .4 "
       "ActiveTransform All Translate 0 -.2 0" +
           kThing,
       placed + kThing},
      {"motion",
       "ActiveTransform EndTime Translate 1 1 1 ActiveTransform All " + transform + kThing,
       placed + kThing, 1},
      {"ReverseOrientation", "ReverseOrientation ReverseOrientation" + kThing, kThing},
  });
}

TEST(SceneDirectives, Scopes) {
  const std::string change =
      "Translate 9 9 9 Material \"conductor\" ReverseOrientation "
      "AreaLightSource \"diffuse\" Attribute \"shape\" \"float radius\" .2\n";
  const std::string ball = kThing + " Translate -.6 0 0 Shape \"sphere\" \"float radius\" .4\n";
  expect_same_worlds(
      {
          {"AttributeBegin", "AttributeBegin " + change + " AttributeEnd" + kThing, kThing},
          {"TransformBegin", "TransformBegin " + change + " TransformEnd" + kThing, kThing, 1},
          {"objects",
           "ObjectBegin \"o\" Scale .7 .7 .7" + kThing +
               "ObjectEnd Translate .3 0 0 ObjectInstance \"o\" "
               "Translate -.9 -.5 0 ObjectInstance \"o\"\n",
           "Translate .3 0 0 AttributeBegin Scale .7 .7 .7" + kThing +
               "AttributeEnd Translate -.9 -.5 0 Scale .7 .7 .7" + kThing},
          {"Include", "Include \"place.pbrt\"" + ball, "Translate .4 -.3 0 Scale .8 .8 .8" + ball},
          {"Import", "Translate .2 0 0 Import \"ball.pbrt\"" + kThing,
           "Translate .2 0 0 AttributeBegin Scale .6 .6 .6 " + ball + "AttributeEnd" + kThing},
      },
      {{"place.pbrt", "Translate .4 -.3 0 Scale .8 .8 .8"},
       {"ball.pbrt", "Scale .6 .6 .6 " + ball}});
}

TEST(SceneDirectives, AttributesStandForParameters) {
  const std::string red = R"("rgb reflectance" [ .9 .2 .1 ])";
  const std::string fog = R"("rgb sigma_a" [ .2 .2 .2 ] "rgb sigma_s" [ 3 3 3 ])";
  const std::string boundary =
      "Material \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\"\n";
  const std::string textured = R"( Material "diffuse" "texture reflectance" "t")" + kThing;
  expect_same_worlds({
      {"shape", R"(Attribute "shape" "float radius" .6 Shape "sphere")",
       R"(Shape "sphere" "float radius" .6)"},
      {"material", "Attribute \"material\" " + red + " Material \"diffuse\"" + kThing,
       "Material \"diffuse\" " + red + kThing},
      {"light", R"(Attribute "light" "rgb I" [ 3 5 2 ] LightSource "point")" + kThing,
       R"(LightSource "point" "rgb I" [ 3 5 2 ])" + kThing},
      {"medium",
       "Attribute \"medium\" " + fog + R"( MakeNamedMedium "m" "string type" "homogeneous" )" +
           boundary,
       R"(MakeNamedMedium "m" "string type" "homogeneous" )" + fog + boundary},
      {"texture",
       R"(Attribute "texture" "rgb value" [ .1 .5 .9 ] Texture "t" "spectrum" "constant")" +
           textured,
       R"(Texture "t" "spectrum" "constant" "rgb value" [ .1 .5 .9 ])" + textured},
  });
}

TEST(SceneDirectives, NamesStandForWhatTheyName) {
  const std::string red = R"("rgb reflectance" [ .9 .2 .1 ])";
  expect_same_worlds({
      {"NamedMaterial",
       R"(MakeNamedMaterial "a" "string type" "diffuse" )" + red + " NamedMaterial \"a\"" + kThing,
       "Material \"diffuse\" " + red + kThing},
      {"Texture",
       R"(Texture "t" "spectrum" "constant" "rgb value" [ .9 .2 .1 ] )"
       R"(Material "diffuse" "texture reflectance" "t")" +
           kThing,
       "Material \"diffuse\" " + red + kThing},
  });
}

TEST(SceneDirectives, BeforeTheWorld) {
  const auto expect = [](const char* name, const std::string& one, const std::string& other,
                         std::size_t warnings = 0) {
    expect_same({name, stood_before(kThing, one), stood_before(kThing, other), warnings},
                stood_before(""));
  };
  const std::string glow =
      R"(MakeNamedMedium "m" "string type" "homogeneous" "rgb Le" [ 1 2 3 ] MediumInterface )";
  expect("Accelerator", "Accelerator \"kdtree\"", "");
  expect("TransformTimes", "TransformTimes .2 .7", "");
  expect("Integrator", R"(Integrator "path" "integer maxdepth" 3)",
         R"(Integrator "volpath" "integer maxdepth" 3)");
  expect("Sampler", R"(Sampler "sobol" "integer pixelsamples" 4 "integer seed" 9)",
         "Option \"integer seed\" 9", 1);
  expect("MediumInterface", glow + "\"m\"", glow + R"("" "m")");
}

// From inside of a sphere that shines and reflects half of what it receives, however often.
TEST(SceneDirectives, IntegratorsEndPathsAfterAsManyScatterings) {
  for (const char* const integrator : {"path", "volpath"}) {
    double expected = 0;
    for (int depth = 0; depth < 5; ++depth) {
      expected += std::pow(0.5, depth);
      const std::string scene =
          film(8) + fmt::format("Integrator \"{}\" \"integer maxdepth\" {}\n", integrator, depth) +
          R"(Camera "perspective" WorldBegin
          Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
          AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] ReverseOrientation Shape "sphere")";
      expect_mean(fmt::format("{} {}", integrator, depth), render_text(scene, {.samples = 256}),
                  {expected, expected, expected},
                  {.absolute = 1e-4, .largest_relative_error = 0.002});
    }
  }
}

// A light of the colour space that is valid where it stands, on a film of another: R, G, B of the
// film are those of the light by way of X, Y, Z.
TEST(SceneDirectives, ColorSpacesAreThoseWhereColoursStand) {
  const Vec3d colour(.5, .6, .4);
  const RgbColorSpace& srgb = rgb_color_space("srgb");
  for (const char* const name : {"srgb", "rec2020", "aces2065-1"}) {
    const RgbColorSpace& space = rgb_color_space(name);
    const std::string light = "LightSource \"infinite\" \"rgb L\" [ .5 .6 .4 ]\n";
    const Vec3d in_srgb = srgb.from_xyz(space.to_xyz(colour));
    const std::string set = fmt::format("ColorSpace \"{}\"\n", name);
    const std::string camera = "Camera \"perspective\" WorldBegin\n";
    for (const ColorMode mode : kColorModes) {
      const PictureOptions options{.mode = mode, .samples = 4096};
      const MeanTolerance tolerance{.absolute = 3e-4, .largest_relative_error = 0.002};
      expect_mean(fmt::format("{} of a light {}", name, name_of(mode)),
                  render_text(fmt::format("{}{}AttributeBegin {}{}AttributeEnd", film(2), camera,
                                          set, light),
                              options),
                  {in_srgb.x, in_srgb.y, in_srgb.z}, tolerance);
      expect_mean(fmt::format("{} of all {}", name, name_of(mode)),
                  render_text(fmt::format("{}{}{}{}", film(2), set, camera, light), options),
                  {colour.x, colour.y, colour.z}, tolerance);
    }
  }
}

// Within a sphere that reflects half: after two reflections a quarter is left, had the second been.
TEST(SceneDirectives, LimitOfScatteringsTellsWhatItCuts) {
  for (const ColorMode mode : kColorModes) {
    Diagnostics diagnostics;
    const BuiltScene built =
        build_scene(parse("Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(4) +
                              "Camera \"perspective\" WorldBegin Material \"diffuse\" "
                              "\"rgb reflectance\" [ .5 .5 .5 ] Shape \"sphere\"",
                          diagnostics),
                    diagnostics);
    const RenderResult result =
        render_scene(built.scene, mode, settings_of(built, {.mode = mode, .samples = 16}));
    EXPECT_EQ(result.counts.cut_paths, result.counts.paths);
    EXPECT_NEAR(result.counts.cut_share(), 0.25, 0.001);
  }
}

}  // namespace
}  // namespace freepath::testing
