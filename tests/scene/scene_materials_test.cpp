// Every material, as it is seen in light from everywhere or from one direction, against the form
// that its formula has there.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "freepath/spectra/cie_observer.h"
#include "freepath/spectra/named_spectra.h"
#include "freepath/spectra/rgb_color_space.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {
/// Between the ray of the camera and the normal.
constexpr double kAngle = 55 * std::numbers::pi / 180;

std::array<double, 3> grey(double value) { return {value, value, value}; }

/// A plane of a material, z = 0, whose u is x and v is y, seen at one point at kAngle from +x.
std::string plane_of(const std::string& material, const std::string& light) {
  return kUnlimited + film() +
         fmt::format("LookAt {} 0 {}  0 0 0  0 1 0\n", 3 * std::sin(kAngle), 3 * std::cos(kAngle)) +
         "Camera \"orthographic\" \"float screenwindow\" [ -1e-4 1e-4 -1e-4 1e-4 ]\nWorldBegin\n" +
         light + material +
         "\nShape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]\n";
}

const std::string kSky = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";
/// Parallel light of irradiance 1, that comes from (-0.5, 0.3, 1).
const std::string kSun =
    "LightSource \"distant\" \"rgb L\" [ 1 1 1 ] \"point3 from\" [ -.5 .3 1 ] "
    "\"point3 to\" [ 0 0 0 ]\n";
const Vec3d kToSun = Vec3d(-0.5, 0.3, 1).normalized();
const Vec3d kToCamera(std::sin(kAngle), 0, std::cos(kAngle));

/// The scene has this radiance, in both modes.
void expect_radiance(const std::string& name, const std::string& scene, double expected,
                     uint32_t samples = 64) {
  for (const ColorMode mode : kColorModes) {
    // Wavelengths are a quadrature of as many points as there are samples.
    const bool spectral = mode == ColorMode::kSpectral;
    const PictureOptions options{.mode = mode,
                                 .samples = spectral ? std::max(samples, 512U) : samples};
    expect_mean(name + " " + name_of(mode), render_text(scene, options), grey(expected),
                {.absolute = 1e-4 * expected, .largest_relative_error = 0.0025});
  }
}

/// What an interface between vacuum and a complex index reflects of unpolarised light.
/// @param eta index behind over that before the interface
double fresnel(std::complex<double> eta, double cosine) {
  const std::complex<double> inside =
      std::sqrt(1.0 - (1 - cosine * cosine) / (eta * eta));  // its cosine
  const double parallel = std::norm((eta * cosine - inside) / (eta * cosine + inside));
  const double across = std::norm((cosine - eta * inside) / (cosine + eta * inside));
  return (parallel + across) / 2;
}

double fresnel_here(std::complex<double> eta) { return fresnel(eta, std::cos(kAngle)); }

TEST(SceneMaterial, DiffuseReflectsItsPartOfTheSky) {
  const std::string material = R"(Material "diffuse" "rgb reflectance" [ .8 .5 .2 ])";
  expect_mean("rgb", render_text(plane_of(material, kSky), {.samples = 512}), {0.8, 0.5, 0.2},
              {.absolute = 1e-6, .largest_relative_error = 0.0025});
  expect_mean(
      "spectral",
      render_text(plane_of(material, kSky), {.mode = ColorMode::kSpectral, .samples = 1024}),
      {0.8, 0.5, 0.2}, {.absolute = 2e-4, .largest_relative_error = 0.0025});
  expect_radiance("sun", plane_of(R"(Material "diffuse" "rgb reflectance" [ .4 .4 .4 ])", kSun),
                  0.4 / std::numbers::pi * kToSun.z);
}

// Of a sky it reflects and lets through; of the sun, which shines on the other side, it lets
// through.
TEST(SceneMaterial, PaperScattersToBothSides) {
  const std::string paper = R"(Material "diffusetransmission" "rgb reflectance" [ .5 .5 .5 ] )"
                            R"("rgb transmittance" [ .25 .25 .25 ] "float scale" .8)";
  expect_radiance("sky", plane_of(paper, kSky), 0.8 * 0.75, 1024);
  expect_radiance("sun", plane_of(paper, kSun), 0.8 * 0.5 / std::numbers::pi * kToSun.z);
  const std::string behind =
      "LightSource \"distant\" \"rgb L\" [ 1 1 1 ] \"point3 from\" [ -.5 .3 -1 ] "
      "\"point3 to\" [ 0 0 0 ]\n";
  expect_radiance("sun behind", plane_of(paper, behind), 0.8 * 0.25 / std::numbers::pi * kToSun.z);
}

