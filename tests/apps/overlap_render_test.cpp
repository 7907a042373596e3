// freepath render with several volumes, with RGB densities, and with options for each volume.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"
#include "tests/io/volume_files.h"

namespace freepath::testing {
namespace {

using nlohmann::json;
using testing_volumes::TestGrid;

/// A ball in each channel, thickest at another place in each, with the same active voxels.
std::array<TestGrid, 3> dyes() {
  std::array<TestGrid, 3> channels;
  const char* const names[] = {"red", "green", "blue"};
  for (int c = 0; c < 3; ++c) {
    channels[c].name = names[c];
    channels[c].index_to_world = eighths();
    for (int x = -8; x < 8; ++x) {
      for (int y = -8; y < 8; ++y) {
        for (int z = -8; z < 8; ++z) {
          const float density = ball(Vec3i(x, y, z));
          const int along = c == 0 ? x : c == 1 ? y : z;
          if (density > 0)
            channels[c].voxels.push_back({Vec3i(x, y, z), density * (9 + along) / 9});
        }
      }
    }
  }
  return channels;
}

class OverlapRenderTest : public ProgramTest {
 protected:
  OverlapRenderTest() {
    write_cube(path("ball.vdb"));
    write_cube(path("turned.vdb"), ball, turned());
  }

  Image render(const std::string& arguments) const {
    const Outcome outcome = run("render --size 24x16 -o picture.exr " + arguments);
    EXPECT_EQ(outcome.status, 0) << arguments << '\n' << outcome;
    return read_image(path("picture.exr"));
  }

  void expect_error(const std::string& arguments, const std::vector<std::string>& parts) const {
    const Outcome outcome = run("render --size 8x8 --spp 1 -o bad.exr " + arguments);
    SCOPED_TRACE(arguments);
    EXPECT_EQ(outcome.status, 1) << outcome;
    EXPECT_EQ(outcome.messages.rfind("freepath: error: ", 0), 0U) << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.messages.find(part), std::string::npos) << "no " << part << ": " << outcome;
    }
    EXPECT_FALSE(std::filesystem::exists(path("bad.exr")));
  }
};

double value(const Image& image, const char* channel, int column, int row) {
  return image.pixel(column, row)[find_channel(image, channel).value()];
}

TEST_F(OverlapRenderTest, AFurnaceOfTwoVolumesIsOne) {
  // Radiance 1 from everywhere and no absorption: radiance 1 everywhere [white furnace].
  for (const std::string methods :
       {"--tracker delta --interpolation nearest", "--tracker decomposition",
        "--tracker spectral --interpolation trilinear --transmittance residual-ratio",
        "--tracker multi-volume",
        "--tracker regular --transmittance regular --interpolation nearest"}) {
    const bool slow = methods.find("regular") != std::string::npos;
    const std::string options =
        "ball.vdb turned.vdb --albedo 1 --environment 1 --g 0.5 --g -0.3 "
        "--density-scale 1 --density-scale 2 --spp " +
        std::string(slow ? "16 " : "200 ") + methods;
    const Image image = render(options);
    EXPECT_GT(value(image, "A", 12, 8), 0.5);
    for (const std::string channel : {"R", "G", "B"}) {
      const int mean = find_channel(image, channel).value();
      const int variance = find_channel(image, "variance." + channel).value();
      double sum = 0;
      double variances = 0;
      for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
          sum += image.pixel(column, row)[mean];
          variances += image.pixel(column, row)[variance];
        }
      }
      const auto count = static_cast<double>(image.pixel_count());
      EXPECT_NEAR(sum / count, 1, 4 * std::sqrt(variances) / count + 1e-5)
          << options << ", channel " << channel;
    }
  }
}

TEST_F(OverlapRenderTest, TwoVolumesAreTheirSum) {
  // The same ball twice is one of twice the density, whether its bricks are shared or not.
  const std::string look = " --spp 64 --environment 1 --albedo 0.3 --interpolation trilinear -o ";
  for (const char* files : {"ball.vdb --density-scale 2", "ball.vdb ball.vdb"}) {
    const Outcome outcome =
        run("render --size 24x16 " + std::string(files) + look +
            (files == std::string("ball.vdb ball.vdb") ? "two.exr" : "one.exr"));
    EXPECT_EQ(outcome.status, 0) << outcome;
  }
  const Outcome outcome = run("diff one.exr two.exr --json");
  for (const auto& z : json::parse(outcome.output)["z"]) EXPECT_LT(std::abs(z.get<double>()), 4);
}

