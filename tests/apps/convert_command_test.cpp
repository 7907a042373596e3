// freepath convert: round trips, units and scales, wrong input; and optical depths of what is read.

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "freepath/io/volume.h"
#include "freepath/transport/sampling.h"
#include "tests/apps/program.h"
#include "tests/io/dense_files.h"
#include "tests/io/volume_files.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

using testing_volumes::as_text;
using testing_volumes::sample_positions;
using testing_volumes::SampleGrid;

class ConvertTest : public ProgramTest {
 protected:
  void expect_done(const std::string& line) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 0) << outcome;
    EXPECT_EQ(outcome.output, "") << outcome;
    EXPECT_EQ(outcome.messages, "") << outcome;
  }
  void expect_error(const std::string& line, const std::vector<std::string>& parts) const {
    const std::vector<std::string> before = files();
    const Outcome outcome = run(line);
    SCOPED_TRACE(line);
    EXPECT_GT(outcome.status, 0) << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.messages.find(part), std::string::npos) << "no " << part << ": " << outcome;
    }
    EXPECT_EQ(files(), before);
  }
  LoadedField load(const std::string& name, const std::string& grid = {}) const {
    LoadOptions options;
    options.selection = parse_grid_selection(grid);
    return load_field(path(name), options);
  }
  void write(const std::string& name, const std::string& text) const {
    testing_volumes::write_text(path(name), text);
  }
};

/// Fails the test where two fields differ by more than a share of the value and an amount.
void expect_same(const Field& a, const Field& b, double share, double amount) {
  const Vec3i low = a.voxels.active_min(), high = a.voxels.active_max();
  const Matrix4d between = a.index_to_world * b.index_to_world.inverse();
  for (int x = low.x - 1; x <= high.x + 1; x += 3) {
    for (int y = low.y - 1; y <= high.y + 1; y += 2) {
      for (int z = low.z - 1; z <= high.z + 1; ++z) {
        const double expected = a.voxels.value(Vec3i(x, y, z));
        const Vec3d point = Vec3d(x, y, z) * between;
        ASSERT_NEAR(b.voxels.interpolate(point), expected, share * expected + amount) << point;
      }
    }
  }
}

TEST_F(ConvertTest, VolumesGoRoundThroughAllFormatsThatAreWritten) {
  expect_done("generate cloud -o a.vdb --resolution 24");
  expect_done("convert a.vdb b.vti");
  expect_done("convert b.vti c.nvdb");
  expect_done("convert c.nvdb d.vdb");
  const LoadedField first = load("a.vdb");
  for (const char* const name : {"b.vti", "c.nvdb", "d.vdb"}) {
    SCOPED_TRACE(name);
    const LoadedField other = load(name);
    expect_same(first.field, other.field, 1e-5, 1e-8);
    EXPECT_EQ(other.maximum, first.maximum);
    EXPECT_EQ(other.active_voxels, first.active_voxels);
    EXPECT_EQ(other.field.name, "density");
  }
  // Halves have 11 bits; the steps of NanoVDB are 2^-16 of a range, which is 1 at most here.
  expect_done("convert a.vdb e.vdb --half");
  expect_same(first.field, load("e.vdb").field, 0x1p-11, 1e-7);
  expect_done("convert a.vdb e.nvdb --half");
  expect_same(first.field, load("e.nvdb").field, 1e-6, 0x1p-16);
}

TEST_F(ConvertTest, TheSameInputGivesTheSameBytes) {
  write("a.vti", testing_volumes::vti_file());
  for (const std::string extension : {"vdb", "nvdb", "vti"}) {
    expect_done("convert a.vti b." + extension);
    expect_done("convert a.vti c." + extension);
    EXPECT_EQ(testing_volumes::read_bytes(path("b." + extension)),
              testing_volumes::read_bytes(path("c." + extension)));
  }
}

TEST_F(ConvertTest, ATurnedGridKeepsItsPlaceInVti) {
  write("a.nrrd", testing_volumes::nrrd_file("raw"));
  expect_done("convert a.nrrd b.vti");
  testing_volumes::expect_affine(load("b.vti"), sample_positions());
  expect_done("convert b.vti c.nvdb --name other");
  testing_volumes::expect_affine(load("c.nvdb", "other"), sample_positions());
}

