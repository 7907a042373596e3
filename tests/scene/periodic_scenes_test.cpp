// Volumes that repeat sideways, in pictures.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/paths/periodic_domain.h"
#include "freepath/scene/assembly/scene_builder.h"
#include "freepath/scene/periodic_sides.h"
#include "freepath/scene/volume_scene.h"
#include "tests/scene/expect_near.h"
#include "tests/scene/media_bodies.h"
#include "tests/scene/periodic_volumes.h"
#include "tests/scene/rendered_scenes.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kPixels = 8;

PeriodicVoxels noise(float strength) {
  return {Vec3i(8, 6, 4), 0.25, [=](const Vec3i& voxel) { return strength * hash_noise(voxel); }};
}

/// Parallel rays that come down across several periods.
Camera slanted() {
  const View view{Vec3d(9, -6, 8), Vec3d(0.7, 0.4, 0.5), Vec3d(0, 0, 1)};
  OrthographicCamera camera;
  camera.screen_window = {-1.5, 1.5, -1.5, 1.5};
  return {camera, world_from_camera(view), kPixels, kPixels};
}

/// The mean over the film of what a ray sees, by midpoints.
double mean_over_film(const Camera& camera, const std::function<double(const CameraRay&)>& seen) {
  constexpr int kPoints = 96;
  double sum = 0;
  for (int row = 0; row < kPoints; ++row) {
    for (int column = 0; column < kPoints; ++column) {
      const float scale = static_cast<float>(kPixels) / kPoints;
      sum += seen(camera.ray((static_cast<float>(column) + 0.5F) * scale,
                             (static_cast<float>(row) + 0.5F) * scale));
    }
  }
  return sum / (kPoints * kPoints);
}

Vec3d at_height(const CameraRay& ray, double z) {
  const Vec3d direction(ray.direction);
  return ray.origin + direction * ((z - ray.origin.z) / direction.z);
}

Picture render_periodic(const PathScene& scene, Interpolation interpolation, uint32_t samples,
                        ColorMode mode = ColorMode::kRgb) {
  RenderSettings settings;
  settings.samples = samples;
  settings.walk.interpolation = interpolation;
  const RenderResult result = render_scene(scene, mode, settings);
  EXPECT_EQ(result.counts.overflows, 0U);
  EXPECT_EQ(result.counts.statistics().bound_violations, 0U);
  return picture_of(result);
}

constexpr Interpolation kInterpolations[] = {Interpolation::kNearest, Interpolation::kTrilinear,
                                             Interpolation::kStochastic};

// Before a white sky an absorber is seen by its transmittance, also where rays pass its sides and
// where filters reach over them.
TEST(PeriodicVolumes, AreSeenThroughTheirSides) {
  const PeriodicVoxels voxels = noise(0.5F);
  const Camera camera = slanted();
  const double expected_of[] = {
      mean_over_film(camera,
                     [&](const CameraRay& ray) {
                       return std::exp(
                           -voxels.depth(at_height(ray, 1.25), at_height(ray, -0.25), false, 400));
                     }),
      mean_over_film(camera, [&](const CameraRay& ray) {
        return std::exp(-voxels.depth(at_height(ray, 1.25), at_height(ray, -0.25), true, 200));
      })};
  for (const Interpolation interpolation : kInterpolations) {
    const PathScene scene = make_volume_scene(voxels.medium(0), camera, {Rgb(1.0F)});
    const double expected = expected_of[interpolation == Interpolation::kNearest ? 0 : 1];
    expect_mean("periodic", render_periodic(scene, interpolation, 8192),
                {expected, expected, expected}, {.absolute = 2e-4, .largest_relative_error = 2e-3});
  }
}

