#include "freepath/paths/noise_target.h"

#include <algorithm>
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

/// @param variance of the mean of a pixel's channel
template <class Variance>
double noise_by(const Film& film, const Variance& variance) {
  double sum = 0;
  double squares = 0;
  for (std::size_t pixel = 0; pixel < film.pixel_count(); ++pixel) {
    for (int channel = 0; channel < kChannels; ++channel) {
      sum += film.mean(pixel, channel);
      squares += variance(pixel, channel);
    }
  }
  if (squares == 0) return 0;
  const double values = static_cast<double>(film.pixel_count()) * kChannels;
  return std::sqrt(squares / values) / std::abs(sum / values);
}

/// The noise of a picture of as many rounds whose pixels had exactly their shares of the samples:
/// of a few rounds they have more.
double noise_of_shares(const Film& film) {
  return noise_by(film, [&](std::size_t pixel, int channel) {
    const double share = film.share(pixel).value() * film.rounds(pixel);
    return film.variance(pixel, channel) * film.samples(pixel) / share;
  });
}

}  // namespace

uint64_t pilot_seed(uint64_t seed) { return seed ^ kPilotSeed; }

double relative_noise(const Film& film) {
  return noise_by(film,
                  [&](std::size_t pixel, int channel) { return film.variance(pixel, channel); });
}

NoisePlan plan_of_pilot(const Film& pilot, double noise, uint32_t most) {
  NoisePlan plan;
  plan.pilot_samples = pilot.sample_counts().fewest;
  plan.pilot_noise = noise_of_shares(pilot);
  if (!std::isfinite(plan.pilot_noise)) {
    fail("the noise of this picture is not known, as the variance of a pixel is infinite");
  }
  const double limit = most > 0 ? most : kMostSamples;
  const double needed =
      kMargin * plan.pilot_samples * (plan.pilot_noise / noise) * (plan.pilot_noise / noise);
  plan.samples = static_cast<uint32_t>(std::clamp(std::ceil(needed), 2.0, std::max(2.0, limit)));
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
