// Directives and what they leave in the description of the scene.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {
namespace {

TEST(SceneParser, ReadsWhatStandsBeforeTheWorld) {
  const PbrtScene scene = parse(R"(
      Film "rgb" "integer xresolution" 640
      Sampler "zsobol"
      PixelFilter "box" "float xradius" 0.5
      Integrator "volpath" "integer maxdepth" 10
      Accelerator "bvh"
      ColorSpace "rec2020"
      MediumInterface "" "haze"
      MakeNamedMedium "haze" "string type" "homogeneous" "rgb sigma_s" [1 1 1]
      Camera "perspective" "float fov" 30
      WorldBegin)");
  EXPECT_EQ(scene.file, "scene.pbrt");
  EXPECT_EQ(scene.film->type, "rgb");
  EXPECT_EQ(scene.film->parameters.get_integer("xresolution", 0), 640);
  EXPECT_EQ(to_string(scene.film->location), "scene.pbrt:2:7");
  EXPECT_EQ(scene.sampler->type, "zsobol");
  EXPECT_EQ(scene.filter->parameters.get_float("xradius", 0), 0.5);
  EXPECT_EQ(scene.integrator->parameters.get_integer("maxdepth", 0), 10);
  EXPECT_EQ(scene.accelerator->type, "bvh");
  EXPECT_EQ(scene.color_space, ColorSpace::kRec2020);
  EXPECT_EQ(scene.camera->type, "perspective");
  EXPECT_EQ(scene.camera->medium, "haze");
  const auto sigma_s = scene.media.at(0).parameters.get_spectrum("sigma_s", BlackbodyValue{});
  EXPECT_EQ(std::get<RgbValue>(sigma_s).color_space, ColorSpace::kRec2020);
}

TEST(SceneParser, NeedsNothingButAWorld) {
  const PbrtScene scene = parse("WorldBegin");
  EXPECT_FALSE(scene.camera || scene.film || scene.sampler || scene.filter || scene.integrator);
  EXPECT_EQ(scene.end_time, 1);
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].type, "diffuse");
}

TEST(SceneParser, GivesShapesTheirAttributes) {
  const PbrtScene scene = parse(R"(
      WorldBegin
      Shape "disk"
      Material "conductor"
      MediumInterface "smoke" ""
      AreaLightSource "diffuse" "float scale" 2
      ReverseOrientation
      Shape "sphere"
      ReverseOrientation
      MediumInterface "smoke"
      NamedMaterial "glass"
      Shape "cylinder"
      MakeNamedMaterial "glass" "string type" "dielectric"
      MakeNamedMedium "smoke" "string type" "uniformgrid")");
  ASSERT_EQ(scene.shapes.size(), 3U);
  const PbrtShape& plain = scene.shapes[0];
  EXPECT_EQ(plain.type, "disk");
  EXPECT_EQ(plain.material, 0);
  EXPECT_FALSE(plain.reverse_orientation || plain.area_light || plain.object);
  const PbrtShape& rich = scene.shapes[1];
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(rich.material)).type, "conductor");
  EXPECT_TRUE(rich.reverse_orientation);
  EXPECT_EQ(rich.area_light, 0);
  EXPECT_EQ(rich.inside_medium, "smoke");
  EXPECT_EQ(rich.outside_medium, "");
  const PbrtShape& named = scene.shapes[2];
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(named.material)).name, "glass");
  EXPECT_FALSE(named.reverse_orientation);
  // One name is for both sides.
  EXPECT_EQ(named.inside_medium, "smoke");
  EXPECT_EQ(named.outside_medium, "smoke");
}

TEST(SceneParser, RestoresAttributes) {
  const PbrtScene scene = parse(R"(
      WorldBegin
      MakeNamedMedium "fog" "string type" "homogeneous"
      Translate 1 0 0
      AttributeBegin
        Material "conductor"
        ReverseOrientation
        AreaLightSource "diffuse"
        MediumInterface "fog" "fog"
        ColorSpace "dci-p3"
        ActiveTransform EndTime
        Translate 0 1 0
        AttributeBegin Shape "sphere" AttributeEnd
      AttributeEnd
      Translate 0 0 1
      Shape "sphere" "rgb x" [1 1 1]
      LightSource "point")");
  const PbrtShape& inside = scene.shapes.at(0);
  EXPECT_TRUE(inside.world_from_object.is_animated());
  EXPECT_TRUE(inside.reverse_orientation && inside.area_light);
  EXPECT_EQ(inside.material, 1);
  const PbrtShape& after = scene.shapes.at(1);
  EXPECT_EQ(after.world_from_object.start, translation(Vec3d(1, 0, 1)));
  EXPECT_EQ(after.world_from_object.end, translation(Vec3d(1, 0, 1)));
  EXPECT_FALSE(after.reverse_orientation || after.area_light);
  EXPECT_EQ(after.material, 0);
  EXPECT_EQ(after.inside_medium, "");
  const auto rgb = after.parameters.get_spectrum("x", BlackbodyValue{});
  EXPECT_EQ(std::get<RgbValue>(rgb).color_space, ColorSpace::kSrgb);
  EXPECT_EQ(scene.lights.at(0).medium, "");
  EXPECT_EQ(scene.lights.at(0).world_from_light.start, translation(Vec3d(1, 0, 1)));
}

