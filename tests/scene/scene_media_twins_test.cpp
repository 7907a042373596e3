// Media that are told in two ways give the same picture.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "freepath/io/volume_write.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

const std::string kSigmas = R"("rgb sigma_a" [ .2 .2 .2 ] "rgb sigma_s" [ 2 2 2 ] "float g" 0.3 )";

std::string homogeneous(const std::string& name, const std::string& parameters = kSigmas) {
  return R"(MakeNamedMedium ")" + name + R"(" "string type" "homogeneous" )" + parameters + "\n";
}

TEST(SceneTwins, UniformGridOfOneValueIsHomogeneous) {
  std::string ones;
  for (int i = 0; i < 27; ++i) ones += "1 ";
  // The box ends at the centres of the outer voxels, beyond which a grid fades.
  const std::string box = medium_box("m", Vec3d(-1), Vec3d(1));
  expect_twins("grid",
               stage(R"(MakeNamedMedium "m" "string type" "uniformgrid" )" + kSigmas +
                     R"("integer nx" 3 "integer ny" 3 "integer nz" 3 )"
                     R"("point3 p0" [ -1.5 -1.5 -1.5 ] "point3 p1" [ 1.5 1.5 1.5 ] )"
                     R"("float density" [ )" +
                     ones + "]\n" + box),
               stage(homogeneous("m") + box));
}

/// Voxels of a box of 6 x 5 x 7 cubes of side 0.4 around the origin, of which the outer ones are
/// empty.
const Vec3i kTwinCounts(6, 5, 7);
const Vec3d kTwinLow(-1.2, -1, -1.4);
constexpr double kTwinEdge = 0.4;

float lump(const Vec3i& voxel) {
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] == 0 || voxel[axis] == kTwinCounts[axis] - 1) return 0;
  }
  return static_cast<float>((voxel.x * 5 + voxel.y * 3 + voxel.z * 7) % 4);
}

template <class Visit>
void for_each_voxel(const Visit& visit) {
  for (int z = 0; z < kTwinCounts.z; ++z) {
    for (int y = 0; y < kTwinCounts.y; ++y) {
      for (int x = 0; x < kTwinCounts.x; ++x) visit(Vec3i(x, y, z));
    }
  }
}

std::string lumpy_grid() {
  std::string values;
  for_each_voxel([&](const Vec3i& voxel) { values += std::to_string(lump(voxel)) + " "; });
  return R"(MakeNamedMedium "m" "string type" "uniformgrid" )" + kSigmas +
         R"("integer nx" 6 "integer ny" 5 "integer nz" 7 "point3 p0" [ -1.2 -1 -1.4 ] )"
         R"("point3 p1" [ 1.2 1 1.4 ] "float density" [ )" +
         values + "]\n";
}

/// Around all voxels, so that the boundary need not be traced.
const std::string kFarBox = medium_box("m", Vec3d(-1.5, -1.5, -1.7), Vec3d(1.5, 1.5, 1.7));

TEST(SceneTwins, UniformGridIsTheVolumeOfAFile) {
  BrickMapBuilder builder(Vec3i(0), kTwinCounts - Vec3i(1), 0);
  for_each_voxel([&](const Vec3i& voxel) { builder.set_voxel(voxel, lump(voxel)); });
  Field field{"density", std::move(builder).finish(), Matrix4d()};
  field.index_to_world.setScale(Vec3d(kTwinEdge));
  for (int axis = 0; axis < 3; ++axis) {
    field.index_to_world[3][axis] = kTwinLow[axis] + 0.5 * kTwinEdge;
  }
  const TemporaryFile file("lumps.vdb");
  const Field* const fields[] = {&field};
  write_vdb(file.path(), fields);
  expect_twins("file", stage(lumpy_grid() + kFarBox),
               stage(R"(MakeNamedMedium "m" "string type" "openvdb" )" + kSigmas +
                     R"("string filename" ")" + file.path().string() + "\"\n" + kFarBox));
}

