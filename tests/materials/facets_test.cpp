// Fresnel's equations against closed forms, and the distribution of facets against what defines it.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "freepath/base/random.h"
#include "freepath/materials/dielectric_interface.h"
#include "freepath/materials/fresnel.h"
#include "freepath/materials/trowbridge_reitz.h"
#include "freepath/spectra/named_spectra.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

TEST(Fresnel, AtNormalIncidenceIsTheSquareOfTheContrast) {
  for (const double eta : {1.5, 1 / 1.5, 1.1, 2.4}) {
    EXPECT_NEAR(fresnel_dielectric(1, static_cast<float>(eta)), std::pow((eta - 1) / (eta + 1), 2),
                1e-6);
  }
}

// At Brewster's angle, tan θ = η, only light of perpendicular polarisation is reflected:
// R = ½ ((1 - η²) / (1 + η²))².
TEST(Fresnel, AtBrewstersAngleHalfOfTheLightIsNotReflected) {
  for (const double eta : {1.5, 1 / 1.5, 2.4}) {
    const double cosine = std::cos(std::atan(eta));
    const double r = (1 - eta * eta) / (1 + eta * eta);
    EXPECT_NEAR(fresnel_dielectric(static_cast<float>(cosine), static_cast<float>(eta)),
                0.5 * r * r, 1e-6);
  }
}

TEST(Fresnel, ReflectsAllBeyondTheCriticalAngleAndAtGrazingIncidence) {
  const double critical = std::sqrt(1 - 1 / 2.25);
  EXPECT_EQ(fresnel_dielectric(static_cast<float>(critical) - 1e-4F, 1 / 1.5F), 1);
  EXPECT_LT(fresnel_dielectric(static_cast<float>(critical) + 1e-3F, 1 / 1.5F), 0.9);
  EXPECT_FALSE(refracted(Vec3f(0.8F, 0, 0.6F), Vec3f(0, 0, 1), 1 / 1.5F));
  EXPECT_NEAR(fresnel_dielectric(0, 1.5F), 1, 1e-6);
  EXPECT_NEAR(fresnel_conductor(0, 0.2F, 3.0F), 1, 1e-6);
}

TEST(Fresnel, IsTheSameFromBothSides) {
  const Vec3f out(0.6F, 0, 0.8F);
  const auto in = refracted(out, Vec3f(0, 0, 1), 1.5F);
  ASSERT_TRUE(in);
  EXPECT_NEAR(in->x, -0.4, 1e-6);  // Snell's law
  EXPECT_NEAR(fresnel_dielectric(0.8F, 1.5F), fresnel_dielectric(-in->z, 1 / 1.5F), 1e-6);
}

TEST(Fresnel, OfAConductorThatDoesNotAbsorbIsThatOfADielectric) {
  for (const float cosine : {1.0F, 0.7F, 0.3F, 0.05F}) {
    EXPECT_NEAR(fresnel_conductor(cosine, 1.5F, 0), fresnel_dielectric(cosine, 1.5F), 1e-6);
  }
}

// |(n - 1 + ik) / (n + 1 + ik)|² for the gold of [Johnson72], n = 0.42, k = 2.35 near 550 nm: 0.77.
TEST(Fresnel, OfGoldAt550Nanometres) {
  const double n = named_spectrum("metal-Au-eta")(550);
  const double k = named_spectrum("metal-Au-k")(550);
  const float found = fresnel_conductor(1, static_cast<float>(n), static_cast<float>(k));
  EXPECT_NEAR(found, ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), 1e-6);
  EXPECT_NEAR(found, 0.77, 0.03);
}

TEST(Fresnel, OfAMetalIsTheComplexForm) {
  for (const auto& [n, k] : {std::pair{0.2, 3.0}, {2.5, 0.4}, {0.02, 0.1}, {1.0, 0.0}}) {
    for (const double cosine : {1.0, 0.5, 0.01}) {
      const std::complex<double> index(n, k);
      const std::complex<double> below = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
      const double parallel = std::norm((index * cosine - below) / (index * cosine + below));
      const double perpendicular = std::norm((cosine - index * below) / (cosine + index * below));
      EXPECT_NEAR(fresnel_conductor(static_cast<float>(cosine), static_cast<float>(n),
                                    static_cast<float>(k)),
                  0.5 * (parallel + perpendicular), 2e-6)
          << n << " " << k << " " << cosine;
    }
  }
}

