// The power of the tests on Fixture A: 1 % more of mu_a, mu_s or mu_n in the weight of any method
// must fail, with as many paths as make the shift 8 standard errors.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "freepath/transport/walker.h"
#include "tests/certify/media.h"
#include "tests/certify/mutants.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr double kWantedShift = 8;  // standard errors
constexpr uint64_t kMostPaths = 12'000'000;
constexpr uint64_t kPilotPaths = 50'000;
constexpr std::size_t kBatch = 50'000;
constexpr float kError = 1.01F;
/// What survives roulette matters less, and its number of paths should not.
constexpr float kRouletteError = 1.03F;
constexpr float kComponentError = 0.97F;

/// The channel of two_components() that is looked at: both scatter in it.
constexpr int kChannelOfTwo = 1;

const CertifiedMedium& two_components() {
  const std::vector<CertifiedMedium>& media = certified_media();
  return *std::find_if(media.begin(), media.end(), [](const CertifiedMedium& medium) {
    return medium.name == "two components";
  });
}

using ChannelStatistics = std::array<RunningStatistics, kChannels>;

/// Under loose bounds, so that there are null collisions.
const Medium& fixture() {
  static const Medium kMedium = FixtureA::medium().with_scaled_bounds(4);
  return kMedium;
}

double exact(const Mutant& mutant, int channel) {
  return mutant.free_paths ? FixtureA::kRadiance[channel]
                           : std::exp(-FixtureA::kThickness[channel]);
}

/// What flights collect, or their transmittance.
double collected(const Mutant& mutant, const FlightStream& flights, std::size_t i, int slot,
                 int channel) {
  const double weight = flights.weight[slot][i];
  if (!mutant.free_paths) return weight;
  double ending = 0;
  if (flights.event[i] == Event::kEscape) ending = 1;
  if (flights.event[i] == Event::kScatter) ending = FixtureA::scattered(flights.t[i], channel);
  return flights.emitted[slot][i] + weight * ending;
}

/// @param pixel chooses other random numbers
ChannelStatistics walk(const Mutant& mutant, const PlantedFactors& planted, uint64_t paths,
                       uint32_t pixel) {
  const WalkModes modes = {Absorption::kAnalog, EmissionTally::kCollision, mutant.free_paths};
  const Mutant::Options options = mutant.options(planted);
  ChannelStatistics statistics;
  FlightStream flights;
  WalkStatistics counts;
  for (int turn = 0; turn < kChannels / mutant.channels; ++turn) {
    const MediumView view = view_of(fixture(), Interpolation::kNearest,
                                    channels_of(fixture(), mutant.channels == 1 ? turn : -1));
    for (uint64_t done = 0; done < paths; done += kBatch) {
      const std::size_t count = std::min<uint64_t>(kBatch, paths - done);
      RayStream rays =
          repeat_ray(Vec3f(0, 0, 0), Vec3f(1, 0, 0), 10.0F, count, static_cast<uint32_t>(done));
      std::fill(rays.pixel.begin(), rays.pixel.end(), pixel);
      flights.resize(count);
      mutant.walk(view, options, modes, 20170501, rays, flights, counts);
      for (int slot = 0; slot < mutant.channels; ++slot) {
        const int channel = mutant.channels == 1 ? turn : slot;
        for (std::size_t i = 0; i < count; ++i) {
          statistics[channel].add(collected(mutant, flights, i, slot, channel));
        }
      }
    }
  }
  return statistics;
}

/// The channel that shows an error best, and the paths that make its shift what is wanted.
struct Plan {
  int channel = 0;
  double paths = 1e300;
};

/// With the random numbers of both walks the same, their difference is known well after few paths.
Plan make_plan(const ChannelStatistics& honest, const ChannelStatistics& planted) {
  Plan plan;
  for (int channel = 0; channel < kChannels; ++channel) {
    const double shift = planted[channel].mean() - honest[channel].mean();
    const double paths = planted[channel].variance() * std::pow(kWantedShift / shift, 2);
    if (paths < plan.paths) plan = {channel, paths};
  }
  return plan;
}

