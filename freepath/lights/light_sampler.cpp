#include "freepath/lights/light_sampler.h"

#include <algorithm>
#include <array>

#include "freepath/base/random.h"

namespace freepath {
namespace {

/// Cost of a group: power, times the size of what it bounds in space and direction. The squared
/// diagonal stands for the surface, which would vanish for lights in a line.
double cost_of(const LightBounds& bounds) {
  return bounds.power * orientation_cost(bounds) * Vec3d(bounds.box.size()).length2();
}

/// Lights whose centres lie in a slice of a box.
struct Bucket {
  LightBounds bounds;
  std::size_t count = 0;

  void add(const LightBounds& other, std::size_t more) {
    if (more == 0) return;
    bounds = count == 0 ? other : unite(bounds, other);
    count += more;
  }
};

struct Split {
  double cost = std::numeric_limits<double>::infinity();
  int axis = 0;
  float position = 0;
};

constexpr int kBuckets = 12;

/// The cheapest of the planes that part the centres of lights along an axis.
Split split_along(int axis, const Box3f& centres, const std::vector<LightBounds>& lights,
                  const uint32_t* first, const uint32_t* last) {
  const float low = centres.min[axis];
  const float extent = centres.max[axis] - low;
  Split best;
  if (!(extent > 0)) return best;
  std::array<Bucket, kBuckets> buckets;
  for (const uint32_t* light = first; light != last; ++light) {
    const float share = (lights[*light].box.center()[axis] - low) / extent;
    const int bucket = std::clamp(static_cast<int>(share * kBuckets), 0, kBuckets - 1);
    buckets[bucket].add(lights[*light], 1);
  }
  std::array<Bucket, kBuckets> above;  // all buckets from this one on
  above[kBuckets - 1] = buckets[kBuckets - 1];
  for (int i = kBuckets - 2; i > 0; --i) {
    above[i] = buckets[i];
    above[i].add(above[i + 1].bounds, above[i + 1].count);
  }
  // Long boxes are cut across [Conty18].
  const Vec3f size = centres.size();
  const double stretch = std::max({size.x, size.y, size.z}) / extent;
  Bucket below;
  for (int i = 1; i < kBuckets; ++i) {
    below.add(buckets[i - 1].bounds, buckets[i - 1].count);
    if (below.count == 0 || above[i].count == 0) continue;
    const double cost = stretch * (cost_of(below.bounds) + cost_of(above[i].bounds));
    if (cost < best.cost) {
      best = {cost, axis, low + extent * static_cast<float>(i) / kBuckets};
    }
  }
  return best;
}

}  // namespace

LightSampler::LightSampler(const std::vector<LightBounds>& lights) {
  std::vector<uint32_t> order;
  double power = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!(lights[i].power > 0)) continue;
    order.push_back(static_cast<uint32_t>(i));
    power += lights[i].power;
  }
  if (order.empty()) return;
  if (order.size() <= kFewLights) {
    probabilities_.assign(lights.size(), 0.0F);
    for (const uint32_t light : order) {
      probabilities_[light] = static_cast<float>(lights[light].power / power);
    }
    return;
  }
  Lights relative = lights;
  for (LightBounds& light : relative) light.power /= power;
  leaves_.assign(lights.size(), kNone);
  nodes_.reserve(2 * order.size());
  build(relative, &order, 0, order.size(), kNone);
}

void LightSampler::build(const Lights& lights, std::vector<uint32_t>* order, std::size_t first,
                         std::size_t last, uint32_t parent) {
  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({lights[(*order)[first]], parent});
  if (last - first == 1) {
    nodes_[index].light = (*order)[first];
    leaves_[(*order)[first]] = index;
    return;
  }
  Box3f centres;
  for (std::size_t i = first; i < last; ++i) {
    const LightBounds& light = lights[(*order)[i]];
    centres.extendBy(light.box.center());
    if (i > first) nodes_[index].bounds = unite(nodes_[index].bounds, light);
  }
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    const Split split =
        split_along(axis, centres, lights, order->data() + first, order->data() + last);
    if (split.cost < best.cost) best = split;
  }
  const auto begin = order->begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = order->begin() + static_cast<std::ptrdiff_t>(last);
  const auto part = std::partition(begin, end, [&](uint32_t light) {
    return lights[light].box.center()[best.axis] < best.position;
  });
  auto middle = static_cast<std::size_t>(part - order->begin());
  // Lights in one place, or nearly, are parted anyhow.
  if (middle == first || middle == last) middle = first + (last - first) / 2;
  build(lights, order, first, middle, index);
  nodes_[index].second = static_cast<uint32_t>(nodes_.size());
  build(lights, order, middle, last, index);
}

LightChoice LightSampler::choose(const Vec3f& position, float u) const {
  if (!probabilities_.empty()) {
    LightChoice choice;
    for (std::size_t i = 0; i < probabilities_.size(); ++i) {
      if (probabilities_[i] == 0) continue;
      choice = {static_cast<uint32_t>(i), probabilities_[i]};
      if (u < probabilities_[i]) break;
      u -= probabilities_[i];
    }
    return choice;
  }
  if (nodes_.empty()) return {};
  uint32_t node = 0;
  float probability = 1;
  while (nodes_[node].second != kNone) {
    const float first = importance(nodes_[node + 1].bounds, position);
    const float second = importance(nodes_[nodes_[node].second].bounds, position);
    if (!(first + second > 0)) return {};
    const float share = first / (first + second);
    if (u < share) {
      u = std::min(u / share, kOneMinusEpsilon);
      probability *= share;
      node = node + 1;
    } else {
      u = std::min((u - share) / (1.0F - share), kOneMinusEpsilon);
      probability *= second / (first + second);
      node = nodes_[node].second;
    }
  }
  return {nodes_[node].light, probability};
}

float LightSampler::probability(const Vec3f& position, uint32_t light) const {
  if (!probabilities_.empty()) return probabilities_[light];
  if (nodes_.empty() || leaves_[light] == kNone) return 0;
  float probability = 1;
  for (uint32_t node = leaves_[light]; nodes_[node].parent != kNone;) {
    const uint32_t parent = nodes_[node].parent;
    const float first = importance(nodes_[parent + 1].bounds, position);
    const float second = importance(nodes_[nodes_[parent].second].bounds, position);
    const float chosen = node == parent + 1 ? first : second;
    if (!(chosen > 0)) return 0;
    probability *= chosen / (first + second);
    node = parent;
  }
  return probability;
}

}  // namespace freepath
