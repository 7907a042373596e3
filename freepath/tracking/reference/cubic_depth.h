#pragma once
/// @file The optical depth along a stretch whose extinction is a cubic.

#include <algorithm>
#include <array>
#include <cmath>

namespace freepath {

/// Σ_j c_j s^j, s in [0,1].
using Cubic = std::array<double, 4>;

inline double value_at(const Cubic& c, double s) {
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

/// ∫_0^s, a quartic.
inline double integral_to(const Cubic& c, double s) {
  return s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * (c[3] / 4))));
}

/// The s with integral_to(c, s) = wanted, for a cubic ≥ 0 on [0,1] and 0 ≤ wanted ≤ its integral:
/// Newton's method inside a bracket, which takes the middle where Newton would leave it.
inline double invert_integral(const Cubic& c, double wanted) {
  const double total = integral_to(c, 1);
  double low = 0;
  double high = 1;
  double s = total > 0 ? std::clamp(wanted / total, 0.0, 1.0) : 0.0;
  constexpr int kMaxSteps = 60;  // bisection alone reaches the last bit of s
  for (int step = 0; step < kMaxSteps; ++step) {
    const double error = integral_to(c, s) - wanted;
    if (std::abs(error) <= 1e-14 * total) break;
    (error > 0 ? high : low) = s;
    const double slope = value_at(c, s);
    const double newton = slope > 0 ? s - error / slope : -1;
    s = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return s;
}

}  // namespace freepath
