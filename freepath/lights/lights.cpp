#include "freepath/lights/lights.h"

#include <algorithm>
#include <utility>

namespace freepath {

Lights::Lights(Environment environment, const std::optional<Sun>& sun)
    : environment_(std::move(environment)), sun_(sun) {
  // In an isotropic medium a light counts by its fluence: the integral of its radiance over all
  // directions, which for the sun is its irradiance.
  const double around =
      luminance(std::visit([](const auto& light) { return light.fluence(); }, environment_));
  const double direct = sun_ ? luminance(sun_->irradiance()) : 0;
  dark_ = around == 0 && direct == 0;
  if (direct == 0) return;
  if (around == 0) {
    sun_share_ = 1;
    return;
  }
  // Either may count for more where the other is in shadow.
  constexpr double kSmallestShare = 0.1;
  sun_share_ = static_cast<float>(
      std::clamp(direct / (direct + around), kSmallestShare, 1 - kSmallestShare));
}

}  // namespace freepath
