// NetCDF files: extinction of cloud water in all units, coordinates, times, and damage.

#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "freepath/io/volume.h"
#include "tests/io/netcdf_files.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

CloudVariable& find_variable(std::vector<CloudVariable>& variables, const std::string& name) {
  for (CloudVariable& variable : variables) {
    if (variable.name == name) return variable;
  }
  throw Error("no variable " + name);
}

void expect_extinction(const LoadedField& loaded, int time = 0, double tolerance = 1e-6) {
  const Matrix4d& m = loaded.field.index_to_world;
  EXPECT_NEAR(m[0][0], 50, 1e-9);
  EXPECT_NEAR(m[1][1], 25, 1e-9);
  EXPECT_NEAR(m[2][2], 40, 1e-9);
  EXPECT_NEAR((Vec3d(m[3][0], m[3][1], m[3][2]) - Vec3d(100, 200, 300)).length(), 0, 1e-9);
  EXPECT_EQ(loaded.length_unit, "m");
  EXPECT_EQ(loaded.value_unit, "1/m");
  for (int z = 0; z < kNz; ++z) {
    for (int y = 0; y < kNy; ++y) {
      for (int x = 0; x < kNx; ++x) {
        const double expected = extinction(time, z, y, x);
        ASSERT_NEAR(loaded.field.voxels.value(Vec3i(x, y, z)), expected, tolerance * expected);
      }
    }
  }
}

LoadedField load_named(const std::filesystem::path& path, const std::string& name = {}) {
  LoadOptions options;
  options.selection = parse_grid_selection(name);
  return load_field(path, options);
}

TEST(NetcdfVolumes, WaterAndRadiusGiveExtinctionInEveryFormat) {
  const TemporaryFolder folder;
  for (const int mode :
       {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4, NC_NETCDF4 | NC_CLASSIC_MODEL}) {
    SCOPED_TRACE(mode);
    write_netcdf(folder / "a.nc", cloud(), mode);
    const LoadedField first = load_named(folder / "a.nc");
    expect_extinction(first);
    ASSERT_EQ(first.warnings.size(), 1U);
    EXPECT_NE(first.warnings[0].find("2 times"), std::string::npos);
    expect_extinction(load_named(folder / "a.nc", "extinction@1"), 1);
    EXPECT_NEAR(load_named(folder / "a.nc", "re").field.voxels.value(Vec3i(0, 0, 3)), 8, 1e-6);
    EXPECT_EQ(list_grids(folder / "a.nc").size(), 3U);
  }
}

TEST(NetcdfVolumes, AreReadByAnyThreadWithoutAWord) {
  const TemporaryFolder folder;
  write_netcdf(folder / "a.nc", cloud());
  ::testing::internal::CaptureStderr();
  std::thread([&] { expect_extinction(load_named(folder / "a.nc")); }).join();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(NetcdfVolumes, UnitsOfWaterAndRadiusAreToldApart) {
  const TemporaryFolder folder;
  for (const auto& [unit, scale] :
       std::vector<std::pair<std::string, double>>{{"g/m3", 1e3}, {"g m-3", 1e3}, {"kg/m^3", 1}}) {
    std::vector<CloudVariable> variables = cloud();
    CloudVariable& lwc = find_variable(variables, "lwc");
    lwc.texts = {{"units", unit}};
    for (double& value : lwc.values) value *= scale;
    CloudVariable& re = find_variable(variables, "re");
    re.texts = {{"units", "m"}};
    for (double& value : re.values) value *= 1e-6;
    write_netcdf(folder / "a.nc", variables);
    expect_extinction(load_named(folder / "a.nc"));
  }
}

TEST(NetcdfVolumes, WaterByMassIsMultipliedByTheDensityOfAir) {
  const TemporaryFolder folder;
  const auto density = [](int z) { return 1.2 - 0.01 * z; };
  std::vector<CloudVariable> variables = cloud();
  CloudVariable& lwc = find_variable(variables, "lwc");
  lwc.name = "QC";
  lwc.texts = {{"units", "g/kg"}};
  lwc.values =
      sampled([&](int t, int z, int y, int x) { return 1e3 * water(t, z, y, x) / density(z); });
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("rho in kg m-3"),
            std::string::npos);
  CloudVariable rho{"rho", {"z"}, {}, {{"units", "kg m-3"}}};
  CloudVariable pressure{"p", {"time", "z"}, {}, {{"units", "hPa"}}};
  CloudVariable temperature{"TABS", {"z"}, {}, {{"units", "K"}}};
  for (int z = 0; z < kNz; ++z) {
    rho.values.push_back(density(z));
    temperature.values.push_back(290 - z);
  }
  for (int t = 0; t < kTimes; ++t) {
    for (int z = 0; z < kNz; ++z) {
      pressure.values.push_back(density(z) * 287.05 * (290 - z) / 100);
    }
  }
  std::vector<CloudVariable> with_density = variables;
  with_density.push_back(rho);
  write_netcdf(folder / "a.nc", with_density);
  expect_extinction(load_named(folder / "a.nc"));
  std::vector<CloudVariable> with_pressure = variables;
  with_pressure.push_back(pressure);
  with_pressure.push_back(temperature);
  write_netcdf(folder / "a.nc", with_pressure);
  expect_extinction(load_named(folder / "a.nc"));
}

