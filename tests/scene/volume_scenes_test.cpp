// Bare volumes as scenes: ground, cameras, wavelengths; and options that scenes share with them.

#include "freepath/scene/volume_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/scene/volume_camera.h"
#include "tests/scene/rendered_scenes.h"
#include "tests/scene/volume_pictures.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kSize = 16;  // of pictures [pixels]

/// A cube from -1 to 1 in voxels of 1/8, moved.
VolumeMedium cube(const Rgb& sigma_a, const Rgb& sigma_s, const Vec3d& centre = Vec3d(0)) {
  Matrix4d index_to_world;
  index_to_world.setScale(Vec3d(0.125));
  // The centre of voxel 0 is at half a voxel.
  index_to_world *= Matrix4d().setTranslation(centre + Vec3d(0.0625));
  Component component;
  component.density = make_field(
      Vec3i(-8), Vec3i(7), [](const Vec3i&) { return 1.0F; }, index_to_world);
  component.sigma_a = sigma_a;
  component.sigma_s = sigma_s;
  return {std::make_shared<const Medium>(std::vector<Component>{component})};
}

VolumeMedium nothing() { return cube(Rgb(0.0F), Rgb(0.0F), Vec3d(0, 50, 0)); }

Picture render_volume(const PathScene& scene, ColorMode mode, uint32_t samples) {
  RenderSettings settings;
  settings.samples = samples;
  settings.walk.interpolation = Interpolation::kNearest;
  const RenderResult result = render_scene(scene, mode, settings);
  EXPECT_EQ(result.counts.overflows, 0U);
  return picture_of(result);
}

/// Looks down at the ground around the origin.
Camera overhead() { return {View{Vec3d(0, 9, 0.001), Vec3d(0), Vec3d(0, 1, 0), 20}, kSize, kSize}; }

// A sun of irradiance E at an elevation e gives a plane of albedo a the radiance a E sin(e) / π; a
// sky of 1 gives it a.
TEST(Ground, ReflectsWhatFallsOnIt) {
  constexpr double kElevation = 40;
  const Sun sun({.elevation = kElevation, .azimuth = 70, .irradiance = Rgb(3, 2, 1)}, UpAxis::kY);
  const double slope = std::sin(kElevation * std::numbers::pi / 180);
  for (const ColorMode mode : kColorModes) {
    // A product of spectra is not that of their colours, unless one is grey.
    const bool is_grey = mode == ColorMode::kSpectral;
    const Ground ground{is_grey ? Rgb(0.4F) : Rgb(0.2F, 0.4F, 0.6F), 0};
    const uint32_t samples = mode == ColorMode::kSpectral ? 1024 : 64;
    for (const bool has_sky : {false, true}) {
      Surroundings around{{}, sun};
      std::array<double, 3> expected{};
      for (int c = 0; c < 3; ++c) {
        expected[c] = ground.albedo[c] * (3 - c) * slope / std::numbers::pi;
      }
      if (has_sky) {
        around.environment = Rgb(1.0F);
        for (int c = 0; c < 3; ++c) expected[c] += ground.albedo[c];
      }
      const PathScene scene = make_volume_scene(nothing(), overhead(), around, ground);
      // Colours of lights become spectra that are seen within 0.2 % of them.
      const double tolerance = mode == ColorMode::kSpectral ? 4e-3 : 1e-4;
      expect_mean(std::string(name_of(mode)) + (has_sky ? " under a sky" : " under a sun"),
                  render_volume(scene, mode, samples), expected,
                  {.absolute = tolerance, .largest_relative_error = 0.02});
    }
  }
}

// With a white ground below, a medium that scatters all, and the same light from everywhere, all is
// white.
TEST(Ground, ClosesAFurnace) {
  const VolumeMedium fog = cube(Rgb(0.0F), Rgb(1.5F, 1.0F, 0.5F));
  const Camera camera({Vec3d(3, 1, 5), Vec3d(0), Vec3d(0, 1, 0), 35}, kSize, kSize);
  for (const double height : {-1.0, -2.5, 0.25}) {
    const Ground ground{Rgb(1.0F), height};
    for (const ColorMode mode : kColorModes) {
      const PathScene scene = make_volume_scene(fog, camera, {Rgb(1.0F)}, ground);
      expect_mean(fmt::format("{} with a ground at {}", name_of(mode), height),
                  render_volume(scene, mode, 512), {1, 1, 1},
                  {.absolute = 2e-5, .largest_relative_error = 2e-3});
    }
  }
}

