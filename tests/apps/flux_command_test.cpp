// freepath flux, and volumes that repeat in pictures, as users call them.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "freepath/io/image.h"
#include "freepath/io/volume_write.h"
#include "tests/apps/program.h"
#include "tests/media/make_field.h"

namespace freepath::testing {
namespace {

using Json = nlohmann::json;

class FluxCommandTest : public ProgramTest {
 protected:
  void SetUp() override {
    Matrix4d halves;
    halves.setScale(Vec3d(0.5));
    const auto field = make_field(
        Vec3i(0), Vec3i(3, 2, 1), [](const Vec3i& v) { return 0.5F + static_cast<float>(v.x); },
        halves);
    field->name = "density";
    const Field* const fields[] = {field.get()};
    write_vdb(path("field.vdb"), fields);
  }
  Json flux(const std::string& options) const {
    const std::string paths = options.find("--error") != std::string::npos ? "" : "--paths 20000 ";
    const Outcome outcome = run("flux field.vdb --json " + paths + options);
    EXPECT_EQ(outcome.status, 0) << outcome;
    return Json::parse(outcome.output, nullptr, false);
  }
  void expect_refused(const std::string& line, const std::string& message) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 1) << line << '\n' << outcome;
    EXPECT_NE(outcome.messages.find(message), std::string::npos) << line << '\n' << outcome;
    EXPECT_EQ(files(), std::vector<std::string>{"field.vdb"}) << line;
  }
};

TEST_F(FluxCommandTest, JsonHasTheWholeAndItsColumns) {
  const Json all = flux("--albedo 0.9 --sun-zenith 40 --view 30,180 --ground 0.3");
  for (const char* name : {"reflectance", "transmittance", "unscattered", "absorptance"}) {
    const std::string error = std::string(name) + "_error";
    EXPECT_GT(all[name].get<double>(), 0) << name;
    EXPECT_GT(all[error].get<double>(), 0) << name;
    ASSERT_EQ(all["columns"][name].size(), 3U) << name;
    ASSERT_EQ(all["columns"][name][0].size(), 4U) << name;
    ASSERT_EQ(all["columns"][error][2].size(), 4U) << name;
    double mean = 0;
    for (const Json& row : all["columns"][name]) {
      for (const Json& value : row) mean += value.get<double>() / 12;
    }
    EXPECT_NEAR(mean, all[name].get<double>(), 1e-9) << name;
  }
  EXPECT_EQ(all["radiances"][0]["view_zenith"], 30);
  EXPECT_EQ(all["radiances"][0]["columns"]["radiance"].size(), 3U);
  EXPECT_EQ(all["domain"][0], Json({-0.25, 1.75}));
  EXPECT_EQ(all["paths"], 20000);
  // Denser columns absorb more.
  EXPECT_GT(all["columns"]["absorptance"][1][3], all["columns"]["absorptance"][1][0]);
  const Json coarse = flux("--albedo 0.9 --sun-zenith 40 --columns 2,1");
  EXPECT_EQ(coarse["columns"]["reflectance"][0].size(), 2U);
}

TEST_F(FluxCommandTest, SunsAreListedAndTheSkyIsOne) {
  const Json suns = flux("--sun-zenith 0,60 --sun-azimuth 90");
  ASSERT_EQ(suns["results"].size(), 2U);
  EXPECT_EQ(suns["results"][1]["sun_zenith"], 60);
  EXPECT_EQ(suns["results"][1]["sun_azimuth"], 90);
  EXPECT_EQ(flux("--diffuse")["diffuse"], true);
  // Straight down, but for what rounding makes of a cosine of 90 degrees.
  EXPECT_LT(flux("--up y --sun-zenith 0")["unscattered"].get<double>(), 0.7);
}

TEST_F(FluxCommandTest, PathsAreAsManyAsAnErrorTakes) {
  const Outcome outcome = run("flux field.vdb --albedo 0.9 --error 0.001 --json");
  ASSERT_EQ(outcome.status, 0) << outcome;
  const Json result = Json::parse(outcome.output);
  double largest = 0;
  for (const char* name : {"reflectance_error", "transmittance_error", "absorptance_error"}) {
    largest = std::max(largest, result[name].get<double>());
  }
  EXPECT_LT(largest, 0.00102);
  EXPECT_GT(largest, 0.0009);
}

TEST_F(FluxCommandTest, MapsHaveAChannelForEachQuantityAndItsError) {
  const Json all = flux("--sun-zenith 30 --view 0 -o maps.exr");
  const Image maps = read_image(path("maps.exr"));
  ASSERT_EQ(maps.width, 4);
  ASSERT_EQ(maps.height, 3);
  for (const char* name : {"reflectance", "transmittance", "unscattered", "absorptance",
                           "radiance1", "reflectance.error"}) {
    EXPECT_TRUE(find_channel(maps, name)) << name;
  }
  // The second axis upwards.
  const int channel = find_channel(maps, "reflectance").value();
  EXPECT_FLOAT_EQ(maps.pixel(1, 0)[channel], all["columns"]["reflectance"][2][1].get<float>());
}

