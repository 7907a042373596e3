// Sampling the light of emissive media at scatterings: against quadrature, and against paths alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "freepath/paths/path_wavefront.h"
#include "freepath/scene/assembly/scene_builder.h"
#include "tests/scene/scenes_in_memory.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_mean;
using testing::RunningStatistics;

constexpr int kSize = 16;  // of a film's edge [pixels]

const std::string kBox =
    R"(AttributeBegin
  Material "interface"
  MediumInterface "glow" ""
  Shape "trianglemesh" "point3 P" [ -1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1 ]
    "integer indices" [ 0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 6 2 3 7 6  0 4 7 0 7 3  1 2 6 1 6 5 ]
AttributeEnd
)";

/// A scene that looks along z from (x, y, -4).
std::string scene_text(const std::string& at, const std::string& fov, const std::string& world) {
  const std::string size = std::to_string(kSize);
  return R"(Film "rgb" "integer xresolution" )" + size + R"( "integer yresolution" )" + size + R"(
Sampler "independent" "integer pixelsamples" 1
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
LookAt )" +
         at + " -4 " + at + R"( 0 0 1 0
Camera "perspective" "float fov" )" +
         fov + "\nWorldBegin\n" + world;
}

/// Means of one-sample pictures in R, or in all channels.
struct Rendered {
  RunningStatistics red, sum;
};

struct Way {
  bool samples_emission = true;
  std::string tracker = "spectral";
  ColorMode mode = ColorMode::kRgb;
  uint32_t max_scatterings = std::numeric_limits<uint32_t>::max();
};

Rendered render(const PathScene& scene, uint32_t pictures, const Way& way) {
  WalkSettings walk;
  walk.tracker = way.tracker;
  walk.origin = scene.origin;
  const WavelengthSampler factory(scene, way.mode, 4, walk);
  PathSetup setup;
  setup.scene = &scene;
  setup.factory = &factory;
  setup.max_scatterings = way.max_scatterings;
  setup.samples_emission = way.samples_emission;
  const uint32_t block = factory.sets_per_block();
  for (uint32_t set = 0; set < (pictures + block - 1) / block * block; ++set) {
    setup.colors.push_back(factory.colors_of_set(set));
  }
  PathWavefront wavefront(setup);
  Rendered rendered;
  for (uint32_t i = 0; i < pictures; ++i) {
    Film film(kSize, kSize);
    wavefront.trace({0, std::size_t{kSize} * kSize, i, 1}, film);
    const Image image = film.to_image();
    double red = 0;
    double sum = 0;
    for (int pixel = 0; pixel < kSize * kSize; ++pixel) {
      const float* const values = image.pixel(pixel % kSize, pixel / kSize);
      red += values[0];
      sum += values[0] + values[1] + values[2];
    }
    rendered.red.add(red / (kSize * kSize));
    rendered.sum.add(sum / (kSize * kSize));
  }
  return rendered;
}

BuiltScene build(const std::string& text) {
  Diagnostics diagnostics;
  return build_scene(testing::parse(text, diagnostics), diagnostics);
}

/// A small ball glows in the middle of fog, beside what is seen. A black sphere hides it from parts
/// of the fog.
BuiltScene glowing_ball() {
  constexpr int kVoxels = 21;
  std::string density;
  std::string radiance;
  for (int i = 0; i < kVoxels * kVoxels * kVoxels; ++i) {
    const Vec3i voxel(i % kVoxels, i / kVoxels % kVoxels, i / kVoxels / kVoxels);
    density += " 1";
    radiance += Vec3d(voxel - Vec3i(kVoxels / 2)).length() < 1.8 ? " 3" : " 0";
  }
  const std::string count = std::to_string(kVoxels);
  return build(scene_text(
      "0 0.6", "12",
      R"(MakeNamedMedium "glow" "string type" "uniformgrid" "point3 p0" [-1 -1 -1] "point3 p1" [1 1 1]
  "rgb sigma_a" [0.3 0.2 0.1] "rgb sigma_s" [0.2 0.4 0.6] "float g" 0.4 "rgb Le" [1 0.5 0.25]
  "integer nx" )" +
          count + " \"integer ny\" " + count + " \"integer nz\" " + count + " \"float density\" [" +
          density + " ] \"float Lescale\" [" + radiance + " ]\n" + kBox +
          R"(AttributeBegin
  MediumInterface "" "glow"
  Material "diffuse" "rgb reflectance" [0 0 0]
  Translate 0.2 0.3 0
  Shape "sphere" "float radius" 0.12
AttributeEnd
)"));
}

