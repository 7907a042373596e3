#include "freepath/io/view_transform.h"

#include <algorithm>

namespace freepath {

namespace {

Vec3f neutral(Vec3f color) {
  constexpr float kStart = 0.8F - 0.04F;  // where highlights begin to be compressed
  constexpr float kDesaturation = 0.15F;
  const float least = std::min({color.x, color.y, color.z});
  color -= Vec3f(least < 0.08F ? least - 6.25F * least * least : 0.04F);
  const float peak = std::max({color.x, color.y, color.z});
  if (!(peak > kStart)) return color;
  constexpr float kRoom = 1.0F - kStart;
  const float new_peak = 1.0F - kRoom * kRoom / (peak + kRoom - kStart);
  const float white = 1.0F - 1.0F / (kDesaturation * (peak - new_peak) + 1.0F);
  return color * (new_peak / peak) * (1.0F - white) + Vec3f(new_peak) * white;
}

}  // namespace

Vec3f view_transform(const Vec3f& light, ViewTransform transform) {
  return transform == ViewTransform::kNeutral ? neutral(light) : light;
}

}  // namespace freepath
