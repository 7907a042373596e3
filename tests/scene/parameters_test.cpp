// Parameters: every type, alone and in arrays, and what is said of those that nobody asked for.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {
namespace {

/// The parameters of a shape.
ParameterList parameters_of(const std::string& text,
                            const std::map<std::string, std::string>& files = {}) {
  return parse(R"(WorldBegin Texture "marble" "spectrum" "marble" Shape "thing" )" + text, files)
      .shapes.at(0)
      .parameters;
}

template <class Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Parameters, AreReadWithOneValue) {
  const ParameterList list = parameters_of(R"(
      "integer i" -3  "float f" 2.5  "point3 p3" [1 2 3]  "vector3 v3" [4 5 6]
      "bool yes" true  "bool no" [false]  "bool old" "true"
      "string s" "text"  "texture t" ["marble"])");
  EXPECT_EQ(list.get_integer("i", 0), -3);
  EXPECT_EQ(list.get_float("f", 0), 2.5);
  EXPECT_EQ(list.get_point("p3", Vec3d(0)), Vec3d(1, 2, 3));
  EXPECT_EQ(list.get_vector("v3", Vec3d(0)), Vec3d(4, 5, 6));
  EXPECT_TRUE(list.get_bool("yes", false));
  EXPECT_FALSE(list.get_bool("no", true));
  EXPECT_TRUE(list.get_bool("old", false));
  EXPECT_EQ(list.get_string("s", ""), "text");
  EXPECT_EQ(list.get_texture("t"), "marble");
}