// Where the furnace loses a hundredth at every reflection it is seen.
TEST(Ground, AnAlbedoOnePercentTooSmallIsNoticed) {
  const VolumeMedium fog = cube(Rgb(0.0F), Rgb(1.0F));
  const Camera camera({Vec3d(3, 1, 5), Vec3d(0), Vec3d(0, 1, 0), 35}, kSize, kSize);
  const PathScene scene = make_volume_scene(fog, camera, {Rgb(1.0F)}, Ground{Rgb(0.99F)});
  const Picture picture = render_volume(scene, ColorMode::kRgb, 512);
  EXPECT_LT((picture.mean[1] - 1) / picture.error[1], -8);
}

TEST(Ground, StandsUnderAllElseUnlessItIsTold) {
  // A dark cube whose bottom is at -1 hides the sky from straight below and above alike.
  const Camera camera({Vec3d(0, -3, 0.001), Vec3d(0, 0, 0), Vec3d(0, 1, 0), 10}, kSize, kSize);
  const VolumeMedium dark = cube(Rgb(50.0F), Rgb(0.0F));
  const auto seen = [&](std::optional<double> height) {
    const Ground ground{Rgb(1.0F), height};
    return render_volume(make_volume_scene(dark, camera, {Rgb(1.0F)}, ground), ColorMode::kRgb, 16)
        .mean[0];
  };
  EXPECT_NEAR(seen({}), 1, 1e-6);  // the underside of the plane, between camera and cube
  EXPECT_NEAR(seen(-5), 0, 1e-6);  // behind the camera
  EXPECT_THROW(make_volume_scene(dark, camera, {}, Ground{Rgb(1.5F)}), Error);
}

double covered(const Camera& camera) {
  const PathScene scene = make_volume_scene(cube(Rgb(1e4F), Rgb(0.0F)), camera, {Rgb(1.0F)});
  const Picture picture = render_volume(scene, ColorMode::kRgb, 256);
  return 1 - picture.mean[0];
}

// Seen face on, a cube of edge 2 covers 4 of the area that the picture shows.
TEST(VolumeCamera, AnOrthographicOneKeepsSizes) {
  for (const double distance : {5.0, 50.0}) {
    for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
      CameraOptions options{.kind = CameraKind::kOrthographic, .width = 3 * kSize, .height = kSize};
      options.fov = 2 * std::atan(2 / distance) * 180 / std::numbers::pi;  // 4 high
      options.from = up == UpAxis::kY ? Vec3d(0, 0, distance) : Vec3d(0, -distance, 0);
      options.at = Vec3d(0);
      EXPECT_NEAR(covered(make_camera(*nothing().medium, options, up)), 4.0 / (4 * 12), 5e-4)
          << distance;
    }
  }
}

// Over its edges the way through a cube goes down to 0: seen at an angle of 45 degrees it is
// 2 (√2 - |x|) long, whose exponential has a mean over the picture in closed form.
TEST(VolumeCamera, SeesTheEdgesOfAMedium) {
  constexpr double kHalfWidth = 1.5;
  constexpr double kHalfDiagonal = std::numbers::sqrt2;
  OrthographicCamera around;
  around.screen_window = {-kHalfWidth, kHalfWidth, -0.5, 0.5};
  const View view{Vec3d(9, 0, 9), Vec3d(0)};
  const Camera camera(around, world_from_camera(view), kSize, kSize);
  const PathScene scene = make_volume_scene(cube(Rgb(1.0F), Rgb(0.0F)), camera, {Rgb(1.0F)});
  const double beside = 2 * (kHalfWidth - kHalfDiagonal);
  const double expected = (beside + 1 - std::exp(-2 * kHalfDiagonal)) / (2 * kHalfWidth);
  expect_mean("cube", render_volume(scene, ColorMode::kRgb, 1024), {expected, expected, expected},
              {.absolute = 2e-5, .largest_relative_error = 3e-3});
}