TEST(SceneParser, KnowsTransformScopesAndWarnsOnce) {
  Diagnostics diagnostics;
  const PbrtScene scene = parse(
      "WorldBegin\n TransformBegin Translate 1 2 3 TransformEnd\n"
      R"(TransformBegin TransformEnd Shape "sphere")",
      diagnostics);
  EXPECT_EQ(scene.shapes.at(0).world_from_object.start, Matrix4d());
  ASSERT_EQ(diagnostics.warnings().size(), 1U);
  EXPECT_EQ(diagnostics.warnings()[0].rfind("scene.pbrt:2:2: TransformBegin", 0), 0U);
}

TEST(SceneParser, WarnsOfWhatIsGivenTwice) {
  Diagnostics diagnostics;
  const PbrtScene scene = parse("Film \"rgb\"\nFilm \"spectral\"\nWorldBegin", diagnostics);
  EXPECT_EQ(scene.film->type, "spectral");
  const std::vector<std::string> expected = {
      "scene.pbrt:2:1: Film is given more than once; the last one counts"};
  EXPECT_EQ(diagnostics.warnings(), expected);
}

TEST(SceneParser, ReadsTexturesOfBothKinds) {
  const PbrtScene scene = parse(R"(
      WorldBegin
      Scale 2 2 2
      Texture "a" "float" "constant" "float value" 0.5
      Texture "a" "spectrum" "mix" "texture amount" "a" "texture tex1" "later"
      Texture "later" "spectrum" "imagemap" "string filename" "a.png"
      Material "diffuse" "texture reflectance" "a")");
  ASSERT_EQ(scene.textures.size(), 3U);
  EXPECT_EQ(scene.textures[0].kind, PbrtTextureKind::kFloat);
  EXPECT_EQ(scene.textures[1].kind, PbrtTextureKind::kSpectrum);
  EXPECT_EQ(scene.textures[2].type, "imagemap");
  EXPECT_EQ(scene.textures[2].name, "later");
  EXPECT_EQ(scene.textures[0].world_from_texture.start, scaling(Vec3d(2)));
}

TEST(SceneParser, KeepsObjectsApartFromTheirInstances) {
  const PbrtScene scene = parse(R"(
      WorldBegin
      ObjectInstance "tree"
      Translate 1 0 0
      ObjectBegin "tree"
        Translate 0 1 0
        Shape "sphere"
        AttributeBegin Shape "disk" AttributeEnd
      ObjectEnd
      Shape "cylinder"
      Translate 0 0 1
      ObjectInstance "tree")");
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "tree");
  EXPECT_EQ(scene.objects[0].shapes, (std::vector<int>{0, 1}));
  ASSERT_EQ(scene.shapes.size(), 3U);
  EXPECT_EQ(scene.shapes[1].object, 0);
  EXPECT_EQ(scene.shapes[0].world_from_object.start, translation(Vec3d(1, 1, 0)));
  EXPECT_FALSE(scene.shapes[2].object);
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].world_from_instance.start, Matrix4d());
  EXPECT_EQ(scene.instances[1].object, 0);
  EXPECT_EQ(scene.instances[1].world_from_instance.start, translation(Vec3d(1, 0, 1)));
}

TEST(SceneParser, GivesMediaNamesAndTransforms) {
  const PbrtScene scene = parse(R"(
      WorldBegin
      Translate 1 2 3
      MakeNamedMedium "cloud" "string type" "nanovdb" "string filename" "cloud.nvdb")");
  const PbrtMedium& medium = scene.media.at(0);
  EXPECT_EQ(medium.name, "cloud");
  EXPECT_EQ(medium.type, "nanovdb");
  EXPECT_EQ(medium.world_from_medium.start, translation(Vec3d(1, 2, 3)));
  // The type has been asked for, the rest has not.
  Diagnostics diagnostics;
  medium.parameters.report_unused(diagnostics);
  const std::vector<std::string> expected = {
      "scene.pbrt:4:55: medium 'cloud' has no parameter 'filename'"};
  EXPECT_EQ(diagnostics.warnings(), expected);
}

}  // namespace
}  // namespace freepath::testing