TEST(Parameters, AreReadWithManyValues) {
  const ParameterList list = parameters_of(R"(
      "integer i" [1 2 3]  "float f" [1 2.5]  "point2 p2" [1 2 3 4]  "point P" [1 2 3 4 5 6]
      "normal N" [0 0 1 0 1 0]  "string s" ["a" "b"])");
  EXPECT_EQ(list.get_integers("i").size(), 3U);
  EXPECT_EQ(list.get_floats("f")[1], 2.5);
  EXPECT_EQ(list.get_point2s("p2"), (std::vector<Vec2d>{{1, 2}, {3, 4}}));
  EXPECT_EQ(list.get_points("P"), (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(list.get_normals("N"), (std::vector<Vec3d>{{0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(list.get_strings("s")[1], "b");
}

TEST(Parameters, HaveDefaults) {
  const ParameterList list = parameters_of("");
  EXPECT_EQ(list.get_integer("i", 4), 4);
  EXPECT_EQ(list.get_float("f", 0.5), 0.5);
  EXPECT_EQ(list.get_point("p", Vec3d(1, 2, 3)), Vec3d(1, 2, 3));
  EXPECT_TRUE(list.get_bool("b", true));
  EXPECT_EQ(list.get_string("s", "x"), "x");
  EXPECT_EQ(list.get_texture("t"), "");
  EXPECT_TRUE(list.get_integers("i").empty());
  EXPECT_TRUE(list.get_points("p").empty());
  EXPECT_TRUE(list.get_spectra("L").empty());
  EXPECT_FALSE(list.type_of("i").has_value());
  EXPECT_EQ(std::get<BlackbodyValue>(list.get_spectrum("L", BlackbodyValue{5})).temperature, 5);
}

TEST(Parameters, GiveSpectraInFourWays) {
  const ParameterList list = parameters_of(R"(
      "rgb a" [0.1 0.2 0.3]  "blackbody b" 6500  "spectrum c" "metal-Au-eta"
      "spectrum d" [300 1 900 2]  "spectrum e" "lamp.spd"
      "rgb many" [1 2 3 4 5 6]  "spectrum sensor" ["nikon_d850_r" "stdillum-F12"])",
                                           {{"lamp.spd", "# nm value\n400 0.5\n700 1.5\n"}});
  const SpectrumValue none = RgbValue{};
  const auto rgb = std::get<RgbValue>(list.get_spectrum("a", none));
  EXPECT_EQ(rgb.b, 0.3);
  EXPECT_EQ(rgb.color_space, ColorSpace::kSrgb);
  EXPECT_EQ(std::get<BlackbodyValue>(list.get_spectrum("b", none)).temperature, 6500);
  EXPECT_EQ(std::get<NamedSpectrum>(list.get_spectrum("c", none)).name, "metal-Au-eta");
  using Samples = std::shared_ptr<const SpectrumSamples>;
  const auto inline_samples = std::get<Samples>(list.get_spectrum("d", none));
  EXPECT_EQ(inline_samples->wavelengths, (std::vector<double>{300, 900}));
  EXPECT_EQ(inline_samples->values, (std::vector<double>{1, 2}));
  const auto file_samples = std::get<Samples>(list.get_spectrum("e", none));
  EXPECT_EQ(file_samples->wavelengths, (std::vector<double>{400, 700}));
  EXPECT_EQ(file_samples->values, (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(list.get_spectra("many").size(), 2U);
  EXPECT_EQ(std::get<RgbValue>(list.get_spectra("many")[1]).g, 5);
  EXPECT_EQ(list.get_spectra("sensor").size(), 2U);
}

TEST(Parameters, OfAnotherTypeOrCountAreRefusedWithTheirPlace) {
  const ParameterList list = parameters_of("\n \"float fov\" [30 40] \"rgb L\" [1 2 3 4 5 6]");
  EXPECT_EQ(complaint([&] { list.get_integer("fov", 1); }),
            "scene.pbrt:2:2: parameter 'fov' must be of type integer, not float");
  EXPECT_EQ(complaint([&] { list.get_float("fov", 1); }),
            "scene.pbrt:2:2: parameter 'fov' must be one float, has 2 values");
  EXPECT_EQ(
      complaint([&] { list.get_spectrum("fov", RgbValue{}); }),
      "scene.pbrt:2:2: parameter 'fov' must be of type rgb, spectrum or blackbody, not float");
  EXPECT_EQ(complaint([&] { list.get_spectrum("L", RgbValue{}); }),
            "scene.pbrt:2:22: parameter 'L' must be one rgb, has 2 values");
  EXPECT_EQ(list.type_of("L"), ParameterType::kRgb);
  EXPECT_EQ(to_string(list.location_of("L")), "scene.pbrt:2:22");
  EXPECT_EQ(to_string(list.location_of("M")), to_string(list.location()));
}

TEST(Parameters, ThatNobodyAskedForAreNamedOnce) {
  const PbrtScene scene = parse(
      "WorldBegin\n"
      "Shape \"sphere\" \"float raduis\" 1 \"float radius\" 2\n"
      "Shape \"sphere\" \"float raduis\" 1 \"integer colour\" 3\n");
  Diagnostics diagnostics;
  for (const PbrtShape& shape : scene.shapes) {
    shape.parameters.get_float("radius", 1);
    shape.parameters.report_unused(diagnostics);
  }
  const std::vector<std::string> expected = {
      "scene.pbrt:2:16: Shape 'sphere' has no parameter 'raduis'; did you mean 'radius'? "
      "(and 1 more like this)",
      "scene.pbrt:3:33: Shape 'sphere' has no parameter 'colour'"};
  EXPECT_EQ(diagnostics.warnings(), expected);
  EXPECT_EQ(complaint([&] {
              scene.shapes[0].parameters.report_unused(diagnostics, UnusedPolicy::kError);
            }),
            "scene.pbrt:2:16: Shape 'sphere' has no parameter 'raduis'; did you mean 'radius'?");
}

TEST(Parameters, FromAttributesAreDefaultsThatNeedNotBeUsed) {
  const PbrtScene scene = parse(R"(
      WorldBegin
      Attribute "shape" "float radius" 2 "bool smooth" true
      AttributeBegin
        Attribute "shape" "float radius" 3
        Shape "sphere"
        Shape "sphere" "float radius" 4
      AttributeEnd
      Shape "sphere"
      LightSource "point")");
  Diagnostics diagnostics;
  std::vector<double> radii;
  for (const PbrtShape& shape : scene.shapes) {
    radii.push_back(shape.parameters.get_float("radius", 1));
    shape.parameters.report_unused(diagnostics);
  }
  EXPECT_EQ(radii, (std::vector<double>{3, 4, 2}));
  EXPECT_TRUE(diagnostics.warnings().empty());
  EXPECT_FALSE(scene.lights.at(0).parameters.type_of("radius"));
}

TEST(Parameters, OfEachTargetComeFromItsAttribute) {
  const PbrtScene scene = parse(R"(
      Attribute "medium" "float a" 1
      WorldBegin
      Attribute "light" "float b" 2
      Attribute "material" "float c" 3
      Attribute "texture" "float d" 4
      MakeNamedMedium "m" "string type" "homogeneous"
      LightSource "point"
      AreaLightSource "diffuse"
      Material "diffuse"
      MakeNamedMaterial "n" "string type" "diffuse"
      Texture "t" "float" "constant")");
  EXPECT_EQ(scene.media.at(0).parameters.get_float("a", 0), 1);
  EXPECT_EQ(scene.lights.at(0).parameters.get_float("b", 0), 2);
  EXPECT_EQ(scene.area_lights.at(0).parameters.get_float("b", 0), 2);
  EXPECT_EQ(scene.materials.at(1).parameters.get_float("c", 0), 3);
  EXPECT_EQ(scene.materials.at(2).parameters.get_float("c", 0), 3);
  EXPECT_EQ(scene.textures.at(0).parameters.get_float("d", 0), 4);
}

TEST(Parameters, OfOptionsTakeTheirTypeFromTheValue) {
  const PbrtScene scene = parse(R"(
      Option "seed" 7  Option "disablepixeljitter" true  Option "rendercoordsys" "world"
      Option "displacementedgescale" 1.5  Option "integer typed" [3]
      WorldBegin)");
  EXPECT_EQ(scene.options.get_integer("seed", 0), 7);
  EXPECT_TRUE(scene.options.get_bool("disablepixeljitter", false));
  EXPECT_EQ(scene.options.get_string("rendercoordsys", ""), "world");
  EXPECT_EQ(scene.options.get_float("displacementedgescale", 0), 1.5);
  EXPECT_EQ(scene.options.get_integer("typed", 0), 3);
}

}  // namespace
}  // namespace freepath::testing
