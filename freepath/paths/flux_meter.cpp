#include "freepath/paths/flux_meter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "freepath/base/turn.h"

namespace freepath {

FluxMeter::FluxMeter(const Box3d& box, int axis, bool rises)
    : box_(box),
      axis_(axis),
      rises_(rises),
      top_(static_cast<float>(rises ? box.max[axis] : box.min[axis])),
      bottom_(static_cast<float>(rises ? box.min[axis] : box.max[axis])),
      sides_{axis == 0 ? 1 : 0, axis == 2 ? 1 : 2} {}

float FluxMeter::way_to_plane(const Vec3f& origin, const Vec3f& direction, uint32_t level) const {
  const float slope = down(direction);
  if (slope > 0 && level < splits.size()) {
    return std::max(0.0F, (splits[level] - depth(origin)) / slope);
  }
  if (slope < 0 && level > 0) return std::max(0.0F, (splits[level - 1] - depth(origin)) / slope);
  return std::numeric_limits<float>::infinity();
}

FluxMeter::Start FluxMeter::start(RandomStream& random) const {
  Start start;
  start.origin[axis_] = top_;
  for (const int side : sides_) {
    const double low = box_.min[side];
    const double position = low + random.uniform() * (box_.max[side] - low);
    start.origin[side] =
        std::clamp(static_cast<float>(position), static_cast<float>(low),
                   std::nextafter(static_cast<float>(box_.max[side]), static_cast<float>(low)));
  }
  if (beam) {
    start.direction = *beam;
    return start;
  }
  // Equal radiance brings a flux in proportion to mu: density 2 mu. Never 0.
  const float mu = std::sqrt(random.uniform());
  const float across = std::sqrt((1.0F - mu) * (1.0F + mu));
  const SinCos azimuth = sincos_of_turn(random.uniform());
  start.direction[axis_] = rises_ ? -mu : mu;
  start.direction[sides_[0]] = across * azimuth.cosine;
  start.direction[sides_[1]] = across * azimuth.sine;
  return start;
}

uint32_t FluxMeter::number(const Vec3f& point, int side) const {
  const int axis = sides_[side];
  const double low = box_.min[axis];
  const double share = (point[axis] - low) / (box_.max[axis] - low);
  const double number = std::clamp(share, 0.0, 1.0) * counts[side];
  return std::min(static_cast<uint32_t>(number), counts[side] - 1);
}

uint32_t FluxMeter::column_left(const Vec3f& origin, const Vec3f& direction,
                                const std::optional<PeriodicDomain>& domain) const {
  if (columns() == 1) return 0;
  const float end = down(direction) > 0 ? bottom_ : top_;
  const double way = (double{end} - origin[axis_]) / direction[axis_];
  const Vec3d point = Vec3d(origin) + Vec3d(direction) * way;
  return column(domain ? domain->fold(point) : Vec3f(point));
}

float FluxMeter::weight_of_view(std::size_t view) const {
  return std::numbers::pi_v<float> / std::abs(down(views[view]));
}

}  // namespace freepath
