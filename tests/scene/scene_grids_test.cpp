// Grids of media: given in the scene, as colours, and in files of both formats; and media that come
// by name or overlap.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/rgb_spectrum.h"
#include "tests/io/volume_files.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

std::string medium(const std::string& type, const std::string& parameters) {
  return R"(MakeNamedMedium "m" "string type" ")" + type + R"(" "float g" .3 )" + parameters + "\n";
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text + " ";
  return all;
}

const std::string kThreeEach =
    R"("integer nx" 3 "integer ny" 3 "integer nz" 3 "point3 p0" [ -1.5 -1.5 -1.5 ] )"
    R"("point3 p1" [ 1.5 1.5 1.5 ] )";
/// Up to the centres of the outer voxels, beyond which a grid fades.
const std::string kBox = medium_box("m", Vec3d(-1), Vec3d(1));

// The emission of a grid of colours is brighter than that of other media by the integral of the
// luminous efficiency, as in pbrt.
TEST(SceneGrid, OfOneColourIsHomogeneous) {
  const std::string sigma_a = ".3 .2 .1";
  const std::string sigma_s = ".5 1 1.5";
  const std::string le = ".5 .3 .2";
  expect_twins(
      "colours",
      stage(medium("rgbgrid", kThreeEach + R"("rgb sigma_a" [ )" + repeated(sigma_a, 27) +
                                  R"(] "rgb sigma_s" [ )" + repeated(sigma_s, 27) +
                                  R"(] "rgb Le" [ )" + repeated(le, 27) +
                                  R"(] "float scale" 2 "float Lescale" )" +
                                  fmt::format("{}", 1.5 / kLuminousIntegral)) +
            kBox),
      stage(medium("homogeneous", R"("rgb sigma_a" [ )" + sigma_a + R"( ] "rgb sigma_s" [ )" +
                                      sigma_s + R"( ] "rgb Le" [ )" + le +
                                      R"( ] "float scale" 2 "float Lescale" 1.5)") +
            kBox),
      384);
}

TEST(SceneGrid, OfOneEmissionIsHomogeneous) {
  const std::string same = R"("rgb sigma_a" [ .3 .3 .3 ] "rgb sigma_s" [ 1 1 1 ] )"
                           R"("rgb Le" [ .5 .3 .2 ] )";
  expect_twins(
      "emission",
      stage(medium("uniformgrid", kThreeEach + same + R"("float density" [ )" + repeated("1", 27) +
                                      R"(] "float Lescale" [ )" + repeated("1.5", 27) + "]") +
            kBox),
      stage(medium("homogeneous", same + R"("float Lescale" 1.5)") + kBox));
}

/// Voxels of a box of 5 x 4 x 6 cubes of side 0.4, of which the outer ones are empty.
const Vec3i kCounts(5, 4, 6);
const Vec3d kLow(-1, -0.8, -1.2);
constexpr double kEdge = 0.4;

double lump(const Vec3i& voxel, int seed) {
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] == 0 || voxel[axis] == kCounts[axis] - 1) return 0;
  }
  return (voxel.x * 5 + voxel.y * 3 + voxel.z * 7 + seed) % 4 + 1;
}

testing_volumes::TestGrid grid_of(const std::string& name, int seed) {
  testing_volumes::TestGrid grid;
  grid.name = name;
  for (int axis = 0; axis < 3; ++axis) {
    grid.index_to_world[axis][axis] = kEdge;
    grid.index_to_world[3][axis] = kLow[axis] + 0.5 * kEdge;
  }
  for (int i = 0; i < kCounts.x * kCounts.y * kCounts.z; ++i) {
    const Vec3i voxel(i % kCounts.x, i / kCounts.x % kCounts.y, i / kCounts.x / kCounts.y);
    if (lump(voxel, seed) > 0) grid.voxels.push_back({voxel, lump(voxel, seed)});
  }
  return grid;
}

std::string values_of(int seed) {
  std::string values;
  for (int z = 0; z < kCounts.z; ++z) {
    for (int y = 0; y < kCounts.y; ++y) {
      for (int x = 0; x < kCounts.x; ++x) {
        values += std::to_string(lump(Vec3i(x, y, z), seed)) + " ";
      }
    }
  }
  return values;
}