TEST_F(ConvertTest, UnitsScalePositionsAndScaleValues) {
  write("a.nrrd", testing_volumes::nrrd_file("raw"));  // in mm
  expect_done("convert a.nrrd b.vdb --unit m --scale 0.5");
  const LoadedField before = load("a.nrrd"), after = load("b.vdb");
  EXPECT_EQ(before.length_unit, "mm");
  for (int row = 0; row < 4; ++row) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(after.field.index_to_world[row][k], 1e-3 * before.field.index_to_world[row][k],
                  1e-9);
    }
  }
  EXPECT_FLOAT_EQ(after.maximum, 0.5F * before.maximum);
  write("b.vti", testing_volumes::vti_file());
  expect_error("convert b.vti c.vdb --unit m", {"--unit", "doesn't tell", "--input-unit"});
  expect_done("convert b.vti c.vdb --unit m --input-unit km");
  EXPECT_NEAR(load("c.vdb").field.index_to_world[3][2], 3000, 1e-6);
  expect_error("convert a.nrrd c2.vdb --unit m --input-unit km", {"tells its own unit, mm"});
  expect_error("convert a.nrrd c2.vdb --unit parsec", {"--unit", "parsec", "km"});
  expect_error("convert b.vti c2.vdb --input-unit km", {"--input-unit", "--unit"});
}

TEST_F(ConvertTest, GridsAreChosenAndAllIsAll) {
  write("a.vtk", testing_volumes::legacy_vtk_file(false, false));
  expect_done("convert a.vtk one.vdb --grid again");
  EXPECT_EQ(list_grids(path("one.vdb")).size(), 1U);
  expect_done("convert a.vtk two.nvdb --grid again --grid density");
  EXPECT_EQ(list_grids(path("two.nvdb"))[1].name, "density");
  expect_done("convert a.vtk all.vti --all");
  EXPECT_EQ(list_grids(path("all.vti")).size(), 2U);
  expect_error("convert a.vtk b.vdb --all --grid again", {"--all", "--grid"});
  expect_error("convert a.vtk b.vdb --grid none", {"a.vtk", "none", "again"});
  expect_error("convert a.vtk b.vdb --all --name x", {"--name"});
}

TEST_F(ConvertTest, RawValuesAreReadByOptions) {
  const SampleGrid grid = sample_positions(0, false);
  write("a.raw", testing_volumes::stored<float>(testing_volumes::affine_values(grid)));
  expect_error("convert a.raw b.vdb", {"a.raw", "--raw-size"});
  expect_done("convert a.raw b.vdb --raw-size 10,9,11 --raw-spacing 0.5,0.25,2 --raw-origin 1,2,3");
  testing_volumes::expect_affine(load("b.vdb"), grid);
  expect_error("convert a.raw c.vdb --raw-size 10,9", {"--raw-size", "2 values"});
  expect_error("convert a.raw c.vdb --raw-size 10,9,-11", {"--raw-size", "-11"});
  expect_error("convert a.raw c.vdb --raw-size 10,9,12", {"a.raw", "bytes"});
  expect_error("convert a.raw c.vdb --raw-size 10,9,11 --raw-type float16", {"float16"});
  expect_error("convert a.raw c.vdb --raw-size 10,9,11 --raw-order middle", {"--raw-order"});
  expect_error("convert a.raw c.vdb --raw-type float32", {"--raw-size"});
}

TEST_F(ConvertTest, WrongInputIsOneErrorAndNoFile) {
  write("a.vti", testing_volumes::vti_file());
  write("cut.vti", testing_volumes::vti_file().substr(0, 3000));
  expect_error("convert a.vti b.xyz", {"b.xyz", ".vdb, .nvdb or .vti"});
  expect_error("convert a.vti none/b.vdb", {"none"});
  expect_error("convert none.vti b.vdb", {"none.vti", "no such file"});
  expect_error("convert cut.vti b.vdb", {"cut.vti", "truncated"});
  expect_error("convert a.vti b.vti --half", {"b.vti", "halves"});
  expect_error("convert a.vti b.vdb --scale 0", {"--scale"});
  expect_error("convert a.vti b.vdb --scale nan", {"--scale"});
  expect_error("convert a.vti b.vdb --scale 1e38", {"range of float"});
  expect_error("convert a.vti b.vdb --effective-radius -1", {"--effective-radius"});
  expect_error("convert a.vti b.vdb --negative maybe", {"--negative"});
}

