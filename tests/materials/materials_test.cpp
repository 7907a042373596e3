// What holds for every material: what is drawn, its density, its weight and the value agree.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "freepath/base/error.h"
#include "tests/materials/materials_for_tests.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

constexpr double kAzimuth = 0.7;

const MaterialWorld& world() {
  static const MaterialWorld instance;
  return instance;
}

/// Calls for every material, direction and both kinds of channels.
template <class Check>
void for_every_case(const Check& check) {
  const SurfacePoint point = askew_point();
  for (const NamedMaterial& entry : world().materials()) {
    for (const double cosine : kCosines) {
      for (const bool spectral : {false, true}) {
        SCOPED_TRACE(::testing::Message() << entry.name << ", cosine " << cosine
                                          << (spectral ? ", spectral" : ", R, G, B"));
        check(entry, point, -on_surface(point, cosine, kAzimuth),
              spectral ? world().spectral(2) : world().in_rgb());
      }
    }
  }
}

TEST(EveryMaterial, SamplesAreFiniteUnitAndOnTheSideTheySay) {
  for_every_case([](const NamedMaterial& entry, const SurfacePoint& point, const Vec3f& travel,
                    const SurfaceContext& context) {
    RandomStream random(1, 2, 3, 4);
    for (int i = 0; i < 300; ++i) {
      const auto sample = entry.material.sample(point, travel, random, context);
      if (!sample) continue;
      ASSERT_TRUE(is_finite(sample->weight));
      ASSERT_NEAR(sample->direction.length(), 1, 1e-5);
      ASSERT_EQ(sample->specular, sample->pdf == 0);
      ASSERT_EQ(sample->transmitted,
                point.normal.dot(sample->direction) * point.normal.dot(travel) > 0);
      ASSERT_TRUE(!sample->transmitted || entry.material.transmits());
      ASSERT_TRUE(sample->specular || !entry.material.is_specular());
      if (sample->hero_only) {
        for (int c = 0; c < kMaxChannels; ++c) {
          ASSERT_EQ(sample->weight[c] > 0, c == context.hero);
        }
      }
      for (int c = 0; c < context.spectra.channels(); ++c) ASSERT_GE(sample->weight[c], 0);
    }
  });
}

TEST(EveryMaterial, WeightIsValueOverDensity) {
  for_every_case([](const NamedMaterial& entry, const SurfacePoint& point, const Vec3f& travel,
                    const SurfaceContext& context) {
    RandomStream random(1, 2, 3, 4);
    for (int i = 0; i < 300; ++i) {
      const auto sample = entry.material.sample(point, travel, random, context);
      if (!sample || sample->specular) continue;
      const MaterialValue found =
          entry.material.evaluate(point, travel, sample->direction, random, context);
      // Rounding of half vectors, which the peaks of smooth surfaces magnify.
      ASSERT_NEAR(found.pdf, sample->pdf, 2e-3F * sample->pdf);
      if (!entry.exact_pdf) continue;
      for (int c = 0; c < context.spectra.channels(); ++c) {
        const float expected = sample->weight[c];
        ASSERT_NEAR(found.value[c] / found.pdf, expected, 2e-3F * expected) << "channel " << c;
      }
    }
  });
}

/// The sphere around the normal in bins of equal solid angle.
struct Bins {
  static constexpr int kHeights = 24;
  static constexpr int kAzimuths = 16;
  static constexpr int kCount = kHeights * kAzimuths;

  static int of(const SurfacePoint& point, const Vec3f& direction) {
    const Vec3f x = on_surface(point, 0, 0);
    const Vec3f y = point.normal.cross(x);
    const double turn =
        0.5 + 0.5 * std::numbers::inv_pi * std::atan2(y.dot(direction), x.dot(direction));
    const int height = static_cast<int>((0.5 + 0.5 * point.normal.dot(direction)) * kHeights);
    const int azimuth = static_cast<int>(turn * kAzimuths);
    return std::min(height, kHeights - 1) * kAzimuths + std::min(azimuth, kAzimuths - 1);
  }
  /// The point at the given place of a bin, 0 to 1 both ways.
  static Vec3f direction(const SurfacePoint& point, int bin, double up, double around) {
    const double cosine = 2 * ((bin / kAzimuths + up) / kHeights) - 1;
    const double turn = (bin % kAzimuths + around) / kAzimuths;
    return on_surface(point, cosine, (2 * turn - 1) * std::numbers::pi);
  }
};