/// The integral over the upper hemisphere, with nodes even in tan θ / (1 + tan θ), which resolves
/// narrow peaks.
template <class Function>
double integral(const Function& function, double narrow) {
  constexpr int kNodes = 1200;
  constexpr int kAzimuths = 180;
  double sum = 0;
  for (int i = 0; i < kNodes; ++i) {
    const double s = (i + 0.5) / kNodes;
    const double tangent = narrow * s / (1 - s);
    const double cosine = 1 / std::sqrt(1 + tangent * tangent);
    const double slope = narrow / ((1 - s) * (1 - s)) * cosine * cosine;  // dθ / ds
    const double sine = tangent * cosine;
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = 2 * std::numbers::pi * (j + 0.5) / kAzimuths;
      sum +=
          slope * sine *
          function(Vec3f(static_cast<float>(sine * std::cos(azimuth)),
                         static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(cosine)));
    }
  }
  return sum * 2 * std::numbers::pi / (static_cast<double>(kNodes) * kAzimuths);
}

TEST(TrowbridgeReitz, FacetsCoverTheSurfaceOnce) {
  for (const auto& [x, y] : {std::pair{0.01F, 0.01F}, {0.1F, 0.4F}, {1.0F, 1.0F}}) {
    const TrowbridgeReitz facets(x, y);
    EXPECT_NEAR(integral([&](const Vec3f& m) { return facets.density(m) * m.z; }, x), 1, 1e-3);
  }
}

// Facets seen from a direction cover what the surface covers [Heitz14, Eq. 14].
TEST(TrowbridgeReitz, VisibleFacetsCoverTheSurfaceAsItIsSeen) {
  for (const auto& [x, y] : {std::pair{0.1F, 0.1F}, {0.1F, 0.4F}, {1.0F, 1.0F}}) {
    const TrowbridgeReitz facets(x, y);
    for (const Vec3f& direction :
         {Vec3f(0, 0, 1), Vec3f(0.6F, 0, 0.8F), Vec3f(0.3F, 0.9F, 0.2F).normalized()}) {
      EXPECT_NEAR(integral([&](const Vec3f& m) { return facets.visible_density(direction, m); }, x),
                  1, 2e-3);
    }
  }
}

TEST(TrowbridgeReitz, DrawsVisibleFacets) {
  const TrowbridgeReitz facets(0.2F, 0.6F);
  const Vec3f direction = Vec3f(0.7F, 0.5F, 0.3F).normalized();
  RandomStream random(1, 0, 0, 0);
  RunningStatistics x, height;
  for (int i = 0; i < 200'000; ++i) {
    const float u0 = random.uniform();
    const Vec3f facet = facets.sample_visible(direction, u0, random.uniform());
    x.add(facet.x);
    height.add(facet.z);
  }
  const auto mean = [&](auto&& coordinate) {
    return integral(
        [&](const Vec3f& m) { return coordinate(m) * facets.visible_density(direction, m); }, 0.2);
  };
  EXPECT_TRUE(check_mean("x", x, mean([](const Vec3f& m) { return m.x; }), {4, 1e-4}));
  EXPECT_TRUE(check_mean("z", height, mean([](const Vec3f& m) { return m.z; }), {4, 1e-4}));
}

TEST(TrowbridgeReitz, IsSmoothBelowAThousandth) {
  EXPECT_TRUE(TrowbridgeReitz(0, 0.9e-3F).is_smooth());
  EXPECT_FALSE(TrowbridgeReitz(0, 1e-3F).is_smooth());
  EXPECT_GT(TrowbridgeReitz(0, 0.1F).alpha_x(), 0);
  EXPECT_NEAR(TrowbridgeReitz::alpha_of_roughness(0.25F), 0.5, 1e-7);
}

// What two modes of transport draw and what they are worth: the densities of Walter's refraction
// integrate to the share that is drawn.
TEST(DielectricInterface, TransmissionAloneIsWeightedByItsShare) {
  const DielectricInterface interface(1.5F, TrowbridgeReitz(0.3F, 0.3F));
  const Vec3f out = Vec3f(0.3F, 0, 0.9F).normalized();
  RandomStream random(1, 0, 0, 0);
  RunningStatistics all, alone, importance;
  for (int i = 0; i < 100'000; ++i) {
    const auto any = interface.sample(out, random);
    all.add(any && any->transmitted ? any->weight : 0);
    const auto only = interface.sample(out, random, InterfaceEvents::kTransmission);
    alone.add(only ? only->weight : 0);
    if (only) {
      const InterfaceValue found =
          interface.evaluate(out, only->direction, InterfaceEvents::kTransmission);
      ASSERT_NEAR(found.value, only->weight * only->pdf, 2e-3 * found.value);
      ASSERT_NEAR(found.pdf, only->pdf, 2e-3 * found.pdf);
    }
    const auto adjoint =
        interface.sample(out, random, InterfaceEvents::kTransmission, TransportMode::kImportance);
    importance.add(adjoint ? adjoint->weight : 0);
  }
  EXPECT_TRUE(check_mean("all events", all, alone.mean(), {4, 4 * alone.standard_error()}));
  EXPECT_TRUE(check_mean("importance", importance, alone.mean() * 2.25,
                         {4, 4 * 2.25 * alone.standard_error()}));
}

}  // namespace
}  // namespace freepath::testing
