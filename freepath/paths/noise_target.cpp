#include "freepath/paths/noise_target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// Seeds of pilots differ from those of their pictures.
constexpr uint64_t kPilotSeed = 0x6A09E667F3BCC908U;
constexpr double kShareOfPilot = 1.0 / 16;
/// More samples than the pilot asks for, by its own noise and that of the picture.
constexpr double kMargin = 1.05;
constexpr double kMostSamples = 1U << 30;

/// The variance of single samples of a film's pixels, summed over those of each share.
using VarianceOfShares = std::array<double, SampleShare::kSteps>;

VarianceOfShares variance_of_shares(const Film& film) {
  VarianceOfShares sums{};
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    for (int channel = 0; channel < kChannels; ++channel) {
      sums[film.share(pixel).step()] += film.variance(pixel, channel) * film.samples(pixel);
    }
  }
  return sums;
}

/// The sum of the variances of the pixels' means after so many rounds.
double variance_after(const VarianceOfShares& sums, uint32_t rounds) {
  double sum = 0;
  for (uint8_t step = 0; step < SampleShare::kSteps; ++step) {
    sum += sums[step] / SampleShare(step).samples(rounds);
  }
  return sum;
}

/// The mean of a film's channels and pixels.
double mean_of(const Film& film) {
  double sum = 0;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    for (int channel = 0; channel < kChannels; ++channel) sum += film.mean(pixel, channel);
  }
  return sum / (static_cast<double>(film.pixel_count()) * kChannels);
}

/// The number of channels and pixels.
double count_of(const Film& film) { return static_cast<double>(film.pixel_count()) * kChannels; }

}  // namespace

uint64_t pilot_seed(uint64_t seed) { return seed ^ kPilotSeed; }

double relative_noise(const Film& film) {
  double variance = 0;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    for (int channel = 0; channel < kChannels; ++channel) variance += film.variance(pixel, channel);
  }
  return variance == 0 ? 0 : std::sqrt(variance / count_of(film)) / std::abs(mean_of(film));
}

NoisePlan plan_of_pilot(const Film& pilot, double noise, uint32_t most) {
  NoisePlan plan;
  plan.pilot_samples = pilot.sample_counts().fewest;
  plan.pilot_noise = relative_noise(pilot);
  if (!std::isfinite(plan.pilot_noise)) {
    fail("the noise of this picture is not known, as the variance of a pixel is infinite");
  }
  const double limit = most > 0 ? most : kMostSamples;
  const VarianceOfShares sums = variance_of_shares(pilot);
  const double wanted = std::pow(noise * mean_of(pilot), 2) * count_of(pilot) / kMargin;
  uint32_t too_few = 1;
  auto enough = static_cast<uint32_t>(std::max(2.0, limit));
  while (enough - too_few > 1) {
    const uint32_t middle = too_few + (enough - too_few) / 2;
    (variance_after(sums, middle) > wanted ? too_few : enough) = middle;
  }
  plan.samples = enough;
  plan.is_known = plan.pilot_samples >= kShareOfPilot * plan.samples;
  return plan;
}

RenderSettings pilot_settings(const RenderSettings& settings) {
  RenderSettings pilot = settings;
  pilot.walk.seed = pilot_seed(pilot.walk.seed);
  pilot.first_sample = 0;
  pilot.samples = 0;
  pilot.time_limit = 0;
  pilot.whole_passes = false;
  pilot.layers = {};
  pilot.buckets = {};
  pilot.on_pass = {};
  pilot.on_checkpoint = {};
  pilot.before = {};
  return pilot;
}

NoisePlan plan_noise(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                     double noise, const ProgressFunction& progress) {
  RenderSettings pilot = pilot_settings(settings);
  for (pilot.samples = kFirstPilot;; pilot.samples *= 2) {
    RenderResult result = render_scene(scene, mode, pilot, progress);
    if (result.interrupted) return {.interrupted = true};
    const NoisePlan plan = plan_of_pilot(result.film, noise, settings.samples);
    if (plan.is_known) return plan;
    pilot.before = std::make_shared<RenderedBefore>(
        RenderedBefore{std::move(result.film), result.counts, result.seconds});
  }
}

}  // namespace freepath