/// Share of samples that is expected in each bin, by quadrature of the density.
std::vector<double> expected_shares(const Material& material, const SurfacePoint& point,
                                    const Vec3f& travel, const SurfaceContext& context) {
  constexpr int kNodes = 20;
  RandomStream unused(0, 0, 0, 0);
  std::vector<double> shares(Bins::kCount);
  for (int bin = 0; bin < Bins::kCount; ++bin) {
    for (int node = 0; node < kNodes * kNodes; ++node) {
      const Vec3f next = Bins::direction(point, bin, (node / kNodes + 0.5) / kNodes,
                                         (node % kNodes + 0.5) / kNodes);
      shares[bin] += material.evaluate(point, travel, next, unused, context).pdf;
    }
    shares[bin] *= 4 * std::numbers::pi / Bins::kCount / (kNodes * kNodes);
  }
  return shares;
}

/// What is expected and counted of a number of samples. Bins that expect few are one, since a
/// quadrature may miss the corner of a bin that a lobe's edge cuts off; paths that end are the
/// last, unless so few do that the quadrature's error counts.
ChiSquare compared(const NamedMaterial& entry, const SurfacePoint& point, const Vec3f& travel,
                   const SurfaceContext& context, int samples) {
  const std::vector<double> shares = expected_shares(entry.material, point, travel, context);
  std::vector<uint64_t> found(shares.size() + 1);
  RandomStream random(7, 0, 0, 0);
  for (int i = 0; i < samples; ++i) {
    const auto sample = entry.material.sample(point, travel, random, context);
    ++found[sample ? Bins::of(point, sample->direction) : Bins::kCount];
  }
  std::vector<double> expected(1);
  std::vector<uint64_t> counts(1);
  double sum = 0;
  for (int bin = 0; bin < Bins::kCount; ++bin) {
    sum += shares[bin];
    if (shares[bin] * samples < 5) {
      expected[0] += shares[bin] * samples;
      counts[0] += found[bin];
    } else {
      expected.push_back(shares[bin] * samples);
      counts.push_back(found[bin]);
    }
  }
  EXPECT_LE(sum, 1.002);
  if (1 - sum > 0.002) {
    expected.push_back((1 - sum) * samples);
    counts.push_back(found.back());
  } else {
    EXPECT_LT(found.back(), 0.004 * samples);
  }
  return chi_square_test(counts, expected);
}