TEST_F(OverlapRenderTest, AVectorGridIsThreeGridsBitForBit) {
  const std::array<TestGrid, 3> channels = dyes();
  testing_volumes::write_vdb_file(path("three.vdb"), {channels[0], channels[1], channels[2]});
  testing_volumes::write_vdb_vectors(path("vectors.vdb"), channels);
  testing_volumes::write_nvdb_vectors(path("vectors.nvdb"), channels);
  const std::string options = " --albedo 0.9,0.7,0.5 --g 0.3 --density-scale 2 --spp 4";
  for (const std::string tracker : {" --tracker spectral", " --tracker delta"}) {
    const auto values = [&](const char* volume) {
      return render(fmt::format("{}{}{}", volume, options, tracker)).values;
    };
    const auto three = values("three.vdb --grid red,green,blue");
    EXPECT_EQ(values("three.vdb --grid 0,1,2"), three);
    EXPECT_EQ(values("vectors.vdb --grid red"), three);
    EXPECT_EQ(values("vectors.nvdb --grid red"), three);
    EXPECT_NE(values("three.vdb --grid blue,green,red"), three);
  }
}

// Grids that hold no more than their own part are given one layout of bricks.
TEST_F(OverlapRenderTest, AVectorGridIsThreeSmallerGridsBitForBit) {
  std::array<TestGrid, 3> whole = dyes();
  std::array<TestGrid, 3> parts = whole;
  for (int c = 0; c < 3; ++c) {
    parts[c].voxels.clear();
    for (auto& voxel : whole[c].voxels) {
      if (voxel.coord[c] < 0) voxel.value = 0;
      if (voxel.value > 0) parts[c].voxels.push_back(voxel);
    }
  }
  testing_volumes::write_vdb_file(path("parts.vdb"), {parts[0], parts[1], parts[2]});
  testing_volumes::write_vdb_vectors(path("vectors.vdb"), whole);
  const std::string options = " --albedo 0.9 --spp 4 --tracker spectral --look-at 3,2,4,0,0,0";
  EXPECT_EQ(render("parts.vdb --grid red,green,blue" + options).values,
            render("vectors.vdb --grid red" + options).values);
}

TEST_F(OverlapRenderTest, AnRgbDensityActsOnItsChannelsAlone) {
  // Only the red channel has density: green and blue light pass.
  std::array<TestGrid, 3> channels = dyes();
  for (int c = 1; c < 3; ++c) {
    for (auto& voxel : channels[c].voxels) voxel.value = 0;
  }
  channels[0].name = "density";
  testing_volumes::write_vdb_vectors(path("red.vdb"), channels);
  const Image image = render(
      "red.vdb --albedo 0 --environment 1 --density-scale 100 --spp 16 --look-at 0,0,5,0,0,0");
  EXPECT_LT(value(image, "R", 12, 8), 0.01);
  EXPECT_NEAR(value(image, "G", 12, 8), 1, 1e-3);
  EXPECT_NEAR(value(image, "B", 12, 8), 1, 1e-3);
}

TEST_F(OverlapRenderTest, OptionsGoToVolumesInTheirOrder) {
  write_cube(path("left.vdb"), ball, eighths() * Matrix4d().setTranslation(Vec3d(-1, 0, 0)));
  write_cube(path("right.vdb"), ball, eighths() * Matrix4d().setTranslation(Vec3d(1, 0, 0)));
  const std::string look = " --look-at 0,0,5,0,0,0 --interpolation nearest --spp 4 ";
  Image image =
      render("left.vdb right.vdb --albedo 0.25 --albedo 0.75 --density-scale 1000" + look);
  EXPECT_NEAR(value(image, "albedo.R", 6, 8), 0.25, 1e-3);
  EXPECT_NEAR(value(image, "albedo.R", 17, 8), 0.75, 1e-3);
  image = render("left.vdb right.vdb --albedo 0.5 --density-scale 1000 --density-scale 0" + look);
  EXPECT_NEAR(value(image, "albedo.R", 6, 8), 0.5, 1e-3);
  EXPECT_EQ(value(image, "A", 17, 8), 0);
  const std::string dark = look +
                           "--environment 0 --sun none --density-scale 1000 --sigma-a 1 "
                           "--absorption analog --emission analog ";
  for (const std::string emission : {"--le 0 --le 3", "--emission 0 --emission 3"}) {
    image = render(fmt::format("left.vdb right.vdb {}{}", dark, emission));
    EXPECT_EQ(value(image, "R", 6, 8), 0) << emission;
    EXPECT_NEAR(value(image, "R", 17, 8), 3, 0.01) << emission;
  }
  image =
      render("left.vdb right.vdb --sigma-s 1 --sigma-s 3 --sigma-a 1 --density-scale 1000" + look);
  EXPECT_NEAR(value(image, "albedo.R", 6, 8), 0.5, 1e-3);
  EXPECT_NEAR(value(image, "albedo.R", 17, 8), 0.75, 1e-3);
}