// A ground under an absorber sees the sun through the sides as well.
TEST(PeriodicVolumes, LetTheSunThroughTheirSides) {
  constexpr float kAlbedo = 0.8F;
  constexpr double kElevation = 25;
  const PeriodicVoxels voxels = noise(0.4F);
  const Camera camera = slanted();
  Surroundings around;
  around.sun.emplace(
      SunParameters{.elevation = kElevation, .azimuth = 100, .irradiance = Rgb(5.0F)}, UpAxis::kZ);
  const Vec3d to_sun(around.sun->direction());
  const double white =
      kAlbedo * 5 * std::sin(kElevation * std::numbers::pi / 180) / std::numbers::pi;
  const double expected = mean_over_film(camera, [&](const CameraRay& ray) {
    const Vec3d ground = at_height(ray, 0);
    const Vec3d top = ground + to_sun * (1.25 / to_sun.z);
    return white * std::exp(-voxels.depth(at_height(ray, 1.25), ground, true, 200) -
                            voxels.depth(ground, top, true, 200));
  });
  const Ground ground{.albedo = Rgb(kAlbedo), .height = 0.0, .up = UpAxis::kZ};
  const PathScene scene = make_volume_scene(voxels.medium(0), camera, around, ground);
  expect_mean("sun", render_periodic(scene, Interpolation::kStochastic, 8192),
              {expected, expected, expected}, {.absolute = 2e-4, .largest_relative_error = 3e-3});
}

// A white furnace: what scatters all light over a ground that reflects all of it is as bright as
// the sky, however often paths pass the sides.
TEST(PeriodicVolumes, AreWhiteInAWhiteFurnace) {
  const PeriodicVoxels voxels = noise(3);
  const Ground ground{.albedo = Rgb(1.0F), .up = UpAxis::kZ};
  for (const ColorMode mode : kColorModes) {
    const PathScene scene = make_volume_scene(
        voxels.medium(1, PhaseFunction::henyey_greenstein(0.6F)), slanted(), {Rgb(1.0F)}, ground);
    expect_mean("furnace", render_periodic(scene, Interpolation::kStochastic, 512, mode), {1, 1, 1},
                {.absolute = 1e-5, .largest_relative_error = 5e-3});
  }
}

// A period may be longer than its voxels: then there is nothing between them.
TEST(PeriodicVolumes, MayHaveGaps) {
  Matrix4d index_to_world;
  index_to_world.setScale(Vec3d(0.5));
  std::vector<Volume> volumes(1);
  volumes[0].densities.push_back(*make_field(
      Vec3i(0), Vec3i(0), [](const Vec3i&) { return 1.0F; }, index_to_world));
  volumes[0].optics.albedo = Rgb(0.0F);
  volumes[0].optics.density_scale = 1e5F;
  PeriodicSides sides{.axes = {true, true, false}};
  sides.extents = Box3d(Vec3d(-1), Vec3d(1));
  const VolumeMedium medium = make_medium(std::move(volumes), 0, sides);
  OrthographicCamera overhead;
  overhead.screen_window = {-4, 4, -4, 4};
  const Camera camera(overhead,
                      world_from_camera({Vec3d(0.3, 0.2, 9), Vec3d(0.3, 0.2, 0), Vec3d(0, 1, 0)}),
                      kPixels, kPixels);
  // Dark squares of a side of half a unit, in periods of two.
  expect_mean("gaps",
              render_periodic(make_volume_scene(medium, camera, {Rgb(1.0F)}),
                              Interpolation::kNearest, 4096),
              {0.9375, 0.9375, 0.9375}, {.absolute = 1e-4, .largest_relative_error = 2e-3});
}