TEST_F(FluxCommandTest, ChannelsThatDifferAreThreeGreyMedia) {
  const std::string light = "--sun-zenith 40 --view 30,180 --ground 0.3 --error 0.002 ";
  const Json all = flux(light + "--albedo 0.9,0.5,1 -o maps.exr");
  EXPECT_EQ(all["sun_zenith"], 40);
  const std::pair<const char*, const char*> albedos[] = {{"R", "0.9"}, {"G", "0.5"}, {"B", "1"}};
  for (const auto& [channel, albedo] : albedos) {
    const Json grey = flux(light + "--albedo " + albedo);
    for (const auto& [key, value] : all["channels"][channel].items()) {
      EXPECT_EQ(value, grey[key]) << channel << ' ' << key;
    }
  }
  const Image maps = read_image(path("maps.exr"));
  const int absorptance = find_channel(maps, "absorptance.G").value();
  EXPECT_FLOAT_EQ(maps.pixel(1, 0)[absorptance],
                  all["channels"]["G"]["columns"]["absorptance"][2][1].get<float>());
  EXPECT_TRUE(find_channel(maps, "radiance1.error.B"));
}

TEST_F(FluxCommandTest, WhatCantBeIsRefused) {
  expect_refused("flux field.vdb --sun-zenith 90", "--sun-zenith: 90");
  expect_refused("flux field.vdb --sun-zenith 1,2,3 --sun-azimuth 1,2", "give as many of both");
  expect_refused("flux field.vdb --view 90", "--view");
  expect_refused("flux field.vdb --columns 0,1", "--columns");
  expect_refused("flux field.vdb --domain 0,1", "--domain");
  expect_refused("flux field.vdb --domain 0,1,0,2", "beyond the domain");
  expect_refused("flux field.vdb --paths 10 --error 0.1", "give one or the other");
  expect_refused("flux field.vdb --error 2", "--error");
  expect_refused("flux field.vdb --ground 0.5,1", "above the bottom");
  expect_refused("flux field.vdb -o maps.png", "-o: maps are written as .exr");
  expect_refused("flux field.vdb -o no/maps.exr", "no/maps.exr");
  expect_refused("flux field.vdb --sun-zenith 0,1 -o maps.exr", "one sun");
  expect_refused("flux missing.vdb", "missing.vdb");
  expect_refused("flux field.vdb --columns 32768,32768", "columns are more than");
  expect_refused("flux field.vdb --tracker weighted-delta:rate-scale=0.7", "rate-scale");
  expect_refused("flux field.vdb --le 1", "no part of these fluxes");
  expect_refused("flux field.vdb --temperature density", "no part of these fluxes");
  expect_refused("render field.vdb -o p.exr --periodic x,y", "points up");
  expect_refused("render field.vdb -o p.exr --periodic x,w", "--periodic");
  expect_refused("render field.vdb -o p.exr --domain 0,1", "--domain is that of --periodic");
}

// The bounds of a sequence may change with its frames, and with them the period.
TEST_F(FluxCommandTest, SequencesSayTheirDomain) {
  std::filesystem::copy(path("field.vdb"), path("f.1.vdb"));
  const std::string line =
      "render f.%d.vdb --frames 1 -o p.%d.exr --periodic x,z --spp 1 --size 4x4";
  const Outcome outcome = run(line);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.messages.find("needs a --domain"), std::string::npos) << outcome;
  EXPECT_EQ(run(line + " --domain -0.25,1.75,-0.25,0.75").status, 0);
}

TEST_F(FluxCommandTest, PicturesOfPeriodicVolumesHaveNoSides) {
  const std::string common =
      "render field.vdb --up z --size 8x8 --spp 16 --environment 1 "
      "--albedo 0 --density-scale 50 --look-at 9,9,2,0,0,0 --fov 10 ";
  ASSERT_EQ(run(common + "-o alone.exr").status, 0);
  ASSERT_EQ(run(common + "-o many.exr --periodic x,y").status, 0);
  const auto brightest = [&](const char* name) {
    const Image image = read_image(path(name));
    float most = 0;
    for (int i = 0; i < 64; ++i) most = std::max(most, image.pixel(i % 8, i / 8)[0]);
    return most;
  };
  EXPECT_GT(brightest("alone.exr"), 0.9F);
  EXPECT_LT(brightest("many.exr"), 1e-3F);
}

}  // namespace
}  // namespace freepath::testing