TEST_F(OverlapRenderTest, TheCameraFramesAllVolumes) {
  write_cube(path("aside.vdb"), ball, eighths() * Matrix4d().setTranslation(Vec3d(6, 0, 0)));
  const Image image = render("ball.vdb aside.vdb --density-scale 1000 --spp 4");
  // Both are seen, and nothing is cut off.
  int columns = 0;
  for (int column = 0; column < image.width; ++column) {
    bool seen = false;
    for (int row = 0; row < image.height; ++row) seen = seen || value(image, "A", column, row) > 0;
    columns += seen ? 1 : 0;
  }
  EXPECT_GT(columns, 6);
  for (int row = 0; row < image.height; ++row) {
    EXPECT_EQ(value(image, "A", 0, row), 0);
    EXPECT_EQ(value(image, "A", image.width - 1, row), 0);
  }
}

TEST_F(OverlapRenderTest, StatisticsAndMetadataListAllVolumes) {
  testing_volumes::write_vdb_vectors(path("vectors.vdb"), dyes());
  const Image image =
      render("ball.vdb vectors.vdb --grid density --grid red --spp 1 --stats stats.json");
  std::ifstream stream(path("stats.json"));
  const json stats = json::parse(stream);
  EXPECT_EQ(stats["volumes"], json::parse(R"([
    {"file": "ball.vdb", "grids": ["density"]},
    {"file": "vectors.vdb", "grids": ["red.R", "red.G", "red.B"]}])"));
  for (const auto& [key, text] : image.metadata) {
    if (key == "freepath:volume") {
      EXPECT_EQ(text, MetadataValue(std::string("ball.vdb, vectors.vdb")));
    }
  }
}

TEST_F(OverlapRenderTest, InfoListsTheRangesOfAllChannels) {
  testing_volumes::write_vdb_vectors(path("vectors.vdb"), dyes());
  const Outcome text = run("info vectors.vdb");
  EXPECT_EQ(text.status, 0) << text;
  for (const char* part : {"vec3s", "R: ", "G: ", "B: ", "super-voxels"}) {
    EXPECT_NE(text.output.find(part), std::string::npos) << part << text;
  }
  const json grid = json::parse(run("info vectors.vdb --json").output)["grids"][0];
  EXPECT_EQ(grid["loadable"], true);
  ASSERT_EQ(grid["channels"].size(), 3U);
  EXPECT_EQ(grid["channels"][1]["name"], "G");
  EXPECT_GT(grid["channels"][2]["maximum"], 1);
}

TEST_F(OverlapRenderTest, ErrorsNameTheOptionOrTheGrid) {
  testing_volumes::write_vdb_file(path("three.vdb"), {dyes()[0], dyes()[1], dyes()[2]});
  std::array<TestGrid, 3> channels = dyes();
  testing_volumes::write_vdb_vectors(path("vectors.vdb"), channels);
  channels[1].voxels[7].value = std::numeric_limits<double>::quiet_NaN();
  testing_volumes::write_vdb_vectors(path("nan.vdb"), channels);
  for (const char* option :
       {"--density-scale", "--albedo", "--sigma-a", "--sigma-s", "--g", "--le"}) {
    std::string three;
    for (int i = 0; i < 3; ++i) three += std::string(" ") + option + " 0.5";
    expect_error(
        "ball.vdb turned.vdb" + three,
        {std::string(option) + ": it is given 3 times for 2 volumes; give it once, or once "
                               "for each volume in their order"});
    expect_error("ball.vdb" + three, {option, "3 times for 1 volume;"});
  }
  expect_error("ball.vdb --grid density --grid density", {"--grid", "2 times for 1 volume;"});
  expect_error("three.vdb --grid red,green", {"--grid", "'red,green'", "R,G,B"});
  expect_error("three.vdb --grid red,green,blue,red", {"--grid", "R,G,B"});
  expect_error("three.vdb --grid red,,blue", {"--grid", "R,G,B"});
  expect_error("three.vdb --grid red,green,violet", {"three.vdb", "violet", "blue"});
  expect_error("vectors.vdb --grid red,red,red", {"vectors.vdb", "\"red\"", "vec3s"});
  expect_error("vectors.vdb", {"vectors.vdb", "density", "red"});
  expect_error("nan.vdb --grid red --invalid error",
               {"nan.vdb", "grid \"red\", channel G: voxel", "NaN"});
  expect_error("vectors.vdb vectors.vdb vectors.vdb vectors.vdb vectors.vdb vectors.vdb --grid red",
               {"18 densities", "16", "RGB density counts as three"});
  expect_error("ball.vdb missing.vdb", {"missing.vdb"});
  expect_error("ball.vdb turned.vdb --stats turned.vdb", {"--stats", "turned.vdb"});
  expect_error("ball.vdb turned.vdb --tracker closed-form --interpolation nearest",
               {"closed-form", "homogeneous", "density", "regular"});
  expect_error("ball.vdb turned.vdb --albedo 0.5 --albedo 1.5", {"albedo", "1.5"});
  write_cube(path("far.vdb"), ball, eighths() * Matrix4d().setTranslation(Vec3d(1e9, 0, 0)));
  expect_error("ball.vdb far.vdb", {"density", "too far apart", "move them together"});
}

}  // namespace
}  // namespace freepath::testing