TEST(EveryMaterial, DirectionsAreDrawnByTheirDensity) {
  const SurfaceContext context = world().spectral(1);
  const SurfacePoint point = askew_point();
  for (const NamedMaterial& entry : world().materials()) {
    if (!entry.exact_pdf || entry.material.is_specular() || entry.name == "rough nothing") continue;
    for (const double cosine : kCosines) {
      const Vec3f travel = -on_surface(point, cosine, kAzimuth);
      EXPECT_TRUE(check_chi_square(entry.name + ", cosine " + std::to_string(cosine),
                                   compared(entry, point, travel, context, 100'000), 1e-5));
    }
  }
}

/// What goes to the halves of each hemisphere and, last, to all of them, as the mean of all
/// channels: by sampling, and by evaluating at directions that are spread by their cosine.
struct Scattered {
  static constexpr int kParts = 5;
  std::array<RunningStatistics, kParts> by_sampling, by_evaluation;
};

Scattered scattered(const Material& material, const SurfacePoint& point, const Vec3f& travel,
                    const SurfaceContext& context, int samples) {
  Scattered result;
  RandomStream random(11, 0, 0, 0);
  const auto total = [&](const SampledSpectrum& value) {
    double sum = 0;
    for (int c = 0; c < context.spectra.channels(); ++c) sum += value[c];
    return sum / context.spectra.channels();
  };
  const auto half_of = [&](const Vec3f& direction) {
    return (point.normal.dot(direction) > 0 ? 2 : 0) +
           (on_surface(point, 0, kAzimuth).dot(direction) > 0 ? 1 : 0);
  };
  const auto add = [](std::array<RunningStatistics, Scattered::kParts>& statistics, int half,
                      double value) {
    for (int part = 0; part < 4; ++part) statistics[part].add(part == half ? value : 0);
    statistics[4].add(value);
  };
  for (int i = 0; i < samples; ++i) {
    const auto sample = material.sample(point, travel, random, context);
    const bool counts = sample && !sample->specular;
    add(result.by_sampling, counts ? half_of(sample->direction) : 0,
        counts ? total(sample->weight) : 0);
    const double side = random.uniform() < 0.5F && material.transmits() ? -1 : 1;
    const double cosine = std::sqrt(1.0 - random.uniform());
    const Vec3f next = on_surface(point, std::copysign(cosine, -side * point.normal.dot(travel)),
                                  2 * std::numbers::pi * random.uniform());
    const double density = cosine * std::numbers::inv_pi * (material.transmits() ? 0.5 : 1);
    add(result.by_evaluation, half_of(next),
        total(material.evaluate(point, travel, next, random, context).value) / density);
  }
  return result;
}

TEST(EveryMaterial, SamplingAndEvaluationScatterTheSame) {
  const SurfaceContext context = world().spectral(1);
  const SurfacePoint point = askew_point();
  for (const NamedMaterial& entry : world().materials()) {
    if (entry.material.is_specular()) continue;
    for (const double cosine : {0.8, -0.4}) {
      const Vec3f travel = -on_surface(point, cosine, kAzimuth);
      const Scattered found =
          scattered(entry.material, point, travel, context, entry.exact_pdf ? 40'000 : 100'000);
      for (int part = 0; part < Scattered::kParts; ++part) {
        const RunningStatistics& a = found.by_sampling[part];
        const RunningStatistics& b = found.by_evaluation[part];
        EXPECT_TRUE(check_mean(
            entry.name + ", cosine " + std::to_string(cosine) + ", part " + std::to_string(part),
            a.mean(), std::hypot(a.standard_error(), b.standard_error()), a.count(), b.mean(),
            {4.5, 1e-4}));
      }
    }
  }
}

TEST(EveryMaterial, ScattersNoMoreThanItReceives) {
  for_every_case([](const NamedMaterial& entry, const SurfacePoint& point, const Vec3f& travel,
                    const SurfaceContext& context) {
    if (context.spectra.channels() == 4) return;  // R, G and B hold the same for all paths
    RandomStream random(5, 0, 0, 0);
    RunningStatistics energy;
    for (int i = 0; i < 4000; ++i) {
      const auto sample = entry.material.sample(point, travel, random, context);
      double value = sample ? sample->weight[0] : 0;
      const double eta = point.normal.dot(travel) < 0 ? entry.eta : 1 / entry.eta;
      if (sample && sample->transmitted) value *= eta * eta;
      energy.add(value);
    }
    if (entry.eta == 1 && entry.material.transmits()) return;  // flint: another index
    EXPECT_LE(energy.mean(), 1 + 4 * energy.standard_error() + 1e-5);
  });
}

TEST(EveryMaterial, ValuesObeyReciprocity) {
  const SurfaceContext context = world().in_rgb();
  const SurfacePoint point = askew_point();
  for (const NamedMaterial& entry : world().materials()) {
    // Walks agree in the mean only; a mix chooses by direction.
    if (!entry.exact_pdf || entry.name == "mix") continue;
    if (entry.material.transmits() && entry.eta == 1) continue;
    RandomStream random(9, 0, 0, 0);
    for (int i = 0; i < 200; ++i) {
      const double cosine_out = 2.0 * random.uniform() - 1;
      const double cosine_in = 2.0 * random.uniform() - 1;
      const Vec3f out = on_surface(point, cosine_out, 6.0 * random.uniform());
      const Vec3f in = on_surface(point, cosine_in, 6.0 * random.uniform());
      const auto scattering = [&](const Vec3f& from, const Vec3f& to, double cosine) {
        // f / eta² of the side where the light is.
        const double eta = cosine < 0 ? entry.eta : 1;
        return entry.material.evaluate(point, -from, to, random, context).value[1] /
               std::abs(cosine) * eta * eta;
      };
      const double forth = scattering(out, in, cosine_in);
      EXPECT_NEAR(scattering(in, out, cosine_out), forth, 1e-3 * forth + 1e-9)
          << entry.name << " " << cosine_out << " " << cosine_in;
    }
  }
}

TEST(EveryMaterial, ShadingNormalsLetNoLightThrough) {
  SurfacePoint point = askew_point();
  point.shading_normal = (point.normal + on_surface(point, 0, 2) * 0.7F).normalized();
  const SurfaceContext context = world().in_rgb();
  for (const NamedMaterial& entry : world().materials()) {
    if (entry.material.transmits()) continue;
    RandomStream random(13, 0, 0, 0);
    for (int i = 0; i < 1000; ++i) {
      const Vec3f travel = on_surface(point, 2.0 * random.uniform() - 1, 6.0 * random.uniform());
      const Vec3f next = on_surface(point, 2.0 * random.uniform() - 1, 6.0 * random.uniform());
      const bool crosses = point.normal.dot(travel) * point.normal.dot(next) > 0;
      const MaterialValue found = entry.material.evaluate(point, travel, next, random, context);
      ASSERT_TRUE(!crosses || is_black(found.value)) << entry.name;
      const auto sample = entry.material.sample(point, travel, random, context);
      ASSERT_TRUE(!sample || !sample->transmitted) << entry.name;
    }
  }
}

TEST(Material, RefusesWhatCannotBe) {
  EXPECT_THROW(Material(MixMaterial{}), Error);
  CoatedDiffuseMaterial coated;
  coated.coating.max_depth = 0;
  EXPECT_THROW(Material{coated}, Error);
  coated.coating.max_depth = 1;
  coated.coating.samples = 0;
  EXPECT_THROW(Material{coated}, Error);
}

}  // namespace
}  // namespace freepath::testing
