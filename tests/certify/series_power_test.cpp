// The power of the suite's checks on the estimators that are no walks: 1 % planted in their series
// or their roulette must show.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "freepath/transport/ray_medium.h"
#include "freepath/transport/walker.h"
#include "tests/certify/media.h"
#include "tests/certify/planted/p_series.h"
#include "tests/certify/planted/unbiased_ray_marching.h"
#include "tests/statistics.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr uint64_t kSeriesPilotPaths = 20'000;

/// Noise of about two mean free paths, under loose bounds, so that series have terms.
const CertifiedMedium& noise() {
  const std::vector<CertifiedMedium>& media = certified_media();
  return *std::find_if(media.begin(), media.end(),
                       [](const CertifiedMedium& medium) { return medium.name == "dense noise"; });
}

/// Estimates of the transmittance in G.
template <class Method>
RunningStatistics estimate(const Planted& factors, uint64_t paths, uint32_t pixel) {
  planted = factors;
  const MediumChannels channels = noise().channels.only(1);
  const MediumView view = view_of(*noise().loose, Interpolation::kNearest, channels);
  const RayMedium medium(view, 1);
  const CertifiedRay& ray = noise().ray;
  const RayMedium::Path path = medium.enter(Vec3d(ray.origin), Vec3d(ray.direction), ray.t_max);
  std::array<float, kMaxMethodOptions> options{};
  for (std::size_t i = 0; i < Method::kInfo.options.size(); ++i) {
    options[i] = Method::kInfo.options[i].default_value;
  }
  Method method(options);
  RunningStatistics statistics;
  WalkStatistics counts;
  for (uint64_t i = 0; i < paths; ++i) {
    ReferenceFlight<1> flight;
    flight.weight[0] = 1;
    RandomStream random(7, pixel, static_cast<uint32_t>(i), 0);
    method.template fly<1>(medium, path, WalkModes{}, random, flight, counts);
    statistics.add(flight.event == Event::kEscape ? flight.weight[0] : 0);
  }
  planted = {};
  return statistics;
}

template <class Method>
void expect_noticed(const char* name, float Planted::*factor) {
  Planted wrong;
  wrong.*factor = 1.01F;
  const MediumChannels channels = noise().channels.only(1);
  const RayProfile profile(*noise().loose, channels, noise().ray, Interpolation::kNearest);
  const double exact = std::exp(-profile.depth(0));
  const RunningStatistics pilot = estimate<Method>(wrong, kSeriesPilotPaths, 1);
  const double shift = pilot.mean() - estimate<Method>({}, kSeriesPilotPaths, 1).mean();
  ASSERT_NE(shift, 0) << name;
  const double wanted = pilot.variance() * std::pow(7 / shift, 2);
  ASSERT_LT(wanted, 4e6) << name << " hardly matters";
  const auto paths = std::max(kSeriesPilotPaths, static_cast<uint64_t>(wanted));
  const auto z = [&](const Planted& factors) {
    const RunningStatistics found = estimate<Method>(factors, paths, 2);
    return std::abs(z_score(found.mean(), found.standard_error(), exact));
  };
  EXPECT_GT(z(wrong), 5) << name << ", " << paths << " paths";
  EXPECT_LT(z({}), 4) << name << ", " << paths << " paths";
}

TEST(SeriesMutant, OnePerCentInThePowerSeriesIsNoticed) {
  expect_noticed<PlantedPSeries>("order", &Planted::order);
  expect_noticed<PlantedPSeries>("roulette", &Planted::roulette);
}

TEST(SeriesMutant, OnePerCentInUnbiasedRayMarchingIsNoticed) {
  expect_noticed<PlantedUnbiasedRayMarching>("series", &Planted::order);
}

}  // namespace
}  // namespace freepath::testing
