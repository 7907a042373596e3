// The laboratory's settings and exact curves against closed forms and an independent quadrature.

#include "freepath/study/lab_settings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "freepath/base/error.h"
#include "freepath/study/lab_curves.h"

namespace freepath::testing {
namespace {

/// Densities are single precision.
constexpr double kRounding = 2e-6;

/// Optical depth and scattering by the midpoint rule with steps of a fraction of a voxel, which no
/// step straddles.
struct Quadrature {
  double depth = 0;
  double scattered = 0;
  double radiance = 0;
};

Quadrature integrate(const LabSetting& setting, const LabCurves& curves, int channel) {
  constexpr int kSteps = kLabVoxels * 400;
  Quadrature result;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps;
    const double step = 1.0 / kSteps;
    const double transmittance = std::exp(-result.depth - 0.5 * curves.sigma_t(x, channel) * step);
    const double scattered = curves.sigma_s(x, channel) * transmittance * step;
    result.scattered += scattered;
    result.radiance += scattered * setting.scattered(x, channel);
    result.depth += curves.sigma_t(x, channel) * step;
  }
  result.radiance += std::exp(-result.depth) * setting.background;
  return result;
}

TEST(LabSettings, CurvesAgreeWithAQuadrature) {
  for (const LabSettingInfo& info : lab_setting_infos()) {
    const LabSetting setting = make_lab_setting(info.name);
    const LabCurves curves(setting);
    ASSERT_EQ(curves.channels(), setting.channels);
    for (int channel = 0; channel < setting.channels; ++channel) {
      const Quadrature expected = integrate(setting, curves, channel);
      EXPECT_NEAR(curves.depth(1, channel), expected.depth, 1e-9) << info.name;
      EXPECT_NEAR(curves.scattered(0, 1, channel), expected.scattered, 1e-7) << info.name;
      const double parts = curves.scattered(0, 0.31, channel) + curves.scattered(0.31, 1, channel);
      EXPECT_NEAR(parts, expected.scattered, 1e-7) << info.name;
      if (!setting.medium->emits()) {
        EXPECT_NEAR(curves.radiance(channel), expected.radiance, 1e-7) << info.name;
      }
    }
  }
}

TEST(LabSettings, HomogeneousIsExponential) {
  const LabCurves curves(make_lab_setting("homogeneous"));
  for (const double x : {0.0, 0.1, 0.333, 1.0}) {
    EXPECT_NEAR(curves.transmittance(x, 0), std::exp(-3 * x), kRounding);
  }
  EXPECT_NEAR(curves.scattered(0.2, 0.6, 0), 0.8 * (std::exp(-0.6) - std::exp(-1.8)), kRounding);
}

// sigma_t is 3 · 0.4 up to the seam at 120/256, and 3 · 1.6 beyond.
TEST(LabSettings, TwoBoxesAreTwoExponentials) {
  const LabCurves curves(make_lab_setting("two-boxes"));
  const double seam = 120.0 / 256;
  EXPECT_NEAR(curves.depth(0.25, 0), 1.2 * 0.25, kRounding);
  EXPECT_NEAR(curves.depth(seam, 0), 1.2 * seam, kRounding);
  EXPECT_NEAR(curves.depth(0.9, 0), 1.2 * seam + 4.8 * (0.9 - seam), kRounding);
  const double at_seam = std::exp(-1.2 * seam);
  EXPECT_NEAR(curves.scattered(0, 1, 0), 0.8 * (1 - at_seam * std::exp(-4.8 * (1 - seam))),
              kRounding);
}

// sigma_t = 6 x, so that the depth is 3 x²; voxels hold the mean of a line, and at their faces the
// depth is that of the line.
TEST(LabSettings, RampIsGaussian) {
  const LabCurves curves(make_lab_setting("ramp"));
  for (int face = 0; face <= kLabVoxels; face += 16) {
    const double x = double(face) / kLabVoxels;
    EXPECT_NEAR(curves.depth(x, 0), 3 * x * x, kRounding);
    EXPECT_NEAR(curves.scattered(0, x, 0), 0.8 * (1 - std::exp(-3 * x * x)), kRounding);
  }
}

// Published by quadrature of the functions; voxels are their values at 256 places.
TEST(LabSettings, FixtureAHasItsRadiance) {
  const LabCurves curves(make_lab_setting("fixture-a"));
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(curves.radiance(channel), kFixtureRadiance[channel], 5e-6);
    EXPECT_NEAR(curves.depth(1, channel), kFixtureThickness[channel], 5e-5);
  }
}

TEST(LabSettings, BoundsAreThoseOfTheFunction) {
  for (const LabSettingInfo& info : lab_setting_infos()) {
    const LabSetting setting = make_lab_setting(info.name);
    const LabCurves curves(setting);
    const std::vector<LabBounds> bounds = lab_bounds(setting);
    ASSERT_EQ(bounds.size(), std::size_t{kLabVoxels / kLabCell});
    for (const LabBounds& cell : bounds) {
      for (int channel = 0; channel < setting.channels; ++channel) {
        double low = 1e30;
        double high = 0;
        // Super-voxels see a voxel beyond their faces.
        for (double x = cell.begin - 0.5 / kLabVoxels; x < cell.end + 1.0 / kLabVoxels;
             x += 1.0 / kLabVoxels) {
          low = std::min(low, curves.sigma_t(x, channel));
          high = std::max(high, curves.sigma_t(x, channel));
        }
        // Components have their extremes at different places: bounds of a sum are no tighter.
        EXPECT_LE(cell.minorant[channel], low * (1 + 1e-6)) << info.name;
        EXPECT_GE(cell.majorant[channel], high * (1 - 1e-6)) << info.name;
        if (setting.medium->components().size() > 1) continue;
        EXPECT_NEAR(cell.minorant[channel], low, 1e-5) << info.name << cell.begin;
        EXPECT_NEAR(cell.majorant[channel], high, 1e-5) << info.name << cell.begin;
      }
    }
  }
}

TEST(LabSettings, UnknownNamesAreRefusedWithTheList) {
  try {
    make_lab_setting("three-boxes");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("two-boxes, ramp"), std::string::npos);
  }
}

}  // namespace
}  // namespace freepath::testing
