// Materials that absorb nothing scatter all that they receive, and dispersion loses nothing.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "freepath/base/error.h"
#include "freepath/materials/fresnel.h"
#include "tests/materials/materials_for_tests.h"
#include "tests/statistics.h"

namespace freepath::testing {
namespace {

/// Energy that a sampled path carries on, without the radiance scale of refraction.
RunningStatistics energy(const Material& material, double cosine, const SurfaceContext& context,
                         double eta, int samples, int channel = 0) {
  const SurfacePoint point = askew_point();
  const Vec3f travel = -on_surface(point, cosine, 0.7);
  RandomStream random(3, 0, 0, 0);
  RunningStatistics result;
  for (int i = 0; i < samples; ++i) {
    const auto sample = material.sample(point, travel, random, context);
    const double relative = cosine > 0 ? eta : 1 / eta;
    const double scale = sample && sample->transmitted ? relative * relative : 1;
    result.add(sample ? sample->weight[channel] * scale : 0);
  }
  return result;
}

/// That each path carries on exactly all it had.
void expect_lossless(const Material& material, const SurfaceContext& context, double eta) {
  for (const double cosine : kCosines) {
    const RunningStatistics found = energy(material, cosine, context, eta, 1000);
    EXPECT_NEAR(found.mean(), 1, 1e-5) << "cosine " << cosine;
    EXPECT_LT(found.standard_error(), 1e-5) << "cosine " << cosine;
  }
}

TEST(Furnace, SmoothDielectricsLoseNothing) {
  MaterialWorld world;
  const Material glass = DielectricMaterial{world.index(1.5), {}};
  const Material bubble = DielectricMaterial{world.index(1 / 1.5), {}};
  const Material pane = ThinDielectricMaterial{world.index(1.5)};
  const Material nothing = DielectricMaterial{world.index(1), {0.5F, 0.5F}};
  world.update();
  expect_lossless(glass, world.in_rgb(), 1.5);
  expect_lossless(bubble, world.in_rgb(), 1 / 1.5);
  expect_lossless(pane, world.in_rgb(), 1);
  expect_lossless(nothing, world.in_rgb(), 1);
}

TEST(Furnace, RefractionScalesRadianceByTheSquareOfTheIndex) {
  MaterialWorld world;
  const Material glass = DielectricMaterial{world.index(1.5), {}};
  world.update();
  const SurfacePoint point = askew_point();
  RandomStream random(3, 0, 0, 0);
  for (int i = 0; i < 100; ++i) {
    for (const double cosine : {0.9, -0.9}) {
      const auto sample =
          glass.sample(point, -on_surface(point, cosine, 0), random, world.in_rgb());
      ASSERT_TRUE(sample);
      if (!sample->transmitted) continue;
      EXPECT_NEAR(sample->weight[0], cosine > 0 ? 1 / 2.25 : 2.25, 1e-5);
    }
  }
}

TEST(Furnace, WhiteDiffuseLosesNothing) {
  MaterialWorld world;
  const Material white = DiffuseMaterial{world.grey(1)};
  world.update();
  expect_lossless(white, world.in_rgb(), 1);
}

TEST(Furnace, WhitePaperLosesNothing) {
  MaterialWorld world;
  const Material paper = DiffuseTransmissionMaterial{world.grey(0.35), world.grey(0.65)};
  const Material scaled = DiffuseTransmissionMaterial{world.grey(0.8), world.grey(0.2), 0.5F};
  world.update();
  expect_lossless(paper, world.in_rgb(), 1);
  for (const double cosine : {0.9, -0.4}) {
    EXPECT_NEAR(energy(scaled, cosine, world.in_rgb(), 1, 100).mean(), 0.5, 1e-6);
  }
}

// To either side the share that the material says, of uniform radiance.
TEST(Furnace, PaperPartsLightBetweenItsSides) {
  MaterialWorld world;
  const Material paper = DiffuseTransmissionMaterial{world.grey(0.7), world.grey(0.1)};
  world.update();
  const SurfacePoint point = askew_point();
  for (const double cosine : {0.8, -0.3}) {
    const Vec3f travel = -on_surface(point, cosine, 0.7);
    RandomStream random(5, 0, 0, 0);
    RunningStatistics reflected, transmitted;
    for (int i = 0; i < 20'000; ++i) {
      const auto sample = paper.sample(point, travel, random, world.in_rgb());
      ASSERT_TRUE(sample);
      EXPECT_EQ(sample->transmitted, sample->direction.dot(point.normal) * cosine < 0);
      reflected.add(sample->transmitted ? 0 : sample->weight[0]);
      transmitted.add(sample->transmitted ? sample->weight[0] : 0);
    }
    EXPECT_TRUE(check_mean("reflected", reflected, 0.7, {.largest_relative_error = 0.01}));
    EXPECT_TRUE(check_mean("transmitted", transmitted, 0.1, {.largest_relative_error = 0.03}));
  }
}

TEST(Furnace, APerfectConductorLosesNothingWhereItIsSmooth) {
  MaterialWorld world;
  const Material mirror = ConductorMaterial{ComplexIndex{world.grey(1), world.grey(1e7)}, {}};
  world.update();
  expect_lossless(mirror, world.in_rgb(), 1);
}

// Light that meets a second facet is lost: little of a surface that is nearly smooth.
TEST(Furnace, NearlySmoothFacetsLoseLittle) {
  MaterialWorld world;
  const Roughness slight{0.02F, 0.02F, false};
  const Material mirror = ConductorMaterial{ComplexIndex{world.grey(1), world.grey(1e7)}, slight};
  const Material glass = DielectricMaterial{world.index(1.5), slight};
  world.update();
  for (const double cosine : {0.95, 0.5, -0.9}) {
    EXPECT_NEAR(energy(mirror, cosine, world.in_rgb(), 1, 2000).mean(), 1, 2e-3);
    EXPECT_NEAR(energy(glass, cosine, world.in_rgb(), 1.5, 2000).mean(), 1, 2e-3);
  }
}

// Of an infinitely deep walk nothing is lost: neither in a medium that only scatters nor in one
// that is too thin to absorb.
TEST(Furnace, CoatedWhiteLosesNothing) {
  MaterialWorld world;
  const SpectrumId white = world.grey(1);
  const Coating thin{world.index(1.5), {}, 1e-7F, SpectrumId{}, 0.0F, 10'000, 1};
  Coating milk = thin;
  milk.albedo = white;
  milk.thickness = 1.0F;
  milk.g = 0.5F;
  const Material clear = CoatedDiffuseMaterial{thin, white};
  const Material milky = CoatedDiffuseMaterial{milk, white};
  const Material metal = CoatedConductorMaterial{milk, ComplexIndex{white, world.grey(1e7)}, {}};
  world.update();
  for (const double cosine : {0.9, 0.3, -0.6}) {
    for (const Material* material : {&clear, &milky, &metal}) {
      EXPECT_TRUE(check_mean("coated white", energy(*material, cosine, world.in_rgb(), 1, 50'000),
                             1, {4, 1e-5, 2e-3}));
    }
  }
}

/// What evaluate() scatters, by directions that are spread by their cosine.
RunningStatistics evaluated(const Material& material, double cosine, const SurfaceContext& context,
                            int samples) {
  const SurfacePoint point = askew_point();
  const Vec3f travel = -on_surface(point, cosine, 0.7);
  RandomStream random(8, 0, 0, 0);
  RunningStatistics result;
  for (int i = 0; i < samples; ++i) {
    const double height = std::sqrt(1.0 - random.uniform());
    const Vec3f next = on_surface(point, height, 2 * std::numbers::pi * random.uniform());
    const MaterialValue found = material.evaluate(point, travel, next, random, context);
    result.add(found.value[0] * std::numbers::pi / height);
  }
  return result;
}

// Of the walks themselves: a smooth coating reflects F at once, which is specular, and the rest
// comes back sooner or later.
TEST(Furnace, EvaluatingACoatedWhiteLosesNothing) {
  MaterialWorld world;
  const SpectrumId white = world.grey(1);
  const Coating thin{world.index(1.5), {}, 1e-7F, SpectrumId{}, 0.0F, 10'000, 1};
  Coating milk = thin;
  milk.albedo = white;
  milk.thickness = 1.0F;
  milk.g = 0.3F;
  const Material clear = CoatedDiffuseMaterial{thin, white};
  const Material milky = CoatedDiffuseMaterial{milk, white};
  world.update();
  for (const Material* material : {&clear, &milky}) {
    EXPECT_TRUE(check_mean("coated white", evaluated(*material, 0.8, world.in_rgb(), 450'000),
                           1 - fresnel_dielectric(0.8F, 1.5F), {4, 1e-5, 1.7e-3}));
  }
}

TEST(Furnace, EvaluatingARoughCoatingIsAsSharplyWhatSamplingSays) {
  MaterialWorld world;
  const SpectrumId white = world.grey(1);
  Coating coating{world.index(1.5), {0.4F, 0.4F, false}, 1e-7F, SpectrumId{}, 0.0F, 1000, 1};
  const Material clear = CoatedDiffuseMaterial{coating, white};
  coating.albedo = white;
  coating.thickness = 1.0F;
  const Material milky = CoatedDiffuseMaterial{coating, white};
  world.update();
  for (const Material* material : {&clear, &milky}) {
    const RunningStatistics sampled = energy(*material, 0.8, world.in_rgb(), 1, 400'000);
    const RunningStatistics found = evaluated(*material, 0.8, world.in_rgb(), 400'000);
    EXPECT_TRUE(check_mean("rough coating", found.mean(),
                           std::hypot(found.standard_error(), sampled.standard_error()),
                           found.count(), sampled.mean(), {4, 1e-5, 3e-3}));
  }
}

// What pbrt-v4's defaults cut off: 10 interactions of which half are with the bottom.
TEST(Furnace, TheDefaultDepthOfACoatingCutsWhatItsReflectionsSay) {
  MaterialWorld world;
  const SpectrumId white = world.grey(1);
  Coating coating{world.index(1.5), {}, 1e-7F, SpectrumId{}, 0.0F};
  const Material coated = CoatedDiffuseMaterial{coating, white};
  world.update();
  // Diffuse light from within is reflected by 0.596 (n = 1.5), so that 5 visits leave
  // 0.596^5 = 0.075 of what was transmitted, 0.96 at normal incidence.
  const RunningStatistics found = energy(coated, 0.9999, world.in_rgb(), 1, 100'000);
  EXPECT_TRUE(check_mean("energy", found, 1 - 0.96 * std::pow(0.5964, 5), {4, 1e-3}));
}

TEST(Furnace, DispersionLeavesTheHeroWithTheShareOfAll) {
  MaterialWorld world;
  const Material smooth = DielectricMaterial{world.flint(), {}};
  const Material rough = DielectricMaterial{world.flint(), {0.3F, 0.3F, false}};
  world.update();
  const SurfacePoint point = askew_point();
  const Vec3f travel = -on_surface(point, 0.6, 0.7);
  for (const Material* material : {&smooth, &rough}) {
    for (const bool only_hero : {false, true}) {
      SurfaceContext context = world.spectral(2);
      context.only_hero = only_hero;
      RandomStream random(3, 0, 0, 0);
      bool refracted_once = false;
      for (int i = 0; i < 200; ++i) {
        const auto sample = material->sample(point, travel, random, context);
        if (!sample) continue;
        ASSERT_EQ(sample->hero_only, sample->transmitted);
        if (!sample->transmitted) {
          for (int c = 0; c < context.spectra.channels(); ++c) ASSERT_GT(sample->weight[c], 0);
          continue;
        }
        refracted_once = true;
        const double eta = world.eta_of_flint(context)[2];
        const double masking = sample->weight[2] * eta * eta / (only_hero ? 1 : 4);
        ASSERT_LE(masking, 1 + 1e-5);
        ASSERT_GT(masking, material == &smooth ? 1 - 1e-5 : 0.3);
      }
      EXPECT_TRUE(refracted_once);
    }
  }
}

TEST(Furnace, ReflectionsOfADispersiveSurfaceAreRightInEveryChannel) {
  MaterialWorld world;
  const Material glass = DielectricMaterial{world.flint(), {}};
  world.update();
  const SurfacePoint point = askew_point();
  const double cosine = 0.4;
  const SurfaceContext context = world.spectral(0);
  RandomStream random(3, 0, 0, 0);
  std::array<RunningStatistics, kMaxChannels> reflected;
  for (int i = 0; i < 20'000; ++i) {
    const auto sample = glass.sample(point, -on_surface(point, cosine, 0.7), random, context);
    ASSERT_TRUE(sample);
    for (int c = 0; c < context.spectra.channels(); ++c) {
      reflected[c].add(sample->transmitted ? 0 : sample->weight[c]);
    }
  }
  for (int c = 0; c < context.spectra.channels(); ++c) {
    const float eta = world.eta_of_flint(context)[c];
    EXPECT_TRUE(check_mean("reflectance", reflected[c],
                           fresnel_dielectric(static_cast<float>(cosine), eta)));
  }
}

TEST(Mix, TakesTheSecondMaterialByItsAmount) {
  MaterialWorld world;
  const auto white = std::make_shared<const Material>(DiffuseMaterial{world.grey(1)});
  const auto black = std::make_shared<const Material>(DiffuseMaterial{world.grey(0)});
  world.update();
  RandomStream random(3, 0, 0, 0);
  SurfacePoint point = askew_point();
  const Vec3f travel = -on_surface(point, 0.6, 0.7);
  for (const float amount : {0.0F, 0.3F, 1.0F}) {
    const Material mix = MixMaterial{white, black, amount};
    const Material nested = MixMaterial{std::make_shared<const Material>(mix), black, amount};
    RunningStatistics found, found_nested;
    for (int i = 0; i < 20'000; ++i) {
      point.position = {random.uniform(), random.uniform(), 3};
      const auto sample = mix.sample(point, travel, random, world.in_rgb());
      found.add(sample ? sample->weight[0] : 0);
      const auto inner = nested.sample(point, travel, random, world.in_rgb());
      found_nested.add(inner ? inner->weight[0] : 0);
      // The same choice, whenever it is asked for.
      if (sample) {
        const MaterialValue value =
            mix.evaluate(point, travel, sample->direction, random, world.in_rgb());
        ASSERT_NEAR(value.value[0], sample->weight[0] * sample->pdf, 1e-4);
      }
    }
    EXPECT_TRUE(check_mean("mix", found, 1 - amount));
    EXPECT_TRUE(check_mean("mix of mixes", found_nested, (1 - amount) * (1 - amount)));
    EXPECT_NEAR(mix.albedo(point, travel, world.in_rgb())[0], 1 - amount, 1e-6);
  }
}

// An interface in a mix lets paths through.
TEST(Mix, HasHolesWhereItTakesAnInterface) {
  MaterialWorld world;
  const auto white = std::make_shared<const Material>(DiffuseMaterial{world.grey(1)});
  world.update();
  const Material sieve = MixMaterial{white, nullptr, 0.3F};
  EXPECT_TRUE(sieve.has_holes());
  EXPECT_TRUE(sieve.transmits());
  EXPECT_FALSE(sieve.is_specular());
  EXPECT_FALSE(white->has_holes());
  const Material nested = MixMaterial{std::make_shared<const Material>(sieve), white, 0.5F};
  EXPECT_TRUE(nested.has_holes());
  EXPECT_THROW(Material(MixMaterial{nullptr, nullptr}), Error);
  RandomStream random(3, 0, 0, 0);
  SurfacePoint point = askew_point();
  const Vec3f travel = -on_surface(point, 0.6, 0.7);
  RunningStatistics holes, nested_holes;
  for (int i = 0; i < 20'000; ++i) {
    point.position = {random.uniform(), random.uniform(), 3};
    const bool hole = sieve.is_hole(point, travel, world.in_rgb());
    holes.add(hole ? 1 : 0);
    nested_holes.add(nested.is_hole(point, travel, world.in_rgb()) ? 1 : 0);
    const auto sample = sieve.sample(point, travel, random, world.in_rgb());
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->transmitted, hole);
  }
  EXPECT_TRUE(check_mean("holes", holes, 0.3));
  EXPECT_TRUE(check_mean("holes of a nest", nested_holes, 0.15));
}

// Without memory it would be 2^N.
TEST(Mix, OfMixesIsLookedThroughOnce) {
  MaterialWorld world;
  auto last = std::make_shared<const Material>(DiffuseMaterial{world.grey(0.5)});
  world.update();
  const SurfacePoint point = askew_point();
  const Vec3f travel = -on_surface(point, 0.6, 0.7);
  for (int depth = 1; depth <= 60; ++depth) {
    last = std::make_shared<const Material>(MixMaterial{last, last, 0.25F});
    if (depth != 15 && depth != 60) continue;
    uint64_t visited = 0;
    EXPECT_NEAR(last->albedo(point, travel, world.in_rgb(), &visited)[0], 0.5, 1e-6);
    EXPECT_EQ(visited, depth + 2U);  // the diffuse one twice
    EXPECT_FALSE(last->is_specular());
    EXPECT_FALSE(last->transmits());
  }
}

TEST(Albedo, OfACoatingIsNearWhatItScatters) {
  MaterialWorld world;
  const Coating coating{world.index(1.5), {}, 1e-6F, SpectrumId{}, 0.0F, 1000, 1};
  const Material paint = CoatedDiffuseMaterial{coating, world.grey(0.5)};
  const Material metal = CoatedConductorMaterial{coating, world.gold(), {}};
  world.update();
  const SurfacePoint point = askew_point();
  for (const double cosine : {0.9, 0.4}) {
    const Vec3f travel = -on_surface(point, cosine, 0.7);
    EXPECT_NEAR(paint.albedo(point, travel, world.in_rgb())[0],
                energy(paint, cosine, world.in_rgb(), 1, 50'000).mean(), 0.01);
    EXPECT_NEAR(metal.albedo(point, travel, world.in_rgb())[1],
                energy(metal, cosine, world.in_rgb(), 1, 50'000, 1).mean(), 0.03);
  }
}

}  // namespace
}  // namespace freepath::testing
