// Scenes of several files, packed files, and the scenes that renderers are compared on.

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {
namespace {

std::string gzip(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  std::string source = text;
  stream.next_in = reinterpret_cast<Bytef*>(source.data());
  stream.avail_in = static_cast<uInt>(source.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

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
