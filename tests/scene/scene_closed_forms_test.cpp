// Media of scenes against closed forms: what they absorb, emit and scatter once.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/linear_spectrum.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/rgb_spectrum.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// Parallel rays along z through the middle of what lies around the origin.
std::string along_z(const std::string& world, const std::string& settings = kUnlimited) {
  return settings + film() +
         "LookAt 0 0 -9  0 0 0  0 1 0\n"
         "Camera \"orthographic\" \"float screenwindow\" [ -.001 .001 -.001 .001 ]\nWorldBegin\n" +
         world;
}

/// A medium in a box that the rays cross over a length of 1.6.
constexpr double kLength = 1.6;
std::string box_of(const std::string& parameters) {
  return R"(MakeNamedMedium "m" "string type" "homogeneous" )" + parameters + "\n" +
         medium_box("m", Vec3d(-1, -1, -0.7), Vec3d(1, 1, -0.7 + kLength));
}

const std::string kWhiteLight = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";

const RgbColorSpace& space() { return rgb_color_space("srgb"); }

/// R, G, B of a spectrum.
std::array<double, 3> rgb_of(const std::function<double(double)>& spectrum) {
  const Vec3d rgb = space().from_xyz(observe(spectrum));
  return {rgb.x, rgb.y, rgb.z};
}

/// What is left of white light behind the box.
std::array<double, 3> white_behind(const std::function<double(double)>& sigma) {
  const RgbSpectrum white = RgbSpectrum::illuminant(Vec3d(1), space());
  return rgb_of([&](double wavelength) {
    return white(wavelength) * std::exp(-sigma(wavelength) * kLength);
  });
}

TEST(SceneClosedForm, GreyAbsorptionLeavesTheTransmittance) {
  const std::string scene =
      along_z(kWhiteLight + box_of(R"("rgb sigma_a" [ .2 .2 .2 ] "rgb sigma_s" [ 0 0 0 ] )"
                                   R"("float scale" 2.5)"));
  const double expected = std::exp(-0.5 * kLength);
  for (const ColorMode mode : kColorModes) {
    expect_mean(name_of(mode), render_text(scene, {.mode = mode, .samples = 1024}),
                {expected, expected, expected});
  }
}

// Between the centre of an outer voxel and the face of the box a grid fades to half its value, as
// in pbrt: three voxels of a length of 1.6 hold 1.6 - 2 · 1/4 · (1.6 / 6) of it.
TEST(SceneClosedForm, UniformGridFadesTowardsItsFaces) {
  const std::string scene = along_z(
      kWhiteLight +
      R"(MakeNamedMedium "m" "string type" "uniformgrid" "rgb sigma_a" [ .5 .5 .5 ] )"
      R"("rgb sigma_s" [ 0 0 0 ] "integer nx" 2 "integer nz" 3 )"
      "\"float density\" [ 1 1 1 1 1 1 ] \"point3 p0\" [ -1 -1 -.7 ] \"point3 p1\" [ 1 1 .9 ]\n" +
      medium_box("m", Vec3d(-2), Vec3d(2)));
  const double expected = std::exp(-0.5 * (kLength - kLength / 12));
  expect_mean("grid", render_text(scene, {.samples = 2048}), {expected, expected, expected});
}

TEST(SceneClosedForm, ColouredAbsorption) {
  const Vec3d sigma(0.2, 0.5, 0.9);
  const std::string scene =
      along_z(kWhiteLight + box_of(R"("rgb sigma_a" [ .2 .5 .9 ] "rgb sigma_s" [ 0 0 0 ])"));
  expect_mean(
      "rgb", render_text(scene, {.samples = 1024}),
      {std::exp(-sigma.x * kLength), std::exp(-sigma.y * kLength), std::exp(-sigma.z * kLength)},
      {.largest_relative_error = 0.005});
  expect_mean("spectral", render_text(scene, {.mode = ColorMode::kSpectral, .samples = 2048}),
              white_behind(RgbSpectrum::unbounded(sigma, space())),
              {.largest_relative_error = 0.005});
}

TEST(SceneClosedForm, AbsorptionBySamplesOfWavelengths) {
  const std::string scene =
      along_z(kWhiteLight + box_of(R"("spectrum sigma_a" [ 360 .1  550 .9  830 .3 ] )"
                                   R"("rgb sigma_s" [ 0 0 0 ])"));
  const LinearSpectrum sigma({360, 550, 830}, {0.1, 0.9, 0.3}, OutsideSamples::kZero);
  expect_mean("spectral", render_text(scene, {.mode = ColorMode::kSpectral, .samples = 2048}),
              white_behind(sigma), {.largest_relative_error = 0.005});
}

TEST(SceneClosedForm, EmissionOfASlab) {
  const std::string scene = along_z(box_of(R"("rgb sigma_a" [ .5 .5 .5 ] "rgb sigma_s" [ 0 0 0 ] )"
                                           R"("rgb Le" [ 1 2 .5 ] "float Lescale" 3)"));
  const double form = 3 * (1 - std::exp(-0.5 * kLength));
  for (const ColorMode mode : kColorModes) {
    expect_mean(name_of(mode), render_text(scene, {.mode = mode, .samples = 2048}),
                {form, 2 * form, 0.5 * form}, {.absolute = 1e-3 * form});
  }
}