TEST(PeriodicVolumes, WhatCantRepeatIsRefused) {
  const auto refused = [](const Matrix4d& transform, const std::optional<Box3d>& extents,
                          const std::string& part) {
    std::vector<Volume> volumes(1);
    volumes[0].densities.push_back(*make_field(
        Vec3i(0), Vec3i(3), [](const Vec3i&) { return 1.0F; }, transform));
    try {
      make_medium(std::move(volumes), 0, {.axes = {true, true, false}, .extents = extents});
      ADD_FAILURE() << part;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  Matrix4d turned;
  turned.rotate(Vec3d(0, 0, 0.3));
  refused(turned, {}, "turned against the x axis");
  refused(Matrix4d(), Box3d(Vec3d(0), Vec3d(3)), "beyond the domain");
  refused(Matrix4d(), Box3d(Vec3d(-0.5), Vec3d(3.8)), "cuts voxels");
  Matrix4d quarter;  // about z: still along the axes
  quarter.rotate(Vec3d(0, 0, std::numbers::pi / 2));
  std::vector<Volume> volumes(1);
  volumes[0].densities.push_back(*make_field(
      Vec3i(0), Vec3i(3, 1, 0), [](const Vec3i&) { return 1.0F; }, quarter));
  const VolumeMedium medium = make_medium(std::move(volumes), 0, {.axes = {true, true, false}});
  EXPECT_NEAR(medium.sides.extents->size().x, 2, 1e-9);
  EXPECT_NEAR(medium.sides.extents->size().y, 4, 1e-9);
}

TEST(PeriodicDomain, RaysComeInAgainAtTheOtherSide) {
  const PeriodicDomain domain(Box3d(Vec3d(-1, -2, 0), Vec3d(1, 2, 1)), {true, true, false});
  EXPECT_FLOAT_EQ(domain.way_to_side({0, 0, 0.5F}, {1, 0, 0}), 1);
  EXPECT_FLOAT_EQ(domain.way_to_side({0, 0, 0.5F}, {0, -0.5F, 0}), 4);
  EXPECT_EQ(domain.way_to_side({0, 0, 0.5F}, {0.1F, 0, 1}), INFINITY);  // by the top
  EXPECT_EQ(domain.way_to_side({0, 0, 0.5F}, {0, 0, -1}), INFINITY);
  expect_near(domain.beyond_side({0, 0.5F, 0.5F}, {1, 0.25F, 0}, 1), {-1, 0.75F, 0.5F});
  expect_near(domain.beyond_side({0, 0, 0.5F}, {-1, -2, 0}, 1), {1, 2, 0.5F});  // at an edge
  expect_near(domain.fold({3.5, -6.5, 7}), {-0.5F, 1.5F, 7});
  const auto entry = domain.enter({0, 0, 11}, {1, 0, -2});
  ASSERT_TRUE(entry);
  expect_near(entry->origin, {-1, 0, 1});
  EXPECT_FLOAT_EQ(entry->way, 5);
  EXPECT_FALSE(domain.enter({0, 0, 11}, {1, 0, 2}));
  EXPECT_FALSE(domain.enter({0, 0, 11}, {1, 0, 0}));
  EXPECT_THROW(PeriodicDomain(Box3d(Vec3d(0), Vec3d(0, 1, 1)), {true, false, false}), Error);
}

/// What comes before a world, with the camera of `slanted`.
const std::string kSlanted =
    film(kPixels) + kUnlimited +
    "LookAt 9 -6 8 0.7 0.4 0.5 0 0 1\n"
    "Camera \"orthographic\" \"float screenwindow\" [ -1.5 1.5 -1.5 1.5 ]\nWorldBegin\n";

BuiltScene build_periodic(const std::string& world,
                          const PeriodicSides& sides = {.axes = {true, true, false}}) {
  Diagnostics diagnostics;
  BuildOptions options;
  options.sides = sides;
  return build_scene(parse(kSlanted + world, diagnostics), diagnostics, options);
}

/// A grid of these voxels in a statement, and the box that it fills.
/// @param times how often each value is said
std::string grid_of(const PeriodicVoxels& voxels, const std::string& head, const std::string& name,
                    int times = 1) {
  std::string text = R"(MakeNamedMedium "m" "string type" )" + head;
  const Vec3d size = voxels.size();
  text +=
      fmt::format(R"("integer nx" {} "integer ny" {} "integer nz" {} "point3 p0" [ 0 0 0 ] )"
                  R"("point3 p1" [ {} {} {} ] "{}" [)",
                  voxels.counts.x, voxels.counts.y, voxels.counts.z, size.x, size.y, size.z, name);
  Vec3i at;
  for (at.z = 0; at.z < voxels.counts.z; ++at.z) {
    for (at.y = 0; at.y < voxels.counts.y; ++at.y) {
      for (at.x = 0; at.x < voxels.counts.x; ++at.x) {
        for (int i = 0; i < times; ++i) text += fmt::format(" {}", voxels.extinction(at));
      }
    }
  }
  return text + " ]\n" + medium_box("m", Vec3d(0), size);
}

// Grids of both kinds are read across the sides, as those of volumes are; flat ones too.
TEST(PeriodicScenes, AreSeenThroughTheirSides) {
  PeriodicVoxels flat = noise(0.9F);
  flat.counts = Vec3i(16, 14, 2);
  for (const PeriodicVoxels& voxels : {noise(0.5F), flat}) {
    const double height = voxels.size().z;  // where grids of statements end
    const double expected = mean_over_film(slanted(), [&](const CameraRay& ray) {
      return std::exp(-voxels.depth(at_height(ray, height), at_height(ray, 0), true, 200));
    });
    const std::string grey =
        grid_of(voxels, R"("uniformgrid" "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 0 0 0 ] )",
                "float density");
    std::string none = " \"rgb sigma_s\" [";
    for (int i = 0; i < voxels.counts.x * voxels.counts.y * voxels.counts.z; ++i) none += " 0 0 0";
    const std::string colors = grid_of(voxels, "\"rgbgrid\" " + none + " ] ", "rgb sigma_a", 3);
    for (const std::string& grid : {grey, colors}) {
      const BuiltScene built = build_periodic(kWhiteSky + grid);
      ASSERT_FALSE(built.scene.surfaces.has_value());
      expect_mean("periodic", picture_of(built, {.samples = 8192}), {expected, expected, expected},
                  {.absolute = 2e-4, .largest_relative_error = 2e-3});
    }
  }
}

