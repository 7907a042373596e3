// Scatterings in lanes, on every target: bit for bit what the scalar classes give.

#include "freepath/transport/scattering_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "freepath/base/direction_disc.h"
#include "freepath/base/distributions.h"
#include "freepath/base/random.h"
#include "freepath/base/turn.h"
#include "freepath/media/phase/henyey_greenstein.h"
#include "freepath/tracking/streams.h"
#include "freepath/transport/kernels.h"
#include "freepath/transport/shadow_roulette.h"

namespace freepath {
namespace {

constexpr float kCosines[] = {0, 0.85F, -0.4F, 0.999F, 1e-4F, -0.97F, 0.3F};
constexpr uint64_t kSeed = 0x123456789ABCDEFU;
constexpr float kThreshold = 0.25F;  // of paths' roulette

/// Scatterings of any kind, in full or but for some at the end.
ScatteringStream make_scatterings(uint32_t first, std::size_t count) {
  ScatteringStream scatterings;
  scatterings.count = count;
  RandomStream random(kSeed, first, 0, 0);
  for (uint32_t i = 0; i < count; ++i) {
    scatterings.pixel[i] = first + i * 77;
    scatterings.sample[i] = i * i;
    scatterings.stream[i] = i * 4 + 2;
    scatterings.g[i] = kCosines[i % std::size(kCosines)];
    const Vec3f before = i == 0 ? Vec3f(0, 0, -1) : sample_sphere(random.uniform(), 0.3F);
    const Vec3f light =
        i % 4 == 0 ? Vec3f(0, 0.6F, 0.8F) : sample_sphere(random.uniform(), random.uniform());
    for (int axis = 0; axis < 3; ++axis) {
      scatterings.position[axis][i] = 5 * random.uniform() - 2;
      scatterings.direction[axis][i] = before[axis];
      scatterings.to_light[axis][i] = light[axis];
    }
    scatterings.light_pdf[i] = i % 5 == 0 ? 0 : 3 * random.uniform();
    scatterings.light_found[i] = i % 3 == 0 ? 0.0F : 1.0F;
    scatterings.brightness[i] = i % 7 == 0 ? 1e30F : 2 * random.uniform();
    scatterings.is_given[i] = i % 11 == 0 ? 1 : 0;
    scatterings.light_value[i] = i % 11 == 0 ? random.uniform() : -1;
    scatterings.magnitude[i] = i % 2 == 0 ? 0.2F * random.uniform() : 3 * random.uniform();
    scatterings.lobe_roulette[i] = i % 9 == 0 ? kThreshold : 0;
    scatterings.lobe_scale[i] = scatterings.magnitude[i] * (i % 4 == 1 ? 0.5F : 1.0F);
  }
  return scatterings;
}

/// Cells of 3 x 2 x 4 around most of the scatterings, and their transmittances.
struct Cells {
  std::vector<float> roots;
  ShadowRoulette roulette;

