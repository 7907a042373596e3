// Scenes of several files, packed files, and the scenes that renderers are compared on.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/gzip.h"
#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {
namespace {

TEST(SceneFiles, IncludeTakesPartInTheState) {
  const PbrtScene scene = parse(
      R"(Include "view.pbrt" WorldBegin AttributeBegin Include "a.pbrt" )"
      R"(Shape "sphere" AttributeEnd Shape "sphere")",
      {{"view.pbrt", R"(Translate 0 0 1 Camera "perspective")"}, {"a.pbrt", "Translate 1 0 0"}});
  EXPECT_EQ(scene.camera->camera_from_world.start, translation(Vec3d(0, 0, 1)));
  EXPECT_EQ(to_string(scene.camera->location), "view.pbrt:1:17");
  EXPECT_EQ(scene.shapes.at(0).world_from_object.start, translation(Vec3d(1, 0, 0)));
  EXPECT_EQ(scene.shapes.at(1).world_from_object.start, Matrix4d());
}

/// What an included file holds is text in the place of its Include: a statement that begins there
/// goes on after it, whatever it is cut into.
TEST(SceneFiles, IncludeIsTextual) {
  const auto medium = [](const PbrtScene& scene) {
    const ParameterList& list = scene.media.at(0).parameters;
    EXPECT_EQ(list.get_integer("nx", 0), 2);
    EXPECT_EQ(
        std::vector<double>(list.get_floats("density").begin(), list.get_floats("density").end()),
        (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(list.get_float("scale", 0), 3);
    EXPECT_EQ(scene.shapes.at(0).world_from_object.start, translation(Vec3d(1, 2, 3)));
    EXPECT_EQ(scene.shapes.at(0).type, "sphere");
    EXPECT_EQ(scene.shapes.at(0).parameters.get_float("radius", 0), 2);
  };
  const std::string whole =
      R"(WorldBegin MakeNamedMedium "puff" "string type" "uniformgrid" "integer nx" 2 )"
      R"("float density" [ 1 2 3 4 ] "float scale" 3 Translate 1 2 3 Shape "sphere" )"
      R"("float radius" 2)";
  medium(parse(whole));
  // Cut before every word, and the rest goes on after the Include. Names of files are strings, so
  // that one may not be cut where a parameter list could take the Include's.
  int cuts = 0;
  for (std::size_t cut = whole.find(' '); cut != std::string::npos;
       cut = whole.find(' ', cut + 1)) {
    if (std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut), '"') % 2 != 0) {
      continue;  // within a string
    }
    SCOPED_TRACE(whole.substr(cut));
    medium(parse("Include \"first.pbrt\"" + whole.substr(cut),
                 {{"first.pbrt", whole.substr(0, cut)}}));
    // The same through files within files, each of which ends where the next one goes on.
    medium(parse("Include \"outer.pbrt\"" + whole.substr(cut),
                 {{"outer.pbrt", "Include \"first.pbrt\""}, {"first.pbrt", whole.substr(0, cut)}}));
    ++cuts;
  }
  EXPECT_GT(cuts, 20);
}

TEST(SceneFiles, ErrorsOfAStatementInTwoFilesNameTheFileOfTheWord) {
  const std::map<std::string, std::string> files = {
      {"a.pbrt", "\nShape \"sphere\"\n \"float radius\" [ 1"},
      {"b.pbrt", "\nTranslate 1 2"},
      {"c.pbrt", "Shape \"sphere\" \"float radius\" 1"}};
  EXPECT_EQ(error_of("WorldBegin Include \"a.pbrt\"\n x ]", files),
            "scene.pbrt:2:2: parameter 'radius' of type float expects a number, found 'x'");
  EXPECT_EQ(error_of("WorldBegin Include \"a.pbrt\"\n", files),
            "a.pbrt:3:17: this bracket is never closed");
  EXPECT_EQ(error_of("WorldBegin Include \"b.pbrt\"\nShape \"disk\"", files),
            "scene.pbrt:2:1: expected number 3 of the 3 of Translate, found 'Shape'");
  EXPECT_EQ(error_of("WorldBegin Include \"c.pbrt\"\n\"float radius\" 2", files),
            "scene.pbrt:2:1: parameter 'radius' is given twice, first in line 1");
}

// pbrt parses an imported file by itself.
TEST(SceneFiles, StatementsDoNotGoOnAfterAnImport) {
  const std::map<std::string, std::string> files = {
      {"a.pbrt", R"(Shape "sphere")"},
      {"b.pbrt", R"(Include "a.pbrt" "float radius" 2)"},
      {"c.pbrt", R"(Shape "sphere" "float radius")"}};
  EXPECT_EQ(error_of(R"(WorldBegin Import "a.pbrt" "float radius" 1)", files),
            "scene.pbrt:1:28: expected a directive, found string 'float radius'");
  EXPECT_EQ(
      parse(R"(WorldBegin Import "b.pbrt")", files).shapes.at(0).parameters.get_float("radius", 0),
      2);
  EXPECT_EQ(error_of(R"(WorldBegin Import "c.pbrt" 1)", files),
            "c.pbrt:1:30: parameter 'radius' of type float expects a number, found the end of the "
            "file");
}

TEST(SceneFiles, ImportLeavesTheStateAlone) {
  const PbrtScene scene = parse(
      R"(WorldBegin Translate 1 0 0 Import "a.pbrt" Shape "disk" NamedMaterial "m")",
      {{"a.pbrt", R"(Translate 0 1 0 ReverseOrientation CoordinateSystem "inner" Shape "sphere" )"
                  R"(MakeNamedMaterial "m" "string type" "diffuse")"}});
  EXPECT_EQ(scene.shapes.at(0).world_from_object.start, translation(Vec3d(1, 1, 0)));
  EXPECT_EQ(scene.shapes.at(1).world_from_object.start, translation(Vec3d(1, 0, 0)));
  EXPECT_FALSE(scene.shapes.at(1).reverse_orientation);
  EXPECT_NE(error_of(R"(WorldBegin Import "a.pbrt" CoordSysTransform "inner")",
                     {{"a.pbrt", R"(CoordinateSystem "inner")"}}),
            "");
}

TEST(SceneFiles, AreSoughtBesideTheFileThatNamesThem) {
  const std::map<std::string, std::string> files = {
      {"parts/a.pbrt", R"(Include "b.pbrt" Include "parts/b.pbrt" Include "../c.pbrt")"},
      {"parts/b.pbrt", R"(Shape "sphere")"},
      {"b.pbrt", R"(Shape "disk")"},
      {"c.pbrt", R"(Shape "cylinder")"}};
  const PbrtScene scene = parse(R"(WorldBegin Include "parts/a.pbrt")", files);
  ASSERT_EQ(scene.shapes.size(), 3U);
  EXPECT_EQ(scene.shapes[0].type, "sphere");  // parts/b.pbrt, not the one beside the main file.
  EXPECT_EQ(scene.shapes[1].type, "sphere");  // Where pbrt looks: from the main file.
  EXPECT_EQ(scene.shapes[2].type, "cylinder");
}

TEST(SceneFiles, MayBePacked) {
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 20000; ++i) text += "Shape \"sphere\"\n";
  const std::string packed = gzip(text);
  EXPECT_LT(packed.size(), text.size() / 10);
  EXPECT_EQ(parse(packed).shapes.size(), 20000U);
  EXPECT_EQ(parse(R"(WorldBegin Include "s.pbrt.gz")", {{"s.pbrt.gz", gzip(R"(Shape "disk")")}})
                .shapes.size(),
            1U);
  // Two members one after the other, as `cat a.gz b.gz` makes them.
  EXPECT_EQ(parse(gzip("WorldBegin ") + gzip(R"(Shape "disk")")).shapes.size(), 1U);
  EXPECT_EQ(error_of(gzip("WorldBegin\nNothing")),
            "scene.pbrt:2:1: there is no directive 'Nothing'");
}

