#include "freepath/paths/time_target.h"

#include <algorithm>

#include "freepath/paths/noise_target.h"

namespace freepath {
namespace {

constexpr double kShareOfTime = 0.05;
/// Of the time that is left, which is used: the pilot knows a sample's cost to some percent.
constexpr double kUsed = 0.97;

}  // namespace

TimePlan plan_time(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                   const ProgressFunction& progress) {
  if (settings.time_limit < kShortestPlannedTime) return {};
  RenderSettings pilot = pilot_settings(settings);
  pilot.time_limit = kShareOfTime * settings.time_limit;
  const RenderResult result = render_scene(scene, mode, pilot, progress);
  TimePlan plan{0, result.seconds};
  if (result.samples == 0 || result.interrupted) return plan;
  double samples = 0;
  for (std::size_t pixel = 0; pixel < result.film.pixel_count(); ++pixel) {
    samples += result.film.rounds(pixel);
  }
  samples /= static_cast<double>(result.film.pixel_count());
  const double left = std::max(0.0, settings.time_limit - result.seconds);
  const double allowed = kUsed * left * samples / result.seconds;
  constexpr double kMost = 1U << 30;
  const double most = settings.samples > 0 ? settings.samples : kMost;
  plan.samples = static_cast<uint32_t>(std::clamp(allowed, 1.0, most));
  return plan;
}

}  // namespace freepath
