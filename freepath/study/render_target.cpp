#include "freepath/study/render_target.h"

#include <algorithm>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath {
namespace {

bool says_biased(const std::string& method, std::span<const MethodInfo> infos) {
  const std::string_view name = std::string_view(method).substr(0, method.find(':'));
  return std::any_of(infos.begin(), infos.end(),
                     [&](const MethodInfo& info) { return info.name == name && info.biased; });
}

}  // namespace

RenderTarget target_of(const std::shared_ptr<PathScene>& scene, ColorMode color) {
  RenderTarget target;
  target.width = scene->camera->width();
  target.height = scene->camera->height();
  target.render = [scene, color](const RenderSettings& settings, const ProgressFunction& progress) {
    return render_scene(*scene, color, settings, progress);
  };
  target.render_reference = [scene, color](const RenderSettings& settings,
                                           const ProgressFunction& progress) {
    // Put back whatever happens.
    const auto put_back = [&](const SampleKind* kind) { scene->samples = *kind; };
    const SampleKind own = std::exchange(scene->samples, SampleKind::kIndependent);
    const std::unique_ptr<const SampleKind, decltype(put_back)> guard(&own, put_back);
    return render_scene(*scene, color, settings, progress);
  };
  return target;
}

std::vector<Configuration> all_configurations(const std::vector<std::string>& trackers,
                                              const std::vector<std::string>& transmittances,
                                              const std::vector<Interpolation>& interpolations,
                                              const std::string& automatic) {
  std::vector<Configuration> configurations;
  for (const std::string& tracker : trackers) {
    for (const std::string& transmittance : transmittances) {
      for (const Interpolation interpolation : interpolations) {
        Configuration configuration{is_automatic(tracker) ? automatic : tracker, transmittance,
                                    interpolation};
        if (std::find(configurations.begin(), configurations.end(), configuration) !=
            configurations.end()) {
          fail("--trackers: {} is given twice{}", configuration.tracker,
               is_automatic(tracker) ? " (auto stands for it here)" : "");
        }
        configurations.push_back(std::move(configuration));
      }
    }
  }
  return configurations;
}

bool is_biased(const Configuration& configuration) {
  return says_biased(configuration.tracker, tracker_infos()) ||
         says_biased(configuration.transmittance, transmittance_infos());
}

std::string_view to_string(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::kNearest:
      return "nearest";
    case Interpolation::kTrilinear:
      return "trilinear";
    case Interpolation::kStochastic:
      break;
  }
  return "stochastic";
}

}  // namespace freepath