// Between voxels linearly, a cube fades over half a voxel beyond its faces, and is seen there.
TEST(VolumeCamera, SeesAMediumAsFarAsItsFilterReaches) {
  constexpr double kHalfVoxel = 0.0625;
  Matrix4d along_x;  // looks along +x, the film around y = 1 and what lies above
  along_x = Matrix4d(0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, -9, 1 + kHalfVoxel / 2, 0, 1);
  OrthographicCamera strip;
  strip.screen_window = {-0.5, 0.5, -kHalfVoxel / 4, kHalfVoxel / 4};
  const Camera camera(strip, along_x, 4, 4);
  const PathScene scene = make_volume_scene(cube(Rgb(1e4F), Rgb(0.0F)), camera, {Rgb(1.0F)});
  for (const Interpolation interpolation :
       {Interpolation::kNearest, Interpolation::kTrilinear, Interpolation::kStochastic}) {
    RenderSettings settings;
    settings.samples = 16;
    settings.walk.interpolation = interpolation;
    const Picture picture = picture_of(render_scene(scene, ColorMode::kRgb, settings));
    EXPECT_NEAR(picture.mean[1], interpolation == Interpolation::kNearest ? 1 : 0, 1e-6);
  }
}

TEST(VolumeCamera, ASphericalOneHasItsTargetInTheMiddleAndTheHorizonLevel) {
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    const Vec3d above(up_vector(up));
    CameraOptions options{.kind = CameraKind::kSpherical, .width = 2 * kSize, .height = kSize};
    options.from = Vec3d(20, 0, 0) + above * 7;
    options.at = above * 9;
    const Camera camera = make_camera(*nothing().medium, options, up);
    const auto direction = [&](float x, float y) {
      return camera.ray(x * 2 * kSize, y * kSize).direction;
    };
    const auto expect_direction = [&](const Vec3f& found, const Vec3d& wanted) {
      EXPECT_LT((Vec3d(found) - wanted).length(), 1e-5);
    };
    expect_direction(direction(0.5F, 0.5F), Vec3d(-1, 0, 0));
    expect_direction(direction(0.5F, 0), above);
    // On the right is what lies to the right.
    expect_direction(direction(0.75F, 0.5F), Vec3d(-1, 0, 0).cross(above));
    expect_direction(direction(0.25F, 0.5F), above.cross(Vec3d(-1, 0, 0)));
  }
}

// In wavelengths, too, whatever the colours are.
TEST(VolumeWavelengths, CloseAFurnace) {
  const Camera camera({Vec3d(3, 1, 5), Vec3d(0), Vec3d(0, 1, 0), 30}, kSize, kSize);
  for (const char* tracker : {"delta", "spectral"}) {
    VolumeMedium fog = cube(Rgb(0.5F), Rgb(1, 3, 0.3F));
    std::vector<Component> components = fog.medium->components();
    components[0].emission = Rgb(1.0F);
    fog.medium = std::make_shared<const Medium>(std::move(components));
    RenderSettings settings;
    settings.samples = 512;
    settings.walk.tracker = tracker;
    const PathScene scene = make_volume_scene(fog, camera, {Rgb(1.0F)});
    expect_mean(tracker, picture_of(render_scene(scene, ColorMode::kSpectral, settings)), {1, 1, 1},
                {.absolute = 1e-4, .largest_relative_error = 3e-3});
  }
}

// Coloured absorption, seen through: in R, G and B the exponential of the colour's, in wavelengths
// that of the spectrum's, which differ; grey is the same in both.
TEST(VolumeWavelengths, SeeGreyAsColoursDo) {
  const Camera camera({Vec3d(0, 0, 400), Vec3d(0), Vec3d(0, 1, 0), 0.1}, 4, 4);
  for (const ColorMode mode : kColorModes) {
    const PathScene scene = make_volume_scene(cube(Rgb(0.5F), Rgb(0.0F)), camera, {Rgb(2.0F)});
    const double expected = 2 * std::exp(-1.0);
    expect_mean(name_of(mode), render_volume(scene, mode, 4096), {expected, expected, expected},
                {.absolute = 2e-4, .largest_relative_error = 0.02});
  }
}

