#include "freepath/study/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "freepath/base/error.h"
#include "freepath/base/threads.h"
#include "freepath/study/pixel_estimates.h"
#include "freepath/study/process_time.h"
#include "freepath/study/run_seed.h"

namespace freepath {
namespace {

/// Standard error of a pixel over the picture's mean, squared.
double squared_noise(const PixelEstimates& picture) {
  const auto mean_of = [](const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  const double mean = mean_of(picture.mean);
  return mean > 0 ? mean_of(picture.variance) / (mean * mean) : 0;
}

RenderSettings settings_of(const PilotSettings& settings, const PilotCandidate& candidate,
                           uint64_t seed) {
  RenderSettings render = settings.render;
  render.walk.tracker = candidate.configuration.tracker;
  render.walk.transmittance = candidate.configuration.transmittance;
  render.walk.interpolation = candidate.configuration.interpolation;
  render.walk.seed = seed;
  render.samples = 0;
  render.time_limit = settings.time / settings.rounds;
  render.whole_passes = true;
  render.layers = {Layer::kVariance, Layer::kSamples};
  return render;
}

/// Sums over the rounds of a candidate.
struct PilotTally {
  double cpu_seconds = 0;
  uint64_t samples = 0, lookups = 0, overflows = 0;
  std::vector<double> costs;
};

/// One round; an Error becomes the refusal.
/// @return false if the caller wished to stop
bool run_round(const RenderTarget& target, const PilotSettings& settings, uint64_t seed,
               const ProgressFunction& progress, PilotResult& result, PilotTally& tally) {
  const double cpu_before = settings.cpu_clock();
  try {
    const RenderResult rendered =
        target.render(settings_of(settings, result.candidate, seed), progress);
    if (rendered.interrupted) return false;
    // Of a small picture's passes some threads go without work at the end, of a large one's not.
    const double cpu_seconds = settings.cpu_clock() - cpu_before;
    const int threads = Threads(settings.render.threads).count();
    tally.cpu_seconds += cpu_seconds;
    tally.samples += uint64_t{rendered.samples} * rendered.film.width() * rendered.film.height();
    tally.overflows += rendered.counts.overflows;
    tally.lookups += rendered.counts.statistics().lookups;
    tally.costs.push_back(cpu_seconds / threads * squared_noise(estimates_of(rendered.film)));
  } catch (const Error& error) {
    result.refusal = error.what();
  }
  return true;
}

}  // namespace

std::optional<Interval> PilotResult::seconds_to(double noise) const {
  if (!cost) return {};
  Interval seconds = *cost;
  const double scale = 1 / (noise * noise);
  seconds.value *= scale;
  if (seconds.low) seconds.low = *seconds.low * scale;
  if (seconds.high) seconds.high = *seconds.high * scale;
  return seconds;
}

std::vector<PilotResult> run_pilots(const RenderTarget& target,
                                    const std::vector<PilotCandidate>& candidates,
                                    const PilotSettings& settings,
                                    const std::function<bool(double)>& progress) {
  std::vector<PilotResult> results;
  for (const PilotCandidate& candidate : candidates) {
    PilotResult& result = results.emplace_back();
    result.candidate = candidate;
    result.is_biased = is_biased(candidate.configuration);
  }
  std::vector<PilotTally> tallies(candidates.size());
  const auto steps = static_cast<double>(candidates.size() * settings.rounds);
  for (int round = 0; round < settings.rounds; ++round) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!results[i].refusal.empty()) continue;
      const double fraction = (static_cast<double>(round) * static_cast<double>(candidates.size()) +
                               static_cast<double>(i)) /
                              steps;
      const ProgressFunction watch = [&](const RenderProgress&) {
        return !progress || progress(fraction);
      };
      const RenderTarget& own = candidates[i].target != nullptr ? *candidates[i].target : target;
      if (!run_round(own, settings, run_seed(settings.seed, i, round), watch, results[i],
                     tallies[i])) {
        fail("interrupted");
      }
    }
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto paths = static_cast<double>(std::max<uint64_t>(tallies[i].samples, 1));
    results[i].lookups_per_path = static_cast<double>(tallies[i].lookups) / paths;
    results[i].nanoseconds_per_path = 1e9 * tallies[i].cpu_seconds / paths;
    results[i].overflows = tallies[i].overflows;
    results[i].cost = geometric_interval(tallies[i].costs);
  }
  return results;
}

std::optional<std::size_t> cheapest(const std::vector<PilotResult>& results) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].is_biased || results[i].overflows > 0 || !results[i].cost) continue;
    if (!best || results[i].cost->value < results[*best].cost->value) best = i;
  }
  return best;
}

}  // namespace freepath