TEST(EmissionSampling, AgreesWithPathsAloneAndLowersTheVariance) {
  const BuiltScene built = glowing_ball();
  const std::vector<Way> ways = {
      {.tracker = "spectral"},
      {.tracker = "spectral", .mode = ColorMode::kSpectral},
      {.tracker = "hero-wavelength", .mode = ColorMode::kSpectral},
      {.tracker = "delta"},
  };
  for (Way way : ways) {
    const std::string name =
        way.tracker + (way.mode == ColorMode::kRgb ? " in rgb" : " at wavelengths");
    way.samples_emission = false;
    const Rendered off = render(built.scene, 400, way);
    way.samples_emission = true;
    const Rendered on = render(built.scene, 400, way);
    EXPECT_TRUE(check_mean(name, on.sum.mean() - off.sum.mean(),
                           std::hypot(on.sum.standard_error(), off.sum.standard_error()),
                           on.sum.count(), 0));
    EXPECT_LT(on.sum.variance(), 0.5 * off.sum.variance()) << name;
    EXPECT_LT(on.sum.standard_error(), 0.03 * on.sum.mean()) << name;
  }
}

/// Length of the way out of the box from -1 to 1.
double way_out(const Vec3d& from, const Vec3d& direction) {
  double way = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    way = std::min(way, ((direction[axis] > 0 ? 1 : -1) - from[axis]) / direction[axis]);
  }
  return way;
}

/// Mean over the sphere of 1 - exp(-sigma_t · way out).
double mean_opacity(const Vec3d& from, double sigma_t) {
  constexpr int kSteps = 160;
  double sum = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int row = i / kSteps;
    const double z = 1 - 2 * (row + 0.5) / kSteps;
    const double azimuth = 2 * std::numbers::pi * (i % kSteps + 0.5) / kSteps;
    const double sine = std::sqrt(1 - z * z);
    const Vec3d direction(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
    sum -= std::expm1(-sigma_t * way_out(from, direction));
  }
  return sum / (kSteps * kSteps);
}

/// A box of one glowing medium that scatters isotropically, seen through its middle, with at most
/// one scattering: ∫ e^(-σ_t t) (σ_a L_e + σ_s B (1 - e^(-σ_t s)) averaged over directions) dt,
/// where s is the way out and B = σ_a L_e / σ_t.
TEST(EmissionSampling, SingleScatteringOfABoxIsThatOfQuadrature) {
  const BuiltScene built = build(
      scene_text("0 0", "0.01",
                 R"(MakeNamedMedium "glow" "string type" "homogeneous" "rgb sigma_a" [0.4 0.4 0.4]
  "rgb sigma_s" [1.2 1.2 1.2] "rgb Le" [1 1 1]
)" + kBox));
  const PathScene& scene = built.scene;
  const BoundMedium bound = scene.media[0].bind(scene.spectra->in_rgb());
  const ComponentChannels& channels = bound.channels.components[0];
  const double sigma_t = channels.sigma_a[0] + channels.sigma_s[0];
  const double source = channels.sigma_a[0] * channels.emission[0];
  constexpr int kSteps = 60;
  double expected = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 2 * (i + 0.5) / kSteps;
    const double scattered =
        channels.sigma_s[0] * source / sigma_t * mean_opacity(Vec3d(0, 0, -1 + t), sigma_t);
    expected += std::exp(-sigma_t * t) * (source + scattered) * 2 / kSteps;
  }
  expected *= scene.exposure_scale;
  for (const bool samples_emission : {false, true}) {
    const Rendered rendered =
        render(scene, 600,
               {.samples_emission = samples_emission, .tracker = "delta", .max_scatterings = 1});
    EXPECT_TRUE(check_mean("radiance", rendered.red, expected,
                           {.absolute = 3e-4 * expected, .largest_relative_error = 0.005}));
  }
}

}  // namespace
}  // namespace freepath