// Where the boundary passes through voxels it stays, even if these are empty.
TEST(SceneTwins, BoundaryThatNeedNotBeTracedIsAsOneThatIs) {
  const std::string tight = medium_box("m", kTwinLow + Vec3d(0.05), -kTwinLow - Vec3d(0.05));
  const std::string sphere =
      R"(AttributeBegin Translate 0.2 0.9 -2.1 Material "diffuse" Shape "sphere" "float )"
      "radius\" 0.3 AttributeEnd\n";
  const std::string a = stage(lumpy_grid() + kFarBox + sphere);
  const std::string b = stage(lumpy_grid() + tight + sphere);
  Diagnostics diagnostics;
  const BuiltScene without = build_scene(parse(a, diagnostics), diagnostics);
  const BuiltScene with = build_scene(parse(b, diagnostics), diagnostics);
  ASSERT_TRUE(without.scene.is_clear[0]);
  ASSERT_FALSE(with.scene.is_clear[0]);
  expect_twins("boundary", a, b);
}

/// The boundary of fog between the corners of a box, of one shape for each list of corners.
/// @param turn statements before them
std::string fog_boundary(const std::vector<std::string>& triangles, const std::string& turn = "") {
  std::string text = homogeneous("m") +
                     "AttributeBegin\nTranslate 0 .2 0 Rotate 25 1 .3 .2 Scale .8 1 .7 "
                     "Material \"interface\" MediumInterface \"m\" \"\"\n" +
                     turn;
  for (const std::string& indices : triangles) {
    text += R"(Shape "trianglemesh" "point3 P" [ -1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 )"
            R"(-1 -1 1 1 -1 1 -1 1 1 1 1 1 ] "integer indices" [ )" +
            indices + "]\n";
  }
  return text + "AttributeEnd\n";
}
const std::string kEightTriangles = "0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 ";
const std::string kFourTriangles = "0 4 2 2 4 6 1 3 5 3 7 5 ";
/// The same with their corners the other way round.
const std::string kEightTurned = "0 1 2 1 3 2 4 6 5 5 6 7 0 4 1 1 4 5 2 3 6 3 7 6 ";
const std::string kFourTurned = "0 2 4 2 6 4 1 5 3 3 5 7 ";

bool needs_no_boundary(const std::string& world) {
  Diagnostics diagnostics;
  const BuiltScene built = build_scene(parse(stage(world), diagnostics), diagnostics);
  return built.scene.is_clear[0];
}

// Media of grids end at the faces of their voxels, where most scenes have their boundary.
TEST(SceneTwins, BoundaryOnTheFacesOfVoxelsNeedNotBeTraced) {
  const std::string colors =
      R"(MakeNamedMedium "m" "string type" "rgbgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1 )"
      R"("point3 p0" [ -1.2 -1 -1.4 ] "point3 p1" [ 1.2 1 1.4 ] )"
      R"("rgb sigma_s" [ .5 .3 .2 .3 .4 .6 ] "rgb sigma_a" [ .1 .2 .3 .1 .2 .3 ])"
      "\n";
  for (const std::string& grid : {lumpy_grid(), colors}) {
    for (const char* const turn : {"", "Rotate 90 0 0 1 Translate .1 .2 .3 Scale .7 .8 .9\n",
                                   "Translate .1 .2 .3 Rotate 25 1 .3 .2 Scale .7 .8 .9\n",
                                   "Rotate 25 1 .3 .2 Scale .6 .8 .7 Rotate 40 0 1 .5\n"}) {
      const std::string on = turn + grid + medium_box("m", kTwinLow, -kTwinLow);
      const std::string within =
          turn + grid + medium_box("m", kTwinLow * (1 - 1e-5), -kTwinLow * (1 - 1e-5));
      EXPECT_TRUE(needs_no_boundary(on)) << turn;
      EXPECT_FALSE(needs_no_boundary(within)) << turn;
      expect_twins("faces", stage(on), stage(within));
    }
  }
}

// A boundary that is a box need not be traced, since the fog ends there by itself.
TEST(SceneTwins, FogFillsABoxAsWithinABoundary) {
  const std::string one = fog_boundary({kEightTriangles + kFourTriangles});
  const std::string two = fog_boundary({kEightTriangles, kFourTriangles});
  EXPECT_TRUE(needs_no_boundary(one));
  EXPECT_FALSE(needs_no_boundary(two));
  expect_twins("box", stage(one), stage(two));
}