TEST(SceneMaterial, SmoothConductorReflectsByFresnel) {
  const auto metal = [](const std::string& parameters) {
    return plane_of("Material \"conductor\" " + parameters, kSky);
  };
  expect_radiance("index",
                  metal(R"("spectrum eta" [ 300 .7 900 .7 ] "spectrum k" [ 300 2 900 2 ])"),
                  fresnel_here({0.7, 2}));
  // A reflectance is that of an index of 1 seen from above.
  expect_radiance("reflectance", metal(R"("rgb reflectance" [ .6 .6 .6 ])"),
                  fresnel_here({1, 2 * std::sqrt(0.6 / 0.4)}));
}

TEST(SceneMaterial, GoldIsSeenInTheColourOfItsSpectrum) {
  const LinearSpectrum eta = named_spectrum("metal-Au-eta");
  const LinearSpectrum k = named_spectrum("metal-Au-k");
  const RgbColorSpace& space = rgb_color_space("srgb");
  const Vec3d expected = space.from_xyz(observe([&](double wavelength) {
    return fresnel_here({eta(wavelength), k(wavelength)}) * space.illuminant()(wavelength);
  }));
  const std::string scene = plane_of(
      R"(Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k")", kSky);
  expect_mean("gold", render_text(scene, {.mode = ColorMode::kSpectral, .samples = 4096}),
              {expected.x, expected.y, expected.z},
              {.absolute = 5e-4, .largest_relative_error = 0.0025});
}

/// Facets of [Walter07] with the height-correlated shadowing of [Heitz14].
double facets(double alpha_x, double alpha_y, std::complex<double> eta) {
  const Vec3d half = (kToSun + kToCamera).normalized();
  const auto squared = [](double x) { return x * x; };
  const double slope = squared(half.x / alpha_x) + squared(half.y / alpha_y) + squared(half.z);
  const double density = 1 / (std::numbers::pi * alpha_x * alpha_y * slope * slope);
  const auto lambda = [&](const Vec3d& w) {
    const double a2 = (squared(alpha_x * w.x) + squared(alpha_y * w.y)) / squared(w.z);
    return (std::sqrt(1 + a2) - 1) / 2;
  };
  const double shadowing = 1 / (1 + lambda(kToSun) + lambda(kToCamera));
  return density * shadowing * fresnel(eta, half.dot(kToSun)) / (4 * kToCamera.z);
}

TEST(SceneMaterial, RoughConductorReflectsTheSunByItsFacets) {
  const std::string copperless =
      R"(Material "conductor" "spectrum eta" [ 300 .7 900 .7 ] "spectrum k" [ 300 2 900 2 ] )";
  expect_radiance("alphas",
                  plane_of(copperless + R"("float uroughness" .2 "float vroughness" .5 )"
                                        R"("bool remaproughness" false)",
                           kSun),
                  facets(0.2, 0.5, {0.7, 2}));
  expect_radiance("remapped", plane_of(copperless + R"("float roughness" .09)", kSun),
                  facets(0.3, 0.3, {0.7, 2}));
}

TEST(SceneMaterial, RoughDielectricReflectsTheSunByItsFacets) {
  expect_radiance("glass",
                  plane_of(R"(Material "dielectric" "float eta" 1.5 "float roughness" .3 )"
                           R"("bool remaproughness" false)",
                           kSun),
                  facets(0.3, 0.3, 1.5), 512);
}

/// Light below, whose own surface is black, and nothing above.
const std::string kGround =
    R"(AttributeBegin Translate 0 0 -5 AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] )"
    R"(Material "diffuse" "rgb reflectance" [ 0 0 0 ] Shape "disk" "float radius" 60 )"
    "AttributeEnd\n";

// Of what comes from below, R (1 + T² (1 + R² + ...)) is reflected and the rest comes through.
TEST(SceneMaterial, PlateOfGlassAndThinGlassLetTheSameThrough) {
  const double reflected = fresnel_here(1.5);
  const double expected = (1 - reflected) / (1 + reflected);
  expect_radiance("thin", plane_of("Material \"thindielectric\"", kGround), expected, 1024);
  const std::string below =
      R"(AttributeBegin Material "dielectric" ReverseOrientation Translate 0 0 -.1 )"
      "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ] AttributeEnd\n";
  expect_radiance("plate", plane_of("Material \"dielectric\"", kGround + below), expected, 1024);
}

