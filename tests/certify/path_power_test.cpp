// The power of furnaces: 2 % planted in the roulette of paths, in the shares of light sampling,
// in those of the emission guide, in lines or in branches must show, with as many samples as make
// the shift 7 standard errors.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/paths/renderer.h"
#include "tests/certify/planted.h"
#include "tests/scene/image_file.h"
#include "tests/scene/rendered_scenes.h"
#include "tests/scene/scattered_twice.h"
#include "tests/scene/volume_pictures.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr double kWantedPathShift = 7;  // standard errors
constexpr double kClearly = 5;
constexpr float kPathError = 1.02F;

/// A mean over a film.
struct FilmMean {
  double mean = 0;
  double error = 0;
};

FilmMean mean_of(const Image& image) {
  const int value = find_channel(image, "G").value();
  const int variance = find_channel(image, "variance.G").value();
  FilmMean result;
  const auto pixels = static_cast<double>(image.pixel_count());
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    result.mean += image.values[i * image.channels.size() + value] / pixels;
    result.error += image.values[i * image.channels.size() + variance];
  }
  result.error = std::sqrt(result.error) / pixels;
  return result;
}

/// A picture that is 1 everywhere.
using Furnace = FilmMean (*)(uint32_t samples, uint64_t seed);

/// Scatters and absorbs, emits what it would see, and is seen from outside.
FilmMean volume_furnace(uint32_t samples, uint64_t seed) {
  Matrix4d scale;
  scale.setScale(Vec3d(0.25));
  Component fog;
  fog.density = make_field(
      Vec3i(-4), Vec3i(3), [](const Vec3i& p) { return hash_noise(p); }, scale);
  fog.sigma_a = Rgb(3.0F);
  fog.sigma_s = Rgb(6.0F);
  fog.emission = Rgb(1.0F);
  const Medium medium({fog});
  const Camera camera(frame_points(corners_of(medium.world_bounds()), UpAxis::kY, 25, 1), 8, 8);
  RenderSettings settings;
  settings.samples = samples;
  settings.walk.seed = seed;
  return mean_of(render(medium, camera, {Rgb(1.0F)}, settings).film.to_image());
}

/// In a ball that glows: a sky that is the same everywhere would not be drawn.
FilmMean render_furnace(const std::string& world, uint32_t samples, uint64_t seed) {
  const std::string text =
      kUnlimited + film(8) +
      "LookAt 0.2 0.1 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 7\nWorldBegin\n"
      "AttributeBegin ReverseOrientation AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n"
      "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] Shape \"sphere\" \"float radius\" 20\n"
      "AttributeEnd\n" +
      world;
  return mean_of(render_text(text, {.samples = samples, .seed = seed}).image);
}

/// A small dense core that glows in a thin box, and fills the picture: the guide leads paths to it.
FilmMean core_furnace(uint32_t samples, uint64_t seed) {
  std::string voxels;
  for (int i = 0; i < 512; ++i) {
    const auto is_middle = [](int index) { return index == 3 || index == 4; };
    voxels += is_middle(i % 8) && is_middle(i / 8 % 8) && is_middle(i / 64) ? "8 " : "0.02 ";
  }
  const std::string medium =
      R"(MakeNamedMedium "core" "string type" "uniformgrid" "point3 p0" [ -1 -1 -1 ] )"
      R"("point3 p1" [ 1 1 1 ] "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 2 2 2 ] )"
      R"("rgb Le" [ 1 1 1 ] "integer nx" 8 "integer ny" 8 "integer nz" 8 "float density" [ )" +
      voxels + "]\n";
  return render_furnace(medium + medium_box("core", Vec3d(-1), Vec3d(1)), samples, seed);
}

FilmMean surface_furnace(uint32_t samples, uint64_t seed) {
  return render_furnace(
      "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\nShape \"sphere\" \"float radius\" 2\n",
      samples, seed);
}

/// Fog under a sky that is drawn, with shadow rays by roulette, and others that are found by
/// chance.
FilmMean sky_furnace(uint32_t samples, uint64_t seed) {
  static const WhiteSkies kSkies;
  const std::string fog =
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 2 2 2 ] )"
      R"("rgb sigma_a" [ 0 0 0 ])"
      "\n";
  const std::string text =
      kUnlimited + film(8) +
      "LookAt 0.2 0.1 -4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 7\nWorldBegin\n" +
      kSkies.lights() + fog + medium_box("fog", Vec3d(-1), Vec3d(1));
  return mean_of(render_text(text, {.samples = samples, .seed = seed}).image);
}

/// Fog around a point light that scatters it once into parallel rays, over what quadrature says:
/// ∫ σ_s e^(-σ_t (1 + z + r)) I / (4π r²) dz, where z = h tan θ and dz / r² = dθ / h.
FilmMean near_light(uint32_t samples, uint64_t seed) {
  constexpr double kHeight = 0.1;
  constexpr double kSigma = 0.8;  // of scattering alone
  constexpr int kSteps = 2000;
  const double widest = std::atan(1 / kHeight);
  double expected = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = widest * (2 * (i + 0.5) / kSteps - 1);
    const double way = 1 + kHeight * std::tan(angle) + kHeight / std::cos(angle);
    expected +=
        kSigma * std::exp(-kSigma * way) / (4 * std::numbers::pi * kHeight) * 2 * widest / kSteps;
  }
  const std::string text =
      "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(8) +
      "LookAt 0 0 -9  0 0 0  0 1 0\n"
      "Camera \"orthographic\" \"float screenwindow\" [ -1e-4 1e-4 -1e-4 1e-4 ]\nWorldBegin\n"
      R"(LightSource "point" "rgb I" [ 1 1 1 ] "point3 from" [ 0.1 0 0 ])"
      "\n"
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 0.8 0.8 0.8 ] )"
      R"("rgb sigma_a" [ 0 0 0 ])"
      "\n" +
      medium_box("fog", Vec3d(-1), Vec3d(1));
  const FilmMean found = mean_of(render_text(text, {.samples = samples, .seed = seed}).image);
  return {found.mean / expected, found.error / expected};
}