TEST(SceneTwins, FogFillsNothingButABox) {
  const std::string six = "0 4 2 2 4 6 1 3 5 ";  // and one of the four
  for (const std::string& triangles :
       {kEightTriangles + six + "3 7 1 ", kEightTriangles + six, kEightTriangles + six + "1 3 5 ",
        kEightTriangles + six + "3 5 5 ", kEightTriangles + six + "0 7 5 "}) {
    EXPECT_FALSE(needs_no_boundary(fog_boundary({triangles}))) << triangles;
  }
  // Nor a box that has its outside within, wholly or in part: the fog is around it then.
  for (const std::string& box :
       {fog_boundary({kEightTurned + kFourTurned}),
        fog_boundary({kEightTriangles + kFourTriangles}, "ReverseOrientation\n"),
        fog_boundary({kEightTriangles + "0 2 4 2 4 6 1 3 5 3 7 5 "})}) {
    EXPECT_FALSE(needs_no_boundary(box)) << box;
  }
  for (const std::string& box :
       {fog_boundary({kEightTurned + kFourTurned}, "ReverseOrientation\n"),
        fog_boundary({kEightTriangles + kFourTriangles}, "Scale -1 1 1\n")}) {
    EXPECT_TRUE(needs_no_boundary(box)) << box;
  }
  expect_twins("inverse", stage(fog_boundary({kEightTurned + kFourTurned})),
               stage(fog_boundary({kEightTurned, kFourTurned})));
  // Nor a box with something in it.
  const std::string ball =
      R"(AttributeBegin Material "diffuse" Shape "sphere" "float radius" 0.3 AttributeEnd)";
  EXPECT_FALSE(needs_no_boundary(fog_boundary({kEightTriangles + kFourTriangles}) + ball));
}

// Voxels that lie outside of a medium are not seen, though nothing but them may be near.
TEST(SceneTwins, BoundaryThatIsTurnedInsideOutKeepsVoxelsOut) {
  const std::string turned = "AttributeBegin\nReverseOrientation\n" + kFarBox + "AttributeEnd\n";
  EXPECT_FALSE(needs_no_boundary(lumpy_grid() + turned));
  EXPECT_TRUE(needs_no_boundary(lumpy_grid() + kFarBox));
}

/// A bubble around the camera, too small to be seen.
TEST(SceneTwins, CameraInAMediumIsAsInABubbleOfIt) {
  const std::string camera =
      "LookAt 0.2 0.1 -0.5  0 0 1  0 1 0\n{}Camera \"perspective\" \"float fov\" 70\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [ .3 .3 .3 ]\n"
      "LightSource \"point\" \"rgb I\" [ 2 2 2 ] \"point3 from\" [ -2 1 2 ]\n";
  const std::string fog = homogeneous("m") + medium_box("m", Vec3d(-1), Vec3d(1));
  expect_twins("bubble",
               kUnlimited + film() + homogeneous("m") +
                   fmt::format(fmt::runtime(camera), "MediumInterface \"\" \"m\"\n") +
                   medium_box("m", Vec3d(-1), Vec3d(1)),
               kUnlimited + film() + fmt::format(fmt::runtime(camera), "") + fog +
                   R"(AttributeBegin Translate 0.2 0.1 -0.5 Material "interface" )"
                   R"(MediumInterface "" "m" Shape "sphere" "float radius" 1e-4 )"
                   "AttributeEnd\n",
               256, {.absolute = 3e-4, .largest_relative_error = 0.01});
}

TEST(SceneTwins, MediumWithinTheSameMediumIsNotSeen) {
  const std::string outer = homogeneous("m") + medium_box("m", Vec3d(-1), Vec3d(1));
  expect_twins("nested", stage(outer),
               stage(outer + homogeneous("n") +
                     medium_box("n", Vec3d(-0.8, -0.3, -0.9), Vec3d(0.4, 0.9, 0.5), "m")));
}

// What is within a medium replaces it.
TEST(SceneTwins, NestedMediaAbsorbAsTheirLengths) {
  const std::string scene =
      film() +
      "LookAt 0 0 -9  0 0 0  0 1 0\n"
      "Camera \"orthographic\" \"float screenwindow\" [ -.01 .01 -.01 .01 ]\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n" +
      homogeneous("a", R"("rgb sigma_a" [ .3 .3 .3 ] "rgb sigma_s" [ 0 0 0 ])") +
      homogeneous("b", R"("rgb sigma_a" [ .9 .9 .9 ] "rgb sigma_s" [ 0 0 0 ])") +
      medium_box("a", Vec3d(-1), Vec3d(1)) + medium_box("b", Vec3d(-0.5), Vec3d(0.5), "a") +
      medium_box("", Vec3d(-0.3), Vec3d(0.1), "b");
  const double expected = std::exp(-(0.3 * 1 + 0.9 * 0.6));
  expect_mean("nested", render_text(scene, {.samples = 1024}), {expected, expected, expected});
}