// A black body of 2000 K, whose spectrum has a maximum of 1. Films do not divide by the integral of
// the luminous efficiency.
TEST(SceneClosedForm, EmissionByTemperature) {
  const std::string scene =
      along_z(R"(MakeNamedMedium "m" "string type" "uniformgrid" "rgb sigma_a" [ .5 .5 .5 ] )"
              R"("rgb sigma_s" [ 0 0 0 ] "float density" [ 1 1 1 ] "float temperature" [ 2 2 2 ] )"
              R"("float temperaturescale" 1000 "integer nz" 3 )"
              "\"point3 p0\" [ -1 -1 -1.2 ] \"point3 p1\" [ 1 1 1.2 ]\n" +
              // From centre to centre of the outer voxels.
              medium_box("m", Vec3d(-2, -2, -0.5 * kLength), Vec3d(2, 2, 0.5 * kLength)));
  const BlackbodySpectrum body(2000, BlackbodyScale::kPeak);
  const double scale = kLuminousIntegral * (1 - std::exp(-0.5 * kLength));
  const auto expected = rgb_of([&](double wavelength) { return scale * body(wavelength); });
  for (const ColorMode mode : kColorModes) {
    // Of the blue nearly nothing is left, and it may be negative.
    expect_mean(name_of(mode), render_text(scene, {.mode = mode, .samples = 2048}), expected,
                {.absolute = 2e-3 * expected[0]});
  }
}

/// Radiance scattered once, from a point light in the medium at (x, 0, 0), into a ray along -z that
/// enters at -1 and leaves at 1.
double scattered_once(double sigma_s, double sigma_t, double g, double intensity, double x) {
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = -1 + 2.0 * i / kSteps;
    const double distance = std::hypot(x, z);
    // Light travels from the lamp to (0, 0, z), and then to the camera, along -z.
    const double cosine = -z / distance;
    const double phase =
        (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    const double value = std::exp(-sigma_t * (z + 1 + distance)) * phase / (distance * distance);
    sum += value * (i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2));
  }
  return sum * (2.0 / kSteps) / 3 * sigma_s * intensity;
}

TEST(SceneClosedForm, LightOfAPointScatteredOnce) {
  for (const double g : {0.0, 0.6}) {
    const std::string scene = along_z(
        "LightSource \"point\" \"rgb I\" [ 5 5 5 ] \"point3 from\" [ .7 0 0 ]\n"
        R"(MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ .1 .1 .1 ] )"
        R"("rgb sigma_s" [ .3 .3 .3 ] "float g" )" +
            std::to_string(g) + "\n" + medium_box("m", Vec3d(-1), Vec3d(1)),
        "Integrator \"volpath\" \"integer maxdepth\" 1\n");
    const double expected = scattered_once(0.3, 0.4, g, 5, 0.7);
    // Sharp enough for an error of a percent in what a medium scatters or a light gives.
    expect_mean("rgb", render_text(scene, {.samples = 4096}), {expected, expected, expected},
                {.largest_relative_error = 0.0017});
    expect_mean("spectral", render_text(scene, {.mode = ColorMode::kSpectral, .samples = 1024}),
                {expected, expected, expected}, {.largest_relative_error = 0.005});
  }
}

// Fog without an end lets light through that comes from twice the scene's radius, as in pbrt.
TEST(SceneClosedForm, ParallelLightInFogWithoutAnEnd) {
  const double diagonal = std::hypot(6, 8);
  for (const ColorMode mode : {ColorMode::kRgb, ColorMode::kSpectral}) {
    const Picture picture =
        render_text(kUnlimited + film(8) + R"(LookAt 0 2 0  0 0 0  0 0 1 MediumInterface "" "fog"
        Camera "perspective" "float fov" 1 WorldBegin
        MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .1 .1 .1 ]
        "rgb sigma_s" [ 0 0 0 ] MediumInterface "" "fog"
        LightSource "distant" "rgb L" [ 3 3 3 ] "point3 from" [ 0 1 0 ] "point3 to" [ 0 0 0 ]
        Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
        Shape "bilinearmesh" "point3 P" [ -3 0 -4  3 0 -4  -3 0 4  3 0 4 ])",
                    {.mode = mode, .samples = 256});
    const double expected = 0.5 / std::numbers::pi * 3 * std::exp(-0.1 * (diagonal + 2));
    expect_mean("fog", picture, {expected, expected, expected}, {.largest_relative_error = 0.01});
  }
}

// The least extinction is all there is: what it lets through is known, unless an estimator is
// named, and trackers with a control decide without a look-up.
TEST(SceneClosedForm, HomogeneousMediaAreKnownWithoutLookUps) {
  const auto render = [](const std::string& method, bool chooses) {
    Diagnostics diagnostics;
    const BuiltScene built = build_scene(
        parse("Integrator \"volpath\" " + method + "\n" + film(8) +
                  R"(LookAt 0 0 -4  0 0 0  0 1 0 Camera "perspective" "float fov" 30 WorldBegin
                  LightSource "distant" "rgb L" [ 3 3 3 ] "point3 from" [ 0 1 -.5 ]
                  MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ .2 .3 .4 ]
                  "rgb sigma_s" [ 4 4 4 ] AttributeBegin Material "interface"
                  MediumInterface "m" "" Shape "sphere" AttributeEnd)",
              diagnostics),
        diagnostics);
    RenderSettings settings = settings_of(built, {.samples = 32});
    settings.chooses_transmittance = chooses;
    return render_scene(built.scene, ColorMode::kRgb, settings);
  };
  const RenderResult chosen = render("", true);
  EXPECT_GT(chosen.counts.shadow_rays.rays, 1000U);
  EXPECT_EQ(chosen.counts.shadow_rays.tentative_collisions, 0U);
  EXPECT_GT(render("", false).counts.shadow_rays.tentative_collisions, 0U) << "of ratio tracking";
  const WalkStatistics flights =
      render(R"("string tracker" "decomposition")", true).counts.free_paths;
  EXPECT_GT(flights.real_collisions, 1000U);
  EXPECT_EQ(flights.lookups, 0U);
}

}  // namespace
}  // namespace freepath::testing
