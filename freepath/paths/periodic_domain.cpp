#include "freepath/paths/periodic_domain.h"

#include <algorithm>

#include "freepath/base/error.h"

namespace freepath {

PeriodicDomain::PeriodicDomain(const Box3d& box, const std::array<bool, 3>& repeats)
    : exact_(box), box_(Vec3f(box.min), Vec3f(box.max)), repeats_(repeats) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!repeats[axis] || (box_.min[axis] < box_.max[axis] && std::isfinite(box.size()[axis]))) {
      continue;
    }
    fail(
        "the domain reaches from {} to {} along {}; to repeat there it needs a length that is "
        "finite and above 0",
        box.min[axis], box.max[axis], "xyz"[axis]);
  }
}

Vec3f PeriodicDomain::beyond_side(const Vec3f& origin, const Vec3f& direction, float way) const {
  Vec3f point = origin + direction * way;
  for (int axis = 0; axis < 3; ++axis) {
    const float d = direction[axis];
    const float low = box_.min[axis];
    const float high = box_.max[axis];
    // At edges two sides at once, else the nearer one alone.
    const float left = ((d > 0 ? high : low) - origin[axis]) / d;
    if (repeats_[axis] && d != 0 && left <= way) {
      point[axis] = d > 0 ? low : high;
    } else {
      point[axis] = std::clamp(point[axis], low, high);
    }
  }
  return point;
}

Vec3f PeriodicDomain::fold(const Vec3d& point) const {
  Vec3f folded(point);
  for (int axis = 0; axis < 3; ++axis) {
    if (!repeats_[axis]) continue;
    const double low = exact_.min[axis];
    const double period = exact_.max[axis] - low;
    const double offset = point[axis] - low;
    const double inside = offset - std::floor(offset / period) * period;
    folded[axis] = std::clamp(static_cast<float>(low + inside), box_.min[axis], box_.max[axis]);
  }
  return folded;
}

std::optional<PeriodicDomain::Entry> PeriodicDomain::enter(const Vec3d& origin,
                                                           const Vec3f& direction) const {
  double begin = 0;
  double end = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (repeats_[axis]) continue;
    const double d = direction[axis];
    if (d == 0) {
      if (origin[axis] < exact_.min[axis] || origin[axis] > exact_.max[axis]) return std::nullopt;
      continue;
    }
    const double low = (exact_.min[axis] - origin[axis]) / d;
    const double high = (exact_.max[axis] - origin[axis]) / d;
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  if (!(begin < end)) return std::nullopt;
  Entry entry{fold(origin + Vec3d(direction) * begin), static_cast<float>(begin)};
  for (int axis = 0; axis < 3; ++axis) {
    if (!repeats_[axis]) {
      entry.origin[axis] = std::clamp(entry.origin[axis], box_.min[axis], box_.max[axis]);
    }
  }
  return entry;
}

}  // namespace freepath
