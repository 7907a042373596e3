#include "freepath/media/phase/tabulated_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "freepath/media/phase/direction_around.h"

namespace freepath {
namespace {

constexpr double kLastAngle = 180.0;  // [degrees]
// Smallest distance of two angles [degrees]: closer ones may have the same cosine.
constexpr double kSmallestStep = 1e-5;
constexpr double kSphere = 4.0 * std::numbers::pi;

/// (1 - cosine) / 2 of two unit vectors, accurate where they are parallel or opposite.
double half_distance(const Vec3f& before, const Vec3f& after) {
  const double ahead = 0.25 * double{(after - before).length2()};
  const double behind = 0.25 * double{(after + before).length2()};
  return ahead < behind ? ahead : std::max(0.0, 1.0 - behind);
}

/// Index of the last point that is not above x, but not that of the very last one.
std::size_t interval(const std::vector<double>& rising, double x) {
  const auto above = std::upper_bound(rising.begin() + 1, rising.end() - 1, x);
  return static_cast<std::size_t>(above - rising.begin()) - 1;
}

}  // namespace

std::optional<PhaseTableFault> find_fault(std::span<const PhaseTablePoint> points) {
  if (points.size() < 2) {
    return PhaseTableFault{0, "a phase function needs two points or more, at 0 and 180 degrees"};
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [angle, value] = points[i];
    if (!std::isfinite(angle)) return PhaseTableFault{i, "the angle is not finite"};
    if (!std::isfinite(value)) return PhaseTableFault{i, "the value is not finite"};
    if (value < 0.0) return PhaseTableFault{i, fmt::format("the value {} is negative", value)};
    if (i == 0 && angle != 0.0) {
      return PhaseTableFault{i, fmt::format("the first angle must be 0 and is {}", angle)};
    }
    if (i > 0 && !(angle - points[i - 1].angle >= kSmallestStep)) {
      return PhaseTableFault{i, fmt::format("angles must rise by {} or more, and {} follows {}",
                                            kSmallestStep, angle, points[i - 1].angle)};
    }
    if (angle > kLastAngle) {
      return PhaseTableFault{i, fmt::format("the angle {} is above 180 degrees", angle)};
    }
    largest = std::max(largest, value);
  }
  const std::size_t last = points.size() - 1;
  if (points[last].angle != kLastAngle) {
    return PhaseTableFault{last,
                           fmt::format("the last angle must be 180 and is {}", points[last].angle)};
  }
  if (largest == 0.0) return PhaseTableFault{last, "all values are 0"};
  return std::nullopt;
}

TabulatedPhase::TabulatedPhase(std::span<const PhaseTablePoint> points) {
  Table table;
  // Scaled first, so that neither tiny nor huge units leave the range of numbers.
  double largest = 0.0;
  for (const PhaseTablePoint& point : points) largest = std::max(largest, point.value);
  for (const PhaseTablePoint& point : points) {
    const double sine = std::sin(0.5 * point.angle * std::numbers::pi / kLastAngle);
    table.h.push_back(sine * sine);
    table.value.push_back(point.value / largest);
  }
  table.h.back() = 1.0;

  // The solid angle between two cones is 4π times the difference of their h.
  table.chance.push_back(0.0);
  double moment = 0.0;  // of h
  for (std::size_t i = 0; i + 1 < table.h.size(); ++i) {
    const double begin = table.h[i];
    const double end = table.h[i + 1];
    const double a = table.value[i];
    const double b = table.value[i + 1];
    table.chance.push_back(table.chance[i] + kSphere * 0.5 * (a + b) * (end - begin));
    moment += kSphere * (end - begin) * (a * (2.0 * begin + end) + b * (begin + 2.0 * end)) / 6.0;
  }
  const double total = table.chance.back();
  for (double& value : table.value) value /= total;
  for (double& chance : table.chance) chance /= total;
  table.mean_cosine = static_cast<float>(1.0 - 2.0 * moment / total);
  table_ = std::make_shared<const Table>(std::move(table));
}

float TabulatedPhase::evaluate(const Vec3f& before, const Vec3f& after) const {
  const Table& table = *table_;
  const double h = half_distance(before, after);
  const std::size_t i = interval(table.h, h);
  const double s = std::clamp((h - table.h[i]) / (table.h[i + 1] - table.h[i]), 0.0, 1.0);
  return static_cast<float>(std::lerp(table.value[i], table.value[i + 1], s));
}

PhaseSample TabulatedPhase::sample(const Vec3f& before, float u1, float u2) const {
  const Table& table = *table_;
  // An interval without chance is never found.
  const std::size_t i = interval(table.chance, u1);
  // The share of the interval's chance before the sample, without the ends, where the density may
  // be 0: no sample has that.
  constexpr double kSmallest = 0x1p-25;
  const double share = std::clamp((u1 - table.chance[i]) / (table.chance[i + 1] - table.chance[i]),
                                  kSmallest, 1.0 - kSmallest);
  const double a = table.value[i];
  const double b = table.value[i + 1];
  // The s for which a s + (b - a) s² / 2 is that share of (a + b) / 2.
  const double s = share * (a + b) / (a + std::sqrt(a * a + share * (b * b - a * a)));
  return {direction_around(before, std::lerp(table.h[i], table.h[i + 1], s), u2),
          static_cast<float>(std::lerp(a, b, s))};
}

}  // namespace freepath
