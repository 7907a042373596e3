#include "freepath/study/render_target.h"

#include <algorithm>

namespace freepath {
namespace {

bool says_biased(const std::string& method, std::span<const MethodInfo> infos) {
  const std::string_view name = std::string_view(method).substr(0, method.find(':'));
  return std::any_of(infos.begin(), infos.end(),
                     [&](const MethodInfo& info) { return info.name == name && info.biased; });
}

}  // namespace

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
