#include "freepath/spectra/reflectance_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace freepath {
namespace {

constexpr int kLast = ReflectanceTable::kSize - 1;

/// The published fits let no coefficient grow beyond this. So black and white are finite, and of
/// colours near white as much comes back as with pbrt.
constexpr double kLargestCoefficient = 200;

double smooth_step(double x) { return x * x * (3 - 2 * x); }

/// Which component is the largest; of equal ones the last, as in the published tables.
int index_of_largest(const Vec3d& rgb) {
  int largest = 0;
  for (int i = 1; i < 3; ++i) {
    if (rgb[i] >= rgb[largest]) largest = i;
  }
  return largest;
}

/// The interval between nodes in which a coordinate lies, and where in it.
struct Interval {
  int left = 0;
  double share = 0;  ///< Of the right node, in [0, 1].
};

Interval interval_of(double coordinate) {
  const int left = std::min(static_cast<int>(coordinate), kLast - 1);
  return {left, coordinate - left};
}

Interval slices_around(double largest) {
  static const std::array<double, ReflectanceTable::kSize> kLevels = [] {
    std::array<double, ReflectanceTable::kSize> levels;
    for (int i = 0; i <= kLast; ++i) levels[i] = ReflectanceTable::level(i);
    return levels;
  }();
  const auto above = std::upper_bound(kLevels.begin(), kLevels.end(), largest);
  const int left = std::min(static_cast<int>(above - kLevels.begin()) - 1, kLast - 1);
  return {left, (largest - kLevels[left]) / (kLevels[left + 1] - kLevels[left])};
}

}  // namespace

double ReflectanceTable::level(int slice) {
  return smooth_step(smooth_step(static_cast<double>(slice) / kLast));
}

SigmoidPolynomial ReflectanceTable::at(const Node& node) const {
  const auto key = static_cast<uint32_t>(
      ((node.largest * kSize + node.slice) * kSize + node.second) * kSize + node.third);
  const auto found = nodes_.find(key);
  if (found != nodes_.end()) return found->second;
  const double largest = level(node.slice);
  Vec3d rgb;
  rgb[node.largest] = largest;
  rgb[(node.largest + 1) % 3] = largest * node.second / kLast;
  rgb[(node.largest + 2) % 3] = largest * node.third / kLast;
  SigmoidPolynomial polynomial = fit_reflectance(rgb, space_);
  if (node.second == kLast && node.third == kLast) {
    polynomial.c[2] = std::clamp(polynomial.c[2], -kLargestCoefficient, kLargestCoefficient);
  }
  // Where another thread was faster, it has found the same.
  return nodes_.emplace(key, polynomial).first->second;
}

SigmoidPolynomial ReflectanceTable::operator()(const Vec3d& rgb) const {
  const int largest = index_of_largest(rgb);
  const double size = rgb[largest];
  const bool grey = rgb.x == rgb.y && rgb.y == rgb.z;
  // Written so that the fit refuses what is no colour, NaN too.
  if (grey || !(size >= level(1) && size <= 1 && rgb.x >= 0 && rgb.y >= 0 && rgb.z >= 0)) {
    return fit_reflectance(rgb, space_);
  }
  const Interval slice = slices_around(size);
  const Interval second = interval_of(rgb[(largest + 1) % 3] * kLast / size);
  const Interval third = interval_of(rgb[(largest + 2) % 3] * kLast / size);
  SigmoidPolynomial sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1;
    const int b = corner >> 1 & 1;
    const int c = corner >> 2;
    const double weight = (a != 0 ? second.share : 1 - second.share) *
                          (b != 0 ? third.share : 1 - third.share) *
                          (c != 0 ? slice.share : 1 - slice.share);
    if (weight == 0) continue;  // nor is such a node fitted
    const SigmoidPolynomial node = at({largest, slice.left + c, second.left + a, third.left + b});
    for (int i = 0; i < 3; ++i) sum.c[i] += weight * node.c[i];
  }
  return sum;
}

}  // namespace freepath