// Of a scene, from outside of its file.

constexpr const char* kFogScene =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\nWorldBegin\n";

std::string fog_scene(const std::string& parameters, const std::string& lights) {
  return kUnlimited + film(8) + kFogScene + lights +
         R"(MakeNamedMedium "fog" "string type" "uniformgrid" "integer nx" 4 "integer ny" )"
         "4 "
         R"("integer nz" 4 "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] "float density" )"
         "[ " +
         [] {
           std::string ones;
           for (int i = 0; i < 64; ++i) ones += "1 ";
           return ones;
         }() +
         "] " + parameters + "\n" + medium_box("fog", Vec3d(-1), Vec3d(1));
}

BuiltScene build(const std::string& text, const BuildOptions& options) {
  Diagnostics diagnostics;
  return build_scene(parse(text, diagnostics), diagnostics, options);
}

TEST(SceneOptions, TheEnvironmentReplacesLightsFromAllAroundAndTheSunIsAdded) {
  const std::string black = R"("rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 0 0 0 ])";
  const std::string text = fog_scene(black, "LightSource \"infinite\" \"rgb L\" [ 7 7 7 ]\n");
  const auto mean = [&](const BuildOptions& options) {
    return picture_of(build(text, options), {.samples = 4}).mean[1];
  };
  EXPECT_NEAR(mean({}), 7, 1e-5);
  BuildOptions options;
  options.surroundings.environment = Rgb(0.5F);
  EXPECT_NEAR(mean(options), 0.5, 1e-6);
  options = {};
  options.ground = Ground{Rgb(0.25F), -8};
  options.surroundings.environment = Rgb(2.0F);
  // The camera looks at the horizon.
  EXPECT_NEAR(mean(options), 0.5 * (2 + 0.5), 0.02);
  options.surroundings = {{}, Sun({.elevation = 30, .irradiance = Rgb(4.0F)}, UpAxis::kY)};
  const double lit = 0.25 * (7 + 4 * 0.5 / std::numbers::pi);
  EXPECT_NEAR(mean(options), 0.5 * (7 + lit), 0.06);
}

TEST(SceneOptions, FillInWhatMediaLeaveOpen) {
  BuildOptions options;
  options.sigma_a = Rgb(0.25F);
  options.sigma_s = Rgb(0.5F);
  options.phase = PhaseFunction::henyey_greenstein(0.7F);
  options.super_voxel = 4;
  const auto medium = [&](const std::string& parameters) {
    BuiltScene built = build(fog_scene(parameters, ""), options);
    const SpectrumValues rgb = built.scene.spectra->in_rgb();
    const SceneMedium& only = built.scene.media.at(0);
    const BoundMedium bound = only.bind(rgb);
    return std::array<float, 3>{bound.channels.components[0].sigma_a[0],
                                bound.channels.components[0].sigma_s[1],
                                only.phase(0).evaluate(Vec3f(0, 0, 1), Vec3f(0, 0, 1))};
  };
  const float forward = PhaseFunction::henyey_greenstein(0.7F).evaluate({0, 0, 1}, {0, 0, 1});
  const auto open = medium("");
  EXPECT_FLOAT_EQ(open[0], 0.25F);
  EXPECT_FLOAT_EQ(open[1], 0.5F);
  EXPECT_FLOAT_EQ(open[2], forward);
  const auto given = medium(R"("float g" 0 "rgb sigma_a" [ 3 3 3 ] "rgb sigma_s" [ 2 2 2 ])");
  EXPECT_FLOAT_EQ(given[0], 3);
  EXPECT_FLOAT_EQ(given[1], 2);
  EXPECT_NEAR(given[2], 0.25 / std::numbers::pi, 1e-6);
}

TEST(SceneOptions, SuperVoxelsAreThoseAskedFor) {
  const std::string text = fog_scene("", "");
  const auto edge = [&](int wanted) {
    BuildOptions options;
    options.super_voxel = wanted;
    return build(text, options).scene.media.at(0).medium()->super_voxels().cell_size;
  };
  EXPECT_EQ(edge(4), 4);
  EXPECT_EQ(edge(16), 16);
}

}  // namespace
}  // namespace freepath::testing