/// A ball of glass with fog in it.
FilmMean glass_furnace(uint32_t samples, uint64_t seed) {
  return render_furnace(
      R"(MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 1 1 1 ] )"
      R"("rgb sigma_a" [ 0 0 0 ] "float g" 0.5)"
      "\nMediumInterface \"fog\" \"\" Material \"dielectric\" \"float eta\" 1.4\n"
      "Shape \"sphere\" \"float radius\" 1\n",
      samples, seed);
}

/// A layer under a sun, over what quadrature says.
FilmMean lit_layer(uint32_t samples, uint64_t seed) {
  static const LitLayer kLayer{0, 2, 0.8, Vec3d(0.8, 0, 0.6)};
  static const double kExpected = kLayer.once() + kLayer.twice();
  const FilmMean found =
      mean_of(render_text(kLayer.scene(8), {.samples = samples, .seed = seed}).image);
  return {found.mean / kExpected, found.error / kExpected};
}

/// A layer under the disc of a sun, over what quadrature says of its middle.
FilmMean sun_layer(uint32_t samples, uint64_t seed) {
  const Sun sun({.elevation = 37, .irradiance = Rgb(1.0F)}, UpAxis::kZ);
  // So little is scattered that paths play roulette.
  const LitLayer layer{1.6, 0.4, 0.8, Vec3d(sun.direction())};
  static const double kExpected = layer.once() + layer.twice();
  Component fog;
  fog.density = make_field(Vec3i(-60, -60, 0), Vec3i(59, 59, 0), [](const Vec3i&) { return 1.0F; });
  fog.sigma_a = Rgb(static_cast<float>(layer.sigma_a));
  fog.sigma_s = Rgb(static_cast<float>(layer.sigma_s));
  fog.phase = PhaseFunction::henyey_greenstein(static_cast<float>(layer.g));
  const std::vector<CameraRay> rays(64, CameraRay{Vec3d(0, 0, -3), Vec3f(0, 0, 1)});
  RenderSettings settings;
  settings.samples = samples;
  settings.walk.seed = seed;
  settings.walk.interpolation = Interpolation::kNearest;
  settings.max_scatterings = 2;
  const FilmMean found = mean_of(
      render(Medium({fog}), Camera::of_rays(rays, 8, 8), {{}, sun}, settings).film.to_image());
  return {found.mean / kExpected, found.error / kExpected};
}

struct Case {
  const char* name;
  Furnace furnace;
  float Planted::*factor;
};

class PathMutant : public ::testing::TestWithParam<Case> {};

TEST_P(PathMutant, IsNoticed) {
  const Case& test = GetParam();
  const auto render = [&](float factor, uint32_t samples, uint64_t seed) {
    planted = {};
    planted.*test.factor = factor;
    const FilmMean result = test.furnace(samples, seed);
    planted = {};
    return result;
  };
  // With the same random numbers their difference is known well after few paths.
  constexpr uint32_t kPilot = 64;
  const FilmMean honest = render(1, kPilot, 1);
  const FilmMean wrong = render(kPathError, kPilot, 1);
  const double shift = wrong.mean - honest.mean;
  ASSERT_NE(shift, 0);
  const double times = std::pow(kWantedPathShift * wrong.error / shift, 2);
  const auto samples = static_cast<uint32_t>(std::max(64.0, std::ceil(times * kPilot)));
  ASSERT_LT(samples, 25'000U) << "hardly matters";
  const auto z = [](const FilmMean& found) { return std::abs(found.mean - 1) / found.error; };
  EXPECT_GT(z(render(kPathError, samples, 2)), kClearly) << samples << " samples";
  EXPECT_LT(z(render(1, std::max(kPilot, samples / 4), 2)), 4) << samples << " samples";
}

INSTANTIATE_TEST_SUITE_P(
    All, PathMutant,
    ::testing::Values(Case{"VolumeRoulette", volume_furnace, &Planted::roulette},
                      Case{"SceneRoulette", core_furnace, &Planted::roulette},
                      Case{"ShadowRoulette", sky_furnace, &Planted::shadow_roulette},
                      Case{"SceneLightShare", core_furnace, &Planted::light_share},
                      Case{"SunLightShare", sun_layer, &Planted::light_share},
                      Case{"SunRoulette", sun_layer, &Planted::roulette},
                      Case{"SurfaceLightShare", surface_furnace, &Planted::surface_share},
                      Case{"LobeBranches", lit_layer, &Planted::branch},
                      Case{"NearLightLines", near_light, &Planted::near_line},
                      Case{"LightThroughGlass", glass_furnace, &Planted::glass},
                      Case{"EmissionGuide", core_furnace, &Planted::emission_guide}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace freepath::testing