/// Temperatures of 1500 to 2400 kelvin where there is density.
const std::string kFire = R"("rgb sigma_a" [ .2 .2 .2 ] "rgb sigma_s" [ 1 1 1 ] "float scale" .7 )"
                          R"("float temperaturescale" 300 "float temperatureoffset" -4 )";

void expect_file(const std::string& type, const std::filesystem::path& file) {
  const std::string box = medium_box("m", Vec3d(-1.5), Vec3d(1.5));
  expect_twins(type,
               stage(medium("uniformgrid",
                            kFire +
                                R"("integer nx" 5 "integer ny" 4 "integer nz" 6 )"
                                R"("point3 p0" [ -1 -.8 -1.2 ] "point3 p1" [ 1 .8 1.2 ] )"
                                R"("float density" [ )" +
                                values_of(0) + R"(] "float temperature" [ )" + values_of(1) + "]") +
                     box),
               stage(medium(type, kFire + R"("string gridname" "fog" "string filename" ")" +
                                      file.string() + R"(" "string temperaturename" "heat")") +
                     box),
               256);
}

TEST(SceneGrid, OfFilesAreThoseOfTheScene) {
  const std::vector<testing_volumes::TestGrid> grids = {grid_of("fog", 0), grid_of("heat", 1)};
  const TemporaryFile vdb("fire.vdb");
  const TemporaryFile nvdb("fire.nvdb");
  testing_volumes::write_vdb_file(vdb.path(), grids);
  testing_volumes::write_nvdb_file(nvdb.path(), grids);
  expect_file("openvdb", vdb.path());
  expect_file("nanovdb", nvdb.path());
}

/// White light seen along z through media that only absorb.
std::string white_behind(const std::string& media) {
  return kUnlimited + film(8) +
         "LookAt 0 0 -9  0 0 0  0 1 0\n"
         "Camera \"orthographic\" \"float screenwindow\" [ -.01 .01 -.01 .01 ]\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n" +
         media;
}

// Skim milk absorbs 0.0014, 0.0025 and 0.0142 per millimetre [Jensen01].
TEST(SceneGrid, PresetsHaveTheirCoefficients) {
  const std::string scene =
      white_behind(medium("homogeneous", R"("string preset" "Skimmilk" "rgb sigma_s" [ 0 0 0 ] )"
                                         R"("float scale" 50)") +
                   kBox);
  expect_mean("rgb", render_text(scene, {.samples = 4096}),
              {std::exp(-0.14), std::exp(-0.25), std::exp(-1.42)},
              {.absolute = 1e-4, .largest_relative_error = 0.006});
  const RgbColorSpace& space = rgb_color_space("srgb");
  const RgbSpectrum sigma = RgbSpectrum::unbounded(Vec3d(0.0014, 0.0025, 0.0142), space);
  const Vec3d expected = space.from_xyz(observe([&](double wavelength) {
    return space.illuminant()(wavelength) * std::exp(-100 * sigma(wavelength));
  }));
  expect_mean("spectral", render_text(scene, {.mode = ColorMode::kSpectral, .samples = 4096}),
              {expected.x, expected.y, expected.z},
              {.absolute = 1e-4, .largest_relative_error = 0.006});
}

// Where the boundary of neither names the other as what is around it, both are there. (In pbrt the
// boundary that a ray crossed last would tell, so that it looks different from behind.)
TEST(SceneGrid, OverlappingMediaAddUp) {
  const auto absorbing = [](const std::string& name, double sigma) {
    return fmt::format(R"(MakeNamedMedium "{0}" "string type" "homogeneous" )"
                       "\"rgb sigma_a\" [ {1} {1} {1} ] \"rgb sigma_s\" [ 0 0 0 ]\n",
                       name, sigma);
  };
  const std::string scene = white_behind(absorbing("a", 0.3) + absorbing("b", 0.9) +
                                         medium_box("a", Vec3d(-1, -1, -1), Vec3d(1, 1, 0.5)) +
                                         medium_box("b", Vec3d(-1, -1, -0.3), Vec3d(1, 1, 1)));
  const double expected = std::exp(-(0.3 * 1.5 + 0.9 * 1.3));
  for (const ColorMode mode : kColorModes) {
    expect_mean(name_of(mode), render_text(scene, {.mode = mode, .samples = 8192}),
                {expected, expected, expected}, {.largest_relative_error = 0.0034});
  }
}

}  // namespace
}  // namespace freepath::testing
