// Every phase function of a medium, seen in light that is scattered once, against its formula.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {
constexpr double kSigmaS = 4.5;
constexpr double kSigmaT = 5;
constexpr double kHalfWidth = 0.004;
constexpr double kIrradiance = 40;

/// How much of the light is scattered into a direction of this angle to its own [1/sr].
using Phase = std::function<double(double cosine)>;

double henyey_greenstein(double g, double cosine) {
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// [Draine03], as its author writes it.
double draine(double g, double alpha, double cosine) {
  return henyey_greenstein(g, cosine) * (1 + alpha * cosine * cosine) /
         (1 + alpha * (1 + 2 * g * g) / 3);
}

/// The fit of [Jendersie23] for diameters from 5 to 50 micrometres.
double droplets(double d, double cosine) {
  const double g_hg = std::exp(-0.0990567 / (d - 1.67154));
  const double g_d = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
  const double alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825));
  const double weight = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
  return (1 - weight) * henyey_greenstein(g_hg, cosine) + weight * draine(g_d, alpha, cosine);
}

/// A thin column from z = 0 to 1, seen along its middle. Light of one direction falls in.
/// @param cosine of the angle by which the light is turned when it comes to the camera
std::string lit_column(const std::string& phase, double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return "Integrator \"volpath\" \"integer maxdepth\" 1\n" + film(8) +
         "LookAt 0 0 -9  0 0 0  0 1 0\n"
         "Camera \"orthographic\" \"float screenwindow\" [ -1e-4 1e-4 -1e-4 1e-4 ]\nWorldBegin\n" +
         fmt::format(R"(LightSource "distant" "rgb L" [ {0} {0} {0} ] "point3 to" [ {1} 0 {2} ])",
                     kIrradiance, sine, -cosine) +
         fmt::format(R"(MakeNamedMedium "m" "string type" "homogeneous" {0} )"
                     "\"rgb sigma_a\" [ {1} {1} {1} ] \"rgb sigma_s\" [ {2} {2} {2} ]\n",
                     phase, kSigmaT - kSigmaS, kSigmaS) +
         medium_box("m", Vec3d(-kHalfWidth, -kHalfWidth, 0), Vec3d(kHalfWidth, kHalfWidth, 1));
}

/// The phase function times E ∫ σ_s e^(-σ_t (z + way in)) dz over the column.
double scattered_once(const Phase& phase, double cosine) {
  constexpr int kSteps = 20'000;
  const double across = kHalfWidth / std::sqrt(1 - cosine * cosine);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = (i + 0.5) / kSteps;
    // Light that is turned back comes from the side of the camera, and else from the other.
    const double along = (cosine < 0 ? z : 1 - z) / std::abs(cosine);
    sum += std::exp(-kSigmaT * (z + std::min(across, along)));
  }
  return kIrradiance * kSigmaS * phase(cosine) * sum / kSteps;
}

void expect_phase(const std::string& words, const Phase& phase) {
  for (const double cosine : {-0.95, -0.4, 0.2, 0.7, 0.97}) {
    const double expected = scattered_once(phase, cosine);
    for (const ColorMode mode : kColorModes) {
      const uint32_t samples = mode == ColorMode::kRgb ? 384 : 512;
      expect_mean(fmt::format("{} at {} {}", words, cosine, name_of(mode)),
                  render_text(lit_column(words, cosine), {.mode = mode, .samples = samples}),
                  {expected, expected, expected},
                  {.absolute = 2e-4 * expected, .largest_relative_error = 0.002});
    }
  }
}

TEST(ScenePhaseFunction, Isotropic) {
  const auto phase = [](double) { return 1 / (4 * std::numbers::pi); };
  expect_phase("", phase);
  expect_phase(R"("string phase" "isotropic")", phase);
}

TEST(ScenePhaseFunction, HenyeyGreenstein) {
  expect_phase("\"float g\" 0.7", [](double c) { return henyey_greenstein(0.7, c); });
  expect_phase(R"("string phase" "henyey-greenstein:g=-0.4")",
               [](double c) { return henyey_greenstein(-0.4, c); });
}

TEST(ScenePhaseFunction, Rayleigh) {
  expect_phase(R"("string phase" "rayleigh")",
               [](double c) { return 3 * (1 + c * c) / (16 * std::numbers::pi); });
}

TEST(ScenePhaseFunction, Draine) {
  expect_phase(R"("string phase" "draine:g=0.5,alpha=2")",
               [](double c) { return draine(0.5, 2, c); });
}

TEST(ScenePhaseFunction, DropletsOfFog) {
  expect_phase(R"("string phase" "droplets:diameter=20")",
               [](double c) { return droplets(20, c); });
}

TEST(ScenePhaseFunction, Mixture) {
  expect_phase(R"("string phase" "0.7*henyey-greenstein:g=0.8+0.3*rayleigh")", [](double c) {
    return 0.7 * henyey_greenstein(0.8, c) + 0.3 * 3 * (1 + c * c) / (16 * std::numbers::pi);
  });
}

// Linear in the cosine between 180, 90 and 0 degrees, with values 2, 1, 5: the integral over the
// sphere is 2 pi ((2 + 1) / 2 + (1 + 5) / 2).
TEST(ScenePhaseFunction, Table) {
  const TemporaryFile table("phase.txt");
  std::ofstream(table.path()) << "0 5\n90 1\n180 2\n";
  expect_phase(R"("string phase" "tabulated:)" + table.path().string() + "\"",
               [](double c) { return (c < 0 ? 1 - c : 1 + 4 * c) / (2 * std::numbers::pi * 4.5); });
}

// An error of one percent in the phase function must fail these tests.
TEST(ScenePhaseFunction, AnErrorOfOnePercentIsNoticed) {
  const double expected =
      1.01 * scattered_once([](double) { return 1 / (4 * std::numbers::pi); }, 0.6);
  const Picture picture = render_text(lit_column("", 0.6), {.samples = 512});
  EXPECT_LT(z_score(picture.mean[1], picture.error[1], expected), -4);
}

}  // namespace
}  // namespace freepath::testing