TEST_F(ConvertTest, InfoTellsUnitsAndWhereSamplesAre) {
  write("a.nii", testing_volumes::nifti_file(1, false));
  const auto grid = nlohmann::json::parse(run("info a.nii --json").output)["grids"][0];
  EXPECT_EQ(grid["length_unit"], "mm");
  EXPECT_EQ(grid["type"], "float");
  EXPECT_NE(run("info a.nii").output.find("positions in mm"), std::string::npos);
  write("a.vti", testing_volumes::vti_file({.cells = true}));
  EXPECT_NE(run("info a.vti").output.find("samples in cells"), std::string::npos);
}

TEST_F(ConvertTest, ASparseGridThatWouldFillTheDiskIsNoImage) {
  testing_volumes::TestGrid grid;
  grid.voxels = {{Vec3i(0), 1.0}, {Vec3i(1 << 20), 1.0}};
  testing_volumes::write_vdb_file(path("far.vdb"), {grid});
  expect_error("convert far.vdb far.vti", {"far.vti", "GB", ".vdb or .nvdb"});
  expect_done("convert far.vdb far.nvdb");
  EXPECT_EQ(load("far.nvdb").active_voxels, 2U);
}

/// An estimate of the transmittance between two points.
RunningStatistics transmittance(const LoadedField& loaded, float sigma, const Vec3d& from,
                                const Vec3d& to) {
  Component component{.density = std::make_shared<Field>(loaded.field)};
  component.sigma_s = Rgb(sigma);
  const Medium medium({component});
  RayStream rays;
  constexpr std::size_t kRays = 200'000;
  rays.resize(kRays);
  const Vec3d direction = (to - from).normalized();
  for (std::size_t i = 0; i < kRays; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[static_cast<std::size_t>(axis)][i] = static_cast<float>(from[axis]);
      rays.direction[static_cast<std::size_t>(axis)][i] = static_cast<float>(direction[axis]);
    }
    rays.t_max[i] = static_cast<float>((to - from).length());
    rays.pixel[i] = static_cast<uint32_t>(i);
  }
  WalkSettings settings;
  settings.seed = 17;
  const FlightStream flights = estimate_transmittance(medium, rays, settings);
  RunningStatistics statistics;
  for (std::size_t i = 0; i < kRays; ++i) {
    statistics.add(static_cast<double>(flights.weight[0][i]));
  }
  return statistics;
}

TEST_F(ConvertTest, OpticalDepthsAlongKnownRaysAreTheClosedForm) {
  write("cells.vti", testing_volumes::vti_file({.cells = true}));
  write("nodes.vti", testing_volumes::vti_file({.format = "binary", .packed = true}));
  write("a.vtk", testing_volumes::legacy_vtk_file(false, true));
  write("a.nrrd", testing_volumes::nrrd_file("gzip"));
  write("a.mha", testing_volumes::metaimage_file(true));
  write("a.nii", testing_volumes::nifti_file(2, true));
  expect_done("convert cells.vti a.nvdb");
  struct Ray {
    std::string file;
    bool cells, turned;
  };
  for (const Ray& ray : std::vector<Ray>{{"cells.vti", true, true},
                                         {"nodes.vti", false, true},
                                         {"a.vtk", true, false},
                                         {"a.nrrd", false, true},
                                         {"a.mha", false, true},
                                         {"a.nii", false, true},
                                         {"a.nvdb", true, true}}) {
    SCOPED_TRACE(ray.file);
    const Matrix4d index_to_world =
        sample_positions(ray.cells ? 0.5 : 0, ray.turned).index_to_world;
    const Vec3d from = Vec3d(1.2, 0.7, 0.4) * index_to_world,
                to = Vec3d(8.1, 7.3, 9.8) * index_to_world;
    // The density is affine, so that its mean over the ray is that of the ends.
    const auto mean = [](const Vec3d& a, const Vec3d& b) {
      return (testing_volumes::affine_density(a) + testing_volumes::affine_density(b)) / 2;
    };
    const double length = (to - from).length();
    const double sigma = 1 / (mean(from, to) * length);  // an optical depth of 1
    const RunningStatistics found =
        transmittance(load(ray.file), static_cast<float>(sigma), from, to);
    EXPECT_LT(std::abs(z_score(found.mean(), found.standard_error(), std::exp(-1))), 4);
    // The same ray, were the samples half a step further: the test would see it.
    const Vec3d shift = Vec3d(0.5) * index_to_world - Vec3d(0) * index_to_world;
    const double shifted = sigma * length * mean(from - shift, to - shift);
    EXPECT_GT(std::abs(z_score(found.mean(), found.standard_error(), std::exp(-shifted))), 6);
  }
}

}  // namespace
}  // namespace freepath::testing