  explicit Cells(float least) {
    RandomStream random(kSeed, 0, 0, 1);
    // No less than the least survival, which else hides them.
    for (int i = 0; i < 24; ++i) roots.push_back(0.1F + 0.9F * random.uniform());
    roulette = {.least = least,
                .dominant = {0, 0.6F, 0.8F},
                .corner = {-1, -1, -1},
                .per_cell = {1, 0.7F, 1.3F},
                .counts = {3, 2, 4},
                .roots = roots.data(),
                .lobe_scale = 3};
  }
};

Vec3f vector_at(const std::array<ScatteringStream::Row<float>, 3>& rows, std::size_t i) {
  return {rows[0][i], rows[1][i], rows[2][i]};
}

void expect_scalar_lobes(const ScatteringStream& lanes, const ShadowRoulette& roulette,
                         std::size_t i) {
  const float throughput = lanes.lobe_scale[i] / lanes.survival[i];
  float root = 1;
  if (roulette.roots != nullptr) {
    // Probability with which a ray would be cast that is expected to bring its root alone.
    ShadowRoulette alone = roulette;
    alone.least = 1;
    root = alone.survival(vector_at(lanes.position, i), roulette.dominant, 0.9999999F);
  }
  float expected = 0;
  if (roulette.lobe_scale != 0) {
    const HenyeyGreenstein twice(lanes.g[i] * lanes.g[i]);
    expected = throughput * roulette.lobe_scale *
               twice.evaluate(vector_at(lanes.direction, i), roulette.dominant);
  }
  const float below = lanes.lobe_roulette[i];
  const float worth = std::max(throughput, expected * root);
  const float survival = worth < below ? worth / below : 1;
  const float wanted = expected * std::max(root, ShadowRoulette::kLeastRoot);
  const float chance =
      wanted < ShadowRoulette::kLeastLobeChance ? 0 : std::min(wanted / survival, 1.0F);
  EXPECT_NEAR(lanes.lobe_survival[i], survival, 1e-5F);
  EXPECT_NEAR(lanes.lobe_chance[i], chance, 1e-5F);
}

void expect_scalar(const ScatteringStream& lanes, const ScatteringStream& before_lanes,
                   const ShadowRoulette& roulette, std::size_t i) {
  RandomStream random(kSeed, lanes.pixel[i], lanes.sample[i], lanes.stream[i]);
  for (const auto& numbers : lanes.numbers) ASSERT_EQ(numbers[i], random.uniform());
  const bool plays = lanes.lobe_roulette[i] == 0 && lanes.magnitude[i] < kThreshold;
  ASSERT_EQ(lanes.survival[i], plays ? lanes.magnitude[i] / kThreshold : 1);
  const HenyeyGreenstein phase(lanes.g[i]);
  const Vec3f before = vector_at(lanes.direction, i);
  const Vec3f light = vector_at(lanes.to_light, i);
  const float value =
      lanes.is_given[i] != 0 ? before_lanes.light_value[i] : phase.evaluate(before, light);
  ASSERT_EQ(lanes.light_value[i], value);
  const float pdf = lanes.light_pdf[i];
  const float share = pdf > 0 ? value / (pdf + lanes.light_found[i] * value) : 0;
  const float shadow_survival = roulette.survival(vector_at(lanes.position, i), light,
                                                  lanes.brightness[i] * share / lanes.survival[i]);
  const bool is_cast = share > 0 && lanes.numbers[kRouletteNumber][i] < lanes.survival[i] &&
                       lanes.numbers[kShadowNumber][i] < shadow_survival;
  ASSERT_EQ(lanes.shadow_weight[i], is_cast ? share / shadow_survival : 0);
  ASSERT_EQ((lanes.cast >> i & 1) != 0, is_cast);
  expect_scalar_lobes(lanes, roulette, i);
  const PhaseSample next =
      phase.sample(before, lanes.numbers[kPhaseNumber][i], lanes.numbers[kPhaseNumber + 1][i]);
  ASSERT_EQ(lanes.next_pdf[i], next.pdf);
  ASSERT_EQ(vector_at(lanes.next, i), next.direction);
}

TEST(Scattering, LanesOfEveryTargetDoAsTheScalarClasses) {
  for (const Simd simd : available_simd()) {
    SCOPED_TRACE(std::string(to_string(simd)));
    const ScatteringKernels& lanes = kernels(simd).scattering;
    const Cells cells(0.4F);
    ShadowRoulette without = cells.roulette;
    without.roots = nullptr;
    const ShadowRoulette roulettes[] = {cells.roulette, without, ShadowRoulette()};
    // Many rounds, so that numbers come that take a second word: one in 256 does.
    for (uint32_t round = 0; round < 50; ++round) {
      ScatteringStream scatterings =
          make_scatterings(round * 100000, ScatteringStream::kCapacity - round % 3 * 5);
      lanes.draw_numbers(scatterings, kSeed, kScatteringBlocks);
      lanes.play(scatterings, kThreshold);
      const ScatteringStream before = scatterings;
      const ShadowRoulette& roulette = roulettes[round % 3];
      lanes.scatter(scatterings, roulette);
      if (scatterings.count < ScatteringStream::kCapacity) {
        ASSERT_EQ(scatterings.cast >> scatterings.count, 0) << "what is no scattering casts none";
      }
      for (std::size_t i = 0; i < scatterings.count; ++i) {
        SCOPED_TRACE(i);
        ASSERT_NO_FATAL_FAILURE(expect_scalar(scatterings, before, roulette, i));
      }
    }
  }
}

TEST(Scattering, LanesOfEveryTargetTakeOverTheFlightsThatEndedInScatterings) {
  constexpr uint32_t kRays = 400;
  RayStream rays;
  FlightStream flights;
  rays.resize(kRays);
  flights.resize(kRays);
  RandomStream random(kSeed, 0, 0, 9);
  for (uint32_t i = 0; i < kRays; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = random.uniform();
      rays.direction[axis][i] = random.uniform();
    }
    flights.t[i] = random.uniform();
    rays.pixel[i] = 1000 + i;
    rays.sample[i] = 5000 + i;
    rays.stream[i] = stream_number(StreamPurpose::kWalk, i);
  }
  // Next to each other, some left out, most left out, up to the last, back and forth, the same.
  const std::vector<std::function<uint32_t(uint32_t)>> orders = {
      [](uint32_t i) { return i; },
      [](uint32_t i) { return 3 + i + i / 3 + i / 7; },
      [](uint32_t i) { return 6 * i; },
      [](uint32_t i) { return kRays - ScatteringStream::kCapacity + i; },
      [](uint32_t i) { return i * 37 % kRays; },
      [](uint32_t i) { return 9 + i / 2; }};
  for (const Simd simd : available_simd()) {
    SCOPED_TRACE(std::string(to_string(simd)));
    for (const auto& order : orders) {
      for (const std::size_t count : {1U, 15U, 16U, 17U, 50U, 64U}) {
        SCOPED_TRACE(count);
        ScatteringStream scatterings;
        scatterings.count = count;
        for (uint32_t i = 0; i < count; ++i) scatterings.ray[i] = order(i) % kRays;
        kernels(simd).scattering.gather(rays, flights, scatterings);
        for (std::size_t i = 0; i < count; ++i) {
          SCOPED_TRACE(i);
          const uint32_t ray = scatterings.ray[i];
          for (int axis = 0; axis < 3; ++axis) {
            const float direction = rays.direction[axis][ray];
            ASSERT_EQ(scatterings.direction[axis][i], direction);
            ASSERT_EQ(scatterings.position[axis][i],
                      rays.origin[axis][ray] + direction * flights.t[ray]);
          }
          ASSERT_EQ(scatterings.pixel[i], rays.pixel[ray]);
          ASSERT_EQ(scatterings.sample[i], rays.sample[ray]);
          ASSERT_EQ(scatterings.stream[i], stream_number(StreamPurpose::kScatter, ray));
        }
      }
    }
  }
}

TEST(Scattering, LanesOfEveryTargetSendTheRaysOfSomeOneBehindTheOther) {
  constexpr std::size_t kBefore = 3;
  constexpr uint32_t kStep = 5;
  const ScatteringStream::Set sets[] = {
      0, 1, ~ScatteringStream::Set{0}, 0x8000000000000001, 0x123456789ABCDEF0, 0x00FF00FF0000FFFF};
  for (const Simd simd : available_simd()) {
    SCOPED_TRACE(std::string(to_string(simd)));
    const ScatteringKernels& lanes = kernels(simd).scattering;
    for (const ScatteringStream::Set some : sets) {
      ScatteringStream scatterings = make_scatterings(11, ScatteringStream::kCapacity);
      lanes.scatter(scatterings, ShadowRoulette());
      const auto count = static_cast<std::size_t>(std::popcount(some));
      RayStream rays;
      rays.resize(kBefore + count);
      rays.pixel[kBefore - 1] = 77;
      lanes.send(scatterings, some, scatterings.next, kStep, rays, kBefore);
      EXPECT_EQ(rays.pixel[kBefore - 1], 77U);
      std::size_t ray = kBefore;
      for (std::size_t i = 0; i < scatterings.count; ++i) {
        if ((some >> i & 1) == 0) continue;
        SCOPED_TRACE(i);
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_EQ(rays.origin[axis][ray], scatterings.position[axis][i]);
          ASSERT_EQ(rays.direction[axis][ray], scatterings.next[axis][i]);
        }
        ASSERT_EQ(rays.pixel[ray], scatterings.pixel[i]);
        ASSERT_EQ(rays.sample[ray], scatterings.sample[i]);
        ASSERT_EQ(rays.stream[ray], scatterings.stream[i] + kStep);
        ++ray;
      }
      EXPECT_EQ(ray, kBefore + count);
    }
  }
}