/// Everything that has no colour.
TEST(SceneTwins, GreySceneIsTheSameInWavelengths) {
  const std::string scene =
      stage(lumpy_grid() + kFarBox +
            R"(AttributeBegin Translate 1 -0.8 -1.6 Material "dielectric" Shape "sphere" )"
            "\"float radius\" 0.3 AttributeEnd\n"
            R"(AttributeBegin Translate -1.2 0.6 -1.6 Material "conductor" "rgb reflectance" )"
            R"([ .8 .8 .8 ] "float roughness" 0.2 Shape "sphere" "float radius" 0.3 )"
            "AttributeEnd\n");
  expect_alike("modes", render_text(scene, {.samples = 1024}),
               render_text(scene, {.mode = ColorMode::kSpectral, .samples = 1024, .seed = 3}));
}

class SceneTrackers : public ::testing::TestWithParam<const char*> {};

// One medium whose extinction has a colour, seen through another that is grey.
std::string coloured_scene(const std::string& methods) {
  return stage(homogeneous("m", R"("rgb sigma_a" [ .1 .3 .5 ] "rgb sigma_s" [ 1 .6 .4 ])") +
                   medium_box("m", Vec3d(-0.2, -1, -1), Vec3d(1)) + homogeneous("n") +
                   medium_box("n", Vec3d(-1), Vec3d(-0.4, 1, 1)),
               R"(Integrator "volpath" "integer maxdepth" 8 )" + methods + "\n");
}

TEST_P(SceneTrackers, AgreeWithOnePathForEachChannel) {
  static const std::vector<Picture> kReferences = [] {
    std::vector<Picture> pictures;
    for (const ColorMode mode : kColorModes) {
      pictures.push_back(render_text(coloured_scene(R"("string tracker" "delta")"),
                                     {.mode = mode, .samples = 256}));
    }
    return pictures;
  }();
  for (std::size_t i = 0; i < kReferences.size(); ++i) {
    const Picture picture = render_text(coloured_scene(GetParam()),
                                        {.mode = kColorModes[i], .samples = 128, .seed = 77});
    expect_alike(name_of(kColorModes[i]), picture, kReferences[i],
                 {.absolute = 2e-5, .largest_relative_error = 0.01});
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, SceneTrackers,
    ::testing::Values(R"("string tracker" "spectral")", R"("string tracker" "weighted-delta")",
                      R"("string tracker" "weighted-delta:energy-partitioning=yes")",
                      R"("string tracker" "per-wavelength")",
                      R"("string tracker" "hero-wavelength")",
                      R"("string tracker" "spectral-decomposition")",
                      R"("string tracker" "spectral" "string transmittance" "next-flight")"));

// A path that has met red and then green has no weight left, and trackers that go by weights
// nothing to go by.
TEST(SceneTwins, PaintsWithoutACommonColourLeaveNothing) {
  const auto corner = [](const char* tracker) {
    const std::string walls =
        R"(AttributeBegin Material "diffuse" "rgb reflectance" [ 1 0 0 ] Translate 0 -1.6 0 )"
        R"(Shape "sphere" "float radius" 1 AttributeEnd )"
        R"(AttributeBegin Material "diffuse" "rgb reflectance" [ 0 1 0 ] Translate 1.2 0.5 0 )"
        R"(Shape "sphere" "float radius" 1 AttributeEnd )";
    return stage(homogeneous("m", R"("rgb sigma_a" [ .1 .2 .3 ] "rgb sigma_s" [ .3 .2 .5 ])") +
                     R"(AttributeBegin Material "interface" MediumInterface "m" "" )"
                     R"(Shape "sphere" "float radius" 4 AttributeEnd MediumInterface "m" "m" )" +
                     walls,
                 std::string(R"(Integrator "volpath" "integer maxdepth" 8 "string tracker" ")") +
                     tracker + "\"\n");
  };
  expect_twins("paints", corner("delta"), corner("spectral-decomposition"));
}

}  // namespace
}  // namespace freepath::testing