TEST(NetcdfVolumes, OtherOrdersOfDimensionsAndFallingCoordinatesAreTheSamePlaces) {
  const TemporaryFolder folder;
  std::vector<CloudVariable> variables = cloud();
  CloudVariable& lwc = find_variable(variables, "lwc");
  lwc.dimensions = {"x", "y", "z"};
  lwc.values.clear();
  for (int x = 0; x < kNx; ++x) {
    for (int y = 0; y < kNy; ++y) {
      for (int z = 0; z < kNz; ++z) lwc.values.push_back(water(0, z, y, x));
    }
  }
  find_variable(variables, "re") = {"re", {"z"}, {5, 6, 7, 8, 9, 10}, {{"units", "micron"}}};
  write_netcdf(folder / "a.nc", variables);
  const LoadedField rising = load_named(folder / "a.nc");
  expect_extinction(rising);
  EXPECT_TRUE(rising.warnings.empty());
  find_variable(variables, "x").values = even(kNx, 300, -50);
  write_netcdf(folder / "a.nc", variables);
  const LoadedField falling = load_named(folder / "a.nc");
  const Vec3d point(150, 225, 340);
  const double at =
      falling.field.voxels.interpolate(point * falling.field.index_to_world.inverse());
  EXPECT_NEAR(at, extinction(0, 1, 1, 3), 1e-6 * at);
}

TEST(NetcdfVolumes, UnevenLevelsAreInterpolatedAndUnevenColumnsRefused) {
  const TemporaryFolder folder;
  std::vector<CloudVariable> variables = cloud();
  const std::vector<double> levels{0, 10, 20, 40, 60, 100};
  find_variable(variables, "z").values = levels;
  find_variable(variables, "re") = {"re", {"time"}, {10, 10}, {{"units", "um"}}};
  // Linear in height, so that interpolation is exact.
  find_variable(variables, "lwc").values = sampled([&](int /*t*/, int z, int y, int x) {
    return 1e-4 * (1 + x + y + levels[static_cast<std::size_t>(z)]);
  });
  write_netcdf(folder / "a.nc", variables);
  const LoadedField loaded = load_named(folder / "a.nc", "extinction@0");
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_NE(loaded.warnings[0].find("interpolated to 11 planes"), std::string::npos);
  for (int k = 0; k <= 10; ++k) {
    const double expected = 1.5e-4 * (1 + 2 + 1 + 10 * k) / (1000 * 1e-5);
    EXPECT_NEAR(loaded.field.voxels.value(Vec3i(2, 1, k)), expected, 1e-6 * expected);
  }
  find_variable(variables, "z").values = {0, 0.001, 20, 40, 60, 100};
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("even levels"), std::string::npos);
  variables = cloud();
  find_variable(variables, "y").values = {0, 1, 2, 4};
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("not evenly spaced"),
            std::string::npos);
}

TEST(NetcdfVolumes, PackedAndMissingValuesAreUnpacked) {
  const TemporaryFolder folder;
  std::vector<CloudVariable> variables = cloud();
  CloudVariable& lwc = find_variable(variables, "lwc");
  // Of 16 bits: value = 1e-4 · stored + 0.
  lwc.type = NC_SHORT;
  for (double& value : lwc.values) value = std::round(value * 1e4);
  lwc.numbers = {{"scale_factor", 1e-4}, {"_FillValue", -999}};
  write_netcdf(folder / "a.nc", variables);
  expect_extinction(load_named(folder / "a.nc"));
  lwc.values[7] = -999;
  write_netcdf(folder / "a.nc", variables);
  EXPECT_EQ(load_named(folder / "a.nc").invalid_voxels, 1U);
  find_variable(variables, "re").values[3] = 0;
  write_netcdf(folder / "a.nc", variables);
  EXPECT_EQ(load_named(folder / "a.nc").invalid_voxels, 2U);
}

TEST(NetcdfVolumes, AnEffectiveRadiusStandsInForAMissingOne) {
  const TemporaryFolder folder;
  std::vector<CloudVariable> variables = cloud();
  variables.pop_back();
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("effective radius"),
            std::string::npos);
  LoadOptions options;
  options.effective_radius = 1e-5;
  const double expected = 1.5 * water(0, 1, 2, 3) / (1000 * 1e-5);
  EXPECT_NEAR(load_field(folder / "a.nc", options).field.voxels.value(Vec3i(3, 2, 1)), expected,
              1e-6 * expected);
}