// Where a period begins makes no difference to a grid with a gap beside it, and a ball in the gap.
TEST(PeriodicScenes, MayBeginAnywhere) {
  const std::string world =
      kWhiteSky +
      grid_of({Vec3i(4), 0.5, [](const Vec3i&) { return 1.0F; }},
              R"("uniformgrid" "rgb sigma_a" [ 1 1 1 ] "rgb sigma_s" [ 0 0 0 ] )",
              "float density") +
      R"(AttributeBegin Material "diffuse" "rgb reflectance" [ 0 0 0 ] Translate 3.2 1 1 )"
      "Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n";
  PeriodicSides sides{.axes = {true, true, false}};
  sides.extents = Box3d(Vec3d(0), Vec3d(4, 2, 0));
  const Picture at_side = picture_of(build_periodic(world, sides), {.samples = 8192});
  sides.extents = Box3d(Vec3d(-0.2, 0, 0), Vec3d(3.8, 2, 0));
  const Picture within = picture_of(build_periodic(world, sides), {.samples = 8192, .seed = 6});
  expect_alike("begin", at_side, within, {.absolute = 2e-4, .largest_relative_error = 4e-3});
}

// Fog without a boundary fills a domain that is far wider than all that stands in it.
TEST(PeriodicScenes, FogWithoutABoundaryHasNoHoles) {
  const std::string text = film(kPixels) + absorber("m0", 1) +
                           "MediumInterface \"\" \"m0\"\nLookAt 300 300 0 301 300 9 0 0 1\n"
                           "Camera \"perspective\" \"float fov\" 90\nWorldBegin\n" +
                           kWhiteSky + "Shape \"sphere\" \"float radius\" 0.1\n";
  BuildOptions options;
  options.sides.axes = {true, true, false};
  options.sides.extents = Box3d(Vec3d(-500), Vec3d(500));
  Diagnostics diagnostics;
  const BuiltScene built = build_scene(parse(text, diagnostics), diagnostics, options);
  EXPECT_LT(picture_of(built, {.samples = 64}).mean[0], 1e-4);
}

// Fog in a box that is the domain is a layer without end.
TEST(PeriodicScenes, FogIsALayerWithoutEnd) {
  const std::string fog = kWhiteSky +
                          "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" "
                          "\"rgb sigma_a\" [ .2 .4 .8 ] \"rgb sigma_s\" [ 0 0 0 ]\n" +
                          medium_box("m", Vec3d(-1, 2, 0), Vec3d(1, 3, 0.5));
  const Vec3d direction = (Vec3d(0.7, 0.4, 0.5) - Vec3d(9, -6, 8)).normalized();
  const double length = 0.5 / std::abs(direction.z);
  std::array<double, 3> expected{};
  for (int c = 0; c < 3; ++c) expected[c] = std::exp(-0.2 * (1 << c) * length);
  expect_mean("layer", picture_of(build_periodic(fog), {.samples = 4096}), expected);
}