TEST(Scattering, LanesOfEveryTargetDrawPointsOfADiscAsItDoes) {
  // Points of the edge, which rounding puts outside or not.
  const DirectionDisc discs[] = {{Vec3f(0, 0.6F, 0.8F), 2.3256491e-3F},
                                 {Vec3f(-0.6F, 0, -0.8F), 2.3256491e-3F},
                                 {Vec3f(0, 1, 0), 0.02F}};
  for (const Simd simd : available_simd()) {
    SCOPED_TRACE(std::string(to_string(simd)));
    const ScatteringKernels& lanes = kernels(simd).scattering;
    for (const DirectionDisc& disc : discs) {
      ScatteringStream scatterings = make_scatterings(7, ScatteringStream::kCapacity - 5);
      lanes.draw_numbers(scatterings, kSeed, kScatteringBlocks);
      for (std::size_t i = 0; i < scatterings.count; i += 2) {
        scatterings.numbers[kLightNumber][i] = kOneMinusEpsilon;
      }
      lanes.aim(scatterings, disc);
      for (std::size_t i = 0; i < scatterings.count; ++i) {
        const Vec3f expected = disc.sample(scatterings.numbers[kLightNumber][i],
                                           scatterings.numbers[kLightNumber + 1][i]);
        ASSERT_EQ(vector_at(scatterings.to_light, i), expected) << i;
        ASSERT_TRUE(disc.contains(expected)) << i;
      }
    }
  }
}