TEST(SceneFiles, ThatUnpackToTooMuchAreRefused) {
  Diagnostics diagnostics;
  ParseLimits limits;
  limits.file_bytes = 10000;
  try {
    parse_pbrt_text(gzip(std::string(1000000, ' ')), "scene.pbrt", diagnostics,
                    MemoryFileReader({}), limits);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "scene.pbrt: it unpacks to more than the 10000 bytes that are read");
  }
}

TEST(SceneFiles, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(parse("\xef\xbb\xbfWorldBegin").shapes.size(), 0U);
}

TEST(SceneFiles, AreReadFromDisk) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "freepath_scene_files";
  std::filesystem::create_directories(folder / "parts");
  std::ofstream(folder / "main.pbrt") << R"(WorldBegin Include "parts/a.pbrt")";
  std::ofstream(folder / "parts" / "a.pbrt") << R"(Shape "sphere")";
  Diagnostics diagnostics;
  EXPECT_EQ(parse_pbrt_file(folder / "main.pbrt", diagnostics).shapes.size(), 1U);
  for (const char* name : {"missing.pbrt", "parts"}) {
    try {
      parse_pbrt_file(folder / name, diagnostics);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind((folder / name).string() + ": ", 0), 0U)
          << error.what();
    }
  }
  std::filesystem::remove_all(folder);
}

TEST(SceneFiles, ForComparisonWithOtherRenderersParseAsTheyStand) {
  const std::filesystem::path data = FREEPATH_TEST_DATA;
  const std::filesystem::path scenes = data / ".." / "bench" / "scenes";
  if (!std::filesystem::exists(scenes)) {
    GTEST_SKIP() << "no scenes beside " << data << " (CMake variable FREEPATH_TEST_DATA)";
  }
  const char* names[] = {"wdas_sun", "wdas_env", "wdas_chroma", "smoke_floor",
                         "fireball", "fog_spot", "glass_jar",   "rgbgrid"};
  for (const char* name : names) {
    Diagnostics diagnostics;
    const PbrtScene scene = parse_pbrt_file(scenes / (std::string(name) + ".pbrt"), diagnostics);
    EXPECT_TRUE(diagnostics.warnings().empty()) << name;
    EXPECT_EQ(scene.film->parameters.get_integer("xresolution", 0), 192) << name;
    EXPECT_EQ(scene.integrator->type, "volpath") << name;
    EXPECT_FALSE(scene.media.empty()) << name;
    EXPECT_FALSE(scene.shapes.empty()) << name;
    EXPECT_TRUE(scene.camera->camera_from_world.start != Matrix4d()) << name;
    EXPECT_FALSE(scene.lights.empty() && scene.area_lights.empty()) << name;
  }
}

TEST(SceneFiles, OfTheRgbGridHoldAllItsValues) {
  const std::filesystem::path file =
      std::filesystem::path(FREEPATH_TEST_DATA) / ".." / "bench" / "scenes" / "rgbgrid.pbrt";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  Diagnostics diagnostics;
  const PbrtScene scene = parse_pbrt_file(file, diagnostics);
  const PbrtMedium& medium = scene.media.at(0);
  EXPECT_EQ(medium.parameters.get_spectra("sigma_s").size(), 512U);
  EXPECT_EQ(medium.parameters.get_point("p1", Vec3d(0)), Vec3d(1));
}

}  // namespace
}  // namespace freepath::testing