TEST(NetcdfVolumes, WhatIsMissingOrWrongIsNamed) {
  const TemporaryFolder folder;
  struct Wrong {
    std::string variable;
    std::vector<std::pair<std::string, std::string>> texts;
    std::string part;
  };
  for (const Wrong& wrong : std::vector<Wrong>{{"x", {}, "x have no units"},
                                               {"x", {{"units", "degrees_east"}}, "no length"},
                                               {"z", {{"units", "hPa"}}, "no length"},
                                               {"z", {{"units", "Mm"}}, "no length"},
                                               {"y", {{"units", "m"}, {"axis", "X"}}, "same axis"},
                                               {"lwc", {}, "lwc is in no units"},
                                               {"lwc", {{"units", "kg"}}, "'kg'"},
                                               {"re", {}, "re is in no units"},
                                               {"re", {{"units", "K"}}, "'K'"}}) {
    SCOPED_TRACE(wrong.part);
    std::vector<CloudVariable> variables = cloud();
    find_variable(variables, wrong.variable).texts = wrong.texts;
    write_netcdf(folder / "a.nc", variables);
    const std::string message = error_of([&] { load_named(folder / "a.nc", "extinction"); });
    EXPECT_NE(message.find(wrong.part), std::string::npos) << message;
    EXPECT_EQ(message.rfind((folder / "a.nc").string(), 0), 0U) << message;
  }
  std::vector<CloudVariable> variables = cloud();
  find_variable(variables, "x").values = {0, 1, std::nan(""), 3, 4};
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("its x"), std::string::npos);
  find_variable(variables, "x").values = {0, 1, 1, 3, 4};
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("neither rises nor falls"),
            std::string::npos);
  variables.erase(variables.begin() + 1);
  write_netcdf(folder / "a.nc", variables);
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("x has no coordinates"),
            std::string::npos);
  write_netcdf(folder / "a.nc", {});
  EXPECT_NE(error_of([&] { load_named(folder / "a.nc"); }).find("no variable along x, y and z"),
            std::string::npos);
}

/// A classic file of one dimension and one variable with one text, byte by byte: as no library
/// writes it.
Bytes classic_file(const std::string& dimension, const std::string& variable,
                   const std::string& text, uint32_t rank) {
  std::string file("CDF\1", 4);
  const auto number = [&](uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) file += static_cast<char>(value >> shift & 0xFF);
  };
  const auto name = [&](const std::string& characters) {
    number(static_cast<uint32_t>(characters.size()));
    file += characters;
    file.resize((file.size() + 3) / 4 * 4);
  };
  constexpr uint32_t kDimensions = 10, kVariables = 11, kTexts = 12, kFloat = 5;
  for (const uint32_t value : {0U, kDimensions, 1U}) number(value);
  name(dimension);
  for (const uint32_t value : {1U, 0U, 0U, kVariables, 1U}) number(value);
  name(variable);
  number(rank);
  for (uint32_t i = 0; i < rank; ++i) number(0);
  for (const uint32_t value : {kTexts, 1U}) number(value);
  name(text);
  number(2);  // characters
  name("m");
  for (const uint32_t value : {kFloat, 4U}) number(value);
  number(static_cast<uint32_t>(file.size()) + 4);
  number(0);
  return {file.begin(), file.end()};
}

// NetCDF's library copies what it finds, whatever room there is.
TEST(NetcdfVolumes, NamesAndRanksBeyondAllLimitsAreErrors) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& dimension, const std::string& variable,
                         const std::string& text, uint32_t rank) {
    write_bytes(folder / "a.nc", classic_file(dimension, variable, text, rank));
    return error_of([&] { load_named(folder / "a.nc"); });
  };
  EXPECT_NE(error("x", "v", "units", 1).find("no variable along"), std::string::npos);
  for (const std::size_t length : {257, 2000}) {
    const std::string name(length, 'n');
    for (const std::string& message :
         {error(name, "v", "units", 1), error("x", name, "units", 1), error("x", "v", name, 1)}) {
      EXPECT_NE(message.find("NC_MAX_NAME"), std::string::npos) << message;
    }
  }
  // The library has its own opinion of these.
  EXPECT_NE(error(std::string(100'000, 'n'), "v", "units", 1), "");
  for (const uint32_t rank : {1025U, 50'000U}) EXPECT_NE(error("x", "v", "units", rank), "");
}

TEST(NetcdfVolumes, EveryTruncationIsAnError) {
  const TemporaryFolder folder;
  for (const int mode : {0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4}) {
    SCOPED_TRACE(mode);
    write_netcdf(folder / "a.nc", cloud(), mode);
    const Bytes bytes = read_bytes(folder / "a.nc");
    // The last bytes of a classic file are those of the last record.
    for (std::size_t size = 1; size < bytes.size(); size += size < 1000 ? 13 : 499) {
      write_bytes(folder / "cut.nc", {bytes.begin(), bytes.begin() + static_cast<long>(size)});
      EXPECT_NE(error_of([&] { load_named(folder / "cut.nc", "extinction@1"); }), "") << size;
    }
    write_bytes(folder / "cut.nc", {bytes.begin(), bytes.end() - 1});
    EXPECT_NE(error_of([&] { load_named(folder / "cut.nc", "extinction@1"); }), "");
  }
}

}  // namespace
}  // namespace freepath