TEST(ShadowRoulette, CastsFaintRaysByWhatTheyAreExpectedToBring) {
  const Cells cells(0.5F);
  const ShadowRoulette& roulette = cells.roulette;
  // In the cell (2, 1, 0).
  const Vec3f position(1.5F, 0.6F, -0.9F);
  const float root = cells.roots[2 + 3 * 1];
  EXPECT_EQ(roulette.survival(position, roulette.dominant, 0.5F / root * 1.01F), 1);
  EXPECT_FLOAT_EQ(roulette.survival(position, roulette.dominant, 0.5F),
                  std::max(root, ShadowRoulette::kLeastSurvival));
  EXPECT_EQ(roulette.survival(position, -roulette.dominant, 0.5F), 1);
  EXPECT_FLOAT_EQ(roulette.survival(position, roulette.dominant, 0.4F),
                  std::max(0.8F * root, ShadowRoulette::kLeastSurvival));
  EXPECT_FLOAT_EQ(roulette.survival(position, -roulette.dominant, 0.4F), 0.8F);
  EXPECT_EQ(roulette.survival(position, -roulette.dominant, 1e-6F), ShadowRoulette::kLeastSurvival);
  // Beyond the cells those at their border hold.
  EXPECT_EQ(roulette.survival({1e6F, 1e6F, -1e6F}, roulette.dominant, 0.4F),
            roulette.survival(position, roulette.dominant, 0.4F));
  EXPECT_EQ(ShadowRoulette().survival(position, roulette.dominant, 0), 1);
}

TEST(Turn, IsThatOfTheLibraryToTheLastDigits) {
  constexpr int kSteps = 1 << 20;
  double largest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const float u = static_cast<float>(i) / kSteps;
    const auto [sine, cosine] = sincos_of_turn(u);
    const double angle = 2 * std::numbers::pi * u;
    largest =
        std::max({largest, std::abs(sine - std::sin(angle)), std::abs(cosine - std::cos(angle))});
  }
  EXPECT_LT(largest, 1e-7);
  // At quarters nothing is rounded.
  EXPECT_EQ(sincos_of_turn(0).sine, 0);
  EXPECT_EQ(sincos_of_turn(0.25F).cosine, 0);
  EXPECT_EQ(sincos_of_turn(0.5F).cosine, -1);
  EXPECT_EQ(sincos_of_turn(0.75F).sine, -1);
  EXPECT_EQ(sincos_of_turn(1).cosine, 1);
}

}  // namespace
}  // namespace freepath