// A white furnace with things in it: a floor that is larger than the domain, below the cloud or
// touching it, a ball in it and one that a side cuts.
TEST(PeriodicScenes, AreWhiteInAWhiteFurnace) {
  const PeriodicVoxels voxels = noise(3);
  const auto floor = [](double z) {
    return fmt::format(R"(Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" )"
                       "[ -9 -9 {0} 9 -9 {0} 9 9 {0} -9 9 {0} ]\n",
                       z);
  };
  const auto ball = [](const Vec3d& at) {
    return fmt::format(R"(AttributeBegin Translate {} {} {} Shape "sphere" "float radius" 0.2 )"
                       "AttributeEnd\n",
                       at.x, at.y, at.z);
  };
  for (const double height : {-1, 0}) {
    const std::string world =
        kWhiteSky +
        grid_of(voxels, R"("uniformgrid" "rgb sigma_a" [ 0 0 0 ] "rgb sigma_s" [ 1 1 1 ] )",
                "float density") +
        R"(Material "diffuse" "rgb reflectance" [ 1 1 1 ] )" + floor(height) +
        ball({1.1, 0.7, height + 0.5}) + ball({0, 0.8, height + 0.4});
    const BuiltScene built = build_periodic(world);
    ASSERT_TRUE(built.scene.surfaces.has_value());
    for (const ColorMode mode : kColorModes) {
      expect_mean("furnace", picture_of(built, {.mode = mode, .samples = 512}), {1, 1, 1},
                  {.absolute = 1e-5, .largest_relative_error = 5e-3});
    }
  }
}

// A ball of fog within the domain keeps its boundary, and is seen again in each period.
TEST(PeriodicScenes, BodiesOfFogRepeat) {
  const std::string text =
      kWhiteSky + absorber("m0", 4) + Body{0, true, Vec3d(-0.5), Vec3d(0.5)}.text();
  PeriodicSides sides{.axes = {true, true, false}};
  sides.extents = Box3d(Vec3d(-1, -0.75, 0), Vec3d(1, 0.75, 0));
  std::string copies = kWhiteSky + absorber("m0", 4);
  for (int x = -8; x <= 8; ++x) {
    for (int y = -8; y <= 8; ++y) {
      const Vec3d middle(2.0 * x, 1.5 * y, 0);
      copies += Body{0, true, middle - Vec3d(0.5), middle + Vec3d(0.5)}.text();
    }
  }
  const std::string inside =  // the camera's place has to be known
      film(kPixels) + kUnlimited +
      "LookAt 0.9 -0.6 3 0.7 0.4 0 0 0 1\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n";
  Diagnostics diagnostics;
  BuildOptions options;
  options.sides = sides;
  const BuiltScene one = build_scene(parse(inside + text, diagnostics), diagnostics, options);
  ASSERT_TRUE(one.scene.surfaces.has_value());
  expect_alike("bodies", picture_of(one, {.samples = 1024}),
               render_text(inside + copies, {.samples = 1024, .seed = 6}));
}

TEST(PeriodicScenes, WhatCantRepeatIsRefused) {
  const auto refused = [](const std::string& world, const std::string& part,
                          const PeriodicSides& sides = {.axes = {true, true, false}}) {
    try {
      build_periodic(world, sides);
      ADD_FAILURE() << part;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const std::string fog = absorber("m0", 1);
  const std::string box = fog + medium_box("m0", Vec3d(0), Vec3d(1));
  refused(box + "LightSource \"point\"\n", "stands in the scene");
  refused(box + R"(AttributeBegin AreaLightSource "diffuse" Shape "sphere" "float radius" 0.1 )"
                "AttributeEnd\n",
          "stands in the scene");
  refused(
      box +
          R"(LightSource "infinite" "rgb L" [ 1 1 1 ] "point3 portal" [ 0 0 2 1 0 2 1 1 2 0 1 2 ])"
          "\n",
      "has a portal");
  refused(kWhiteSky + fog + Body{0, true, Vec3d(0), Vec3d(1)}.text(), "to the sides of the domain");
  PeriodicSides far{.axes = {true, true, false}};
  far.extents = Box3d(Vec3d(-2), Vec3d(2));
  refused(kWhiteSky + fog + Body{0, true, Vec3d(0), Vec3d(1)}.text(), "beside the domain", far);
  far.extents = Box3d(Vec3d(0), Vec3d(1.9, 2, 1));
  refused(kWhiteSky + grid_of({Vec3i(4), 0.5, [](const Vec3i&) { return 1.0F; }},
                              R"("uniformgrid" )", "float density"),
          "beyond the domain", far);
}

}  // namespace
}  // namespace freepath::testing