class CertifyMutant : public ::testing::TestWithParam<Mutant> {};

/// The errors that a mutant has places for.
std::vector<std::pair<const char*, PlantedFactors>> errors_of(const Mutant& mutant) {
  std::vector<std::pair<const char*, PlantedFactors>> errors = {{"mu_n", {1, 1, kError}}};
  if (mutant.free_paths && mutant.simd == Simd::kBest) {
    errors.push_back({"mu_a", {kError, 1, 1}});
    errors.push_back({"mu_s", {1, kError, 1}});
  }
  if (mutant.plays_roulette) errors.push_back({"roulette", {.roulette = kRouletteError}});
  return errors;
}

TEST_P(CertifyMutant, OnePercentInAWeightIsNoticed) {
  const Mutant& mutant = GetParam();
  const double threshold = family_wise_threshold(1e-3, 200);  // of all methods and errors
  const auto z = [&](const RunningStatistics& found, int channel) {
    return std::abs(z_score(found.mean(), found.standard_error(), exact(mutant, channel)));
  };
  const ChannelStatistics pilot = walk(mutant, {}, kPilotPaths, 1);
  uint64_t most = 0;
  for (const auto& [name, planted] : errors_of(mutant)) {
    const Plan plan = make_plan(pilot, walk(mutant, planted, kPilotPaths, 1));
    ASSERT_LT(plan.paths, kMostPaths) << name << " hardly matters";
    const auto paths = std::max<uint64_t>(20'000, static_cast<uint64_t>(plan.paths));
    const RunningStatistics found = walk(mutant, planted, paths, 2)[plan.channel];
    EXPECT_GT(z(found, plan.channel), threshold) << name << ", " << paths << " paths";
    most = std::max(most, paths);
  }
  const ChannelStatistics honest = walk(mutant, {}, most, 2);
  for (int channel = 0; channel < kChannels; ++channel) {
    EXPECT_LT(z(honest[channel], channel), threshold) << "without an error, " << most << " paths";
  }
}

INSTANTIATE_TEST_SUITE_P(All, CertifyMutant, ::testing::ValuesIn(mutants()), [](const auto& test) {
  std::string name = (test.param.free_paths ? "" : "transmittance_") + std::string(test.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

INSTANTIATE_TEST_SUITE_P(Targets, CertifyMutant, ::testing::ValuesIn(target_mutants()),
                         [](const auto& test) {
                           std::string name(to_string(test.param.simd));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// Of flights through two components, the weight that scatters by the second, in each channel that
/// is walked.
ChannelStatistics scattered_by_second(const Mutant& mutant, const PlantedFactors& planted,
                                      uint64_t paths, uint32_t pixel) {
  const CertifiedMedium& medium = two_components();
  const MediumChannels channels =
      mutant.channels == 1 ? medium.channels.only(kChannelOfTwo) : medium.channels;
  const MediumView view = view_of(*medium.tight, Interpolation::kNearest, channels);
  const WalkModes modes = {Absorption::kAnalog, EmissionTally::kCollision, false};
  const Mutant::Options options = mutant.options(planted);
  ChannelStatistics statistics;
  FlightStream flights;
  WalkStatistics counts;
  for (uint64_t done = 0; done < paths; done += kBatch) {
    const std::size_t count = std::min<uint64_t>(kBatch, paths - done);
    RayStream rays = repeat_ray(medium.ray.origin, medium.ray.direction, medium.ray.t_max, count,
                                static_cast<uint32_t>(done));
    std::fill(rays.pixel.begin(), rays.pixel.end(), pixel);
    flights.resize(count);
    mutant.walk(view, options, modes, 20170502, rays, flights, counts);
    for (std::size_t i = 0; i < count; ++i) {
      const bool second = flights.event[i] == Event::kScatter && flights.component[i] == 1;
      for (int slot = 0; slot < mutant.channels; ++slot) {
        const int channel = mutant.channels == 1 ? kChannelOfTwo : slot;
        statistics[channel].add(second ? flights.weight[slot][i] : 0);
      }
    }
  }
  return statistics;
}

double exactly_scattered_by_second(int channel) {
  const CertifiedMedium& medium = two_components();
  const RayProfile profile(*medium.tight, medium.channels, medium.ray, Interpolation::kNearest);
  double exact = 0;
  profile.visit(0, medium.ray.t_max, [&](const RayProfile::Node& node) {
    exact += node.width * node.transmittance[channel] * node.density[1] *
             medium.channels.components[1].sigma_s[channel];
  });
  return exact;
}

TEST_P(CertifyMutant, ThreePercentInTheChoiceOfAComponentIsNoticed) {
  const Mutant& mutant = GetParam();
  if (!mutant.free_paths) GTEST_SKIP() << "estimators choose none";
  const PlantedFactors planted = {.component = kComponentError};
  const Plan plan = make_plan(scattered_by_second(mutant, {}, kPilotPaths, 1),
                              scattered_by_second(mutant, planted, kPilotPaths, 1));
  ASSERT_LT(plan.paths, kMostPaths) << "hardly matters";
  const auto paths = std::max<uint64_t>(20'000, static_cast<uint64_t>(plan.paths));
  const double expected = exactly_scattered_by_second(plan.channel);
  const auto z = [&](const PlantedFactors& factors) {
    const RunningStatistics found = scattered_by_second(mutant, factors, paths, 2)[plan.channel];
    return std::abs(z_score(found.mean(), found.standard_error(), expected));
  };
  EXPECT_GT(z(planted), 5) << paths << " paths";
  EXPECT_LT(z({}), 4.5) << "without an error, " << paths << " paths";
}

/// A reference method in a homogeneous medium whose extinction is `scale` times too large.
RunningStatistics walk_reference(const std::string& method, bool free_paths, float scale,
                                 uint64_t paths) {
  Component component;
  component.density = make_field(Vec3i(0), Vec3i(7, 0, 0), [](const Vec3i&) { return 1.0F; });
  component.sigma_s = Rgb(0.1F * scale);
  const Medium medium({component});
  WalkSettings settings;
  (free_paths ? settings.tracker : settings.transmittance) = method;
  settings.interpolation = Interpolation::kNearest;
  const Walker walker(medium, settings);
  RunningStatistics statistics;
  FlightStream flights;
  WalkStatistics counts;
  const RayStream rays = repeat_ray(Vec3f(-1, 0, 0), Vec3f(1, 0, 0), 10, paths);
  if (free_paths) {
    walker.free_paths(rays, flights, counts);
  } else {
    walker.transmittance(rays, flights, counts);
  }
  for (std::size_t i = 0; i < paths; ++i) {
    const bool counts_here = !free_paths || flights.event[i] == Event::kEscape;
    statistics.add(counts_here ? flights.weight[0][i] : 0);
  }
  return statistics;
}

// The methods that are no walks know no weight of a collision; theirs is the extinction itself.
TEST(CertifyPower, OnePercentOfTheExtinctionIsNoticedByReferenceMethods) {
  const double expected = std::exp(-0.8);
  const double shift = expected - std::exp(-0.8 * kError);
  const std::vector<std::pair<std::string, bool>> methods = {
      {"regular", true},      {"closed-form", true}, {"regular", false},
      {"closed-form", false}, {"p-series", false},   {"unbiased-ray-marching", false}};
  for (const auto& method : methods) {
    constexpr uint64_t kFew = 4000;
    const RunningStatistics pilot = walk_reference(method.first, method.second, 1, kFew);
    const double wanted = pilot.variance() * std::pow(kWantedShift / shift, 2);
    const auto paths = std::max(kFew, static_cast<uint64_t>(wanted));
    const auto z = [&](float scale) {
      const RunningStatistics found = walk_reference(method.first, method.second, scale, paths);
      const double apart = std::abs(found.mean() - expected);
      return apart < 1e-6 ? 0 : apart / found.standard_error();
    };
    EXPECT_GT(z(kError), 6) << method.first;
    EXPECT_LT(z(1), 4) << method.first;
  }
}

}  // namespace
}  // namespace freepath::testing