/// Mean of Fresnel's reflectance over a diffuse light: 2 ∫ F(c) c dc.
double diffuse_fresnel(double eta) {
  constexpr int kSteps = 200'000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    sum += 2 * fresnel(eta, cosine) * cosine / kSteps;
  }
  return sum;
}

// Light that gets into the coating is reflected between it and the base until it leaves.
TEST(SceneMaterial, SmoothlyCoatedDiffuseIsTheSeriesOfItsReflections) {
  const double reflectance = 0.7;
  const double outside = fresnel_here(1.5);
  const double inside = 1 - (1 - diffuse_fresnel(1.5)) / (1.5 * 1.5);
  const double expected =
      outside + (1 - outside) * reflectance * (1 - inside) / (1 - reflectance * inside);
  expect_radiance("coated",
                  plane_of(R"(Material "coateddiffuse" "rgb reflectance" [ .7 .7 .7 ] )"
                           R"("float thickness" 0 "integer maxdepth" 1000)",
                           kSky),
                  expected, 1024);
}

// Between interface and metal is a medium of an extinction of 1, which absorbs unless it is told
// otherwise.
TEST(SceneMaterial, SmoothlyCoatedConductorIsTheSeriesOfItsReflections) {
  const double outside = fresnel_here(1.5);
  const double sine = std::sin(kAngle) / 1.5;
  // The metal is seen from within the coating.
  const std::complex<double> eta = std::complex<double>(0.7, 2) / 1.5;
  const double cosine = std::sqrt(1 - sine * sine);
  const double metal = fresnel(eta, cosine) * std::exp(-2 * 0.05 / cosine);
  const double expected = outside + (1 - outside) * (1 - outside) * metal / (1 - outside * metal);
  expect_radiance(
      "coated",
      plane_of(R"(Material "coatedconductor" "spectrum conductor.eta" [ 300 .7 900 .7 ])"
               R"( "spectrum conductor.k" [ 300 2 900 2 ] "float interface.eta" 1.5 )"
               R"("float conductor.roughness" 0 "float interface.roughness" 0 )"
               R"("float thickness" .05 "integer maxdepth" 1000)",
               kSky),
      expected, 1024);
}

TEST(SceneMaterial, MixIsTheMeanOfItsParts) {
  const std::string parts =
      R"(MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [ .2 .2 .2 ] )"
      R"(MakeNamedMaterial "b" "string type" "conductor" "rgb reflectance" [ .6 .6 .6 ] )";
  const double expected = 0.7 * 0.2 + 0.3 * fresnel_here({1, 2 * std::sqrt(0.6 / 0.4)});
  expect_radiance("mix",
                  plane_of(parts + R"(Material "mix" "string materials" [ "a" "b" ] )"
                                   R"("float amount" .3)",
                           kSky),
                  expected, 1024);
}

// A black sheet, nine tenths of which are holes, close above a grey ground: the ground is seen
// through them, and lit through them, by lights that paths find and by those that only shadow rays
// do.
TEST(SceneMaterial, MixWithAnInterfaceIsASieve) {
  const std::string sieve =
      R"(MakeNamedMaterial "air" "string type" "interface" )"
      R"(MakeNamedMaterial "black" "string type" "diffuse" "rgb reflectance" [ 0 0 0 ] )"
      R"(MakeNamedMaterial "sieve" "string type" "mix" "string materials" [ "black" "air" ] )"
      R"("float amount" .9 )";
  const std::string ground =
      R"(AttributeBegin Translate 0 0 -.1 Material "diffuse" "rgb reflectance" [ .5 .5 .5 ] )"
      R"(Shape "bilinearmesh" "point3 P" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ] AttributeEnd )";
  const auto seen = [&](const std::string& light, const std::string& behind) {
    std::string scene = plane_of(sieve + behind + R"(NamedMaterial "sieve")", light);
    // Holes are places, of which a point of view has few.
    const std::string narrow = "-1e-4 1e-4 -1e-4 1e-4";
    return scene.replace(scene.find(narrow), narrow.size(), "-.4 .4 -.4 .4");
  };
  expect_radiance("sky", seen(kSky, ground), 0.9 * 0.5 * 0.9, 256);
  expect_radiance("sun", seen(kSun, ground), 0.9 * 0.9 * 0.5 / std::numbers::pi * kToSun.z, 512);
  expect_radiance("light", seen("", kGround), 0.9, 256);
}

TEST(SceneMaterial, InterfaceIsNotSeen) {
  for (const std::string name : {"interface", "none", ""}) {
    expect_radiance(name, plane_of("Material \"" + name + "\"", kGround), 1);
  }
}

}  // namespace
}  // namespace freepath::testing
