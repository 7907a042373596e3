#pragma once
/// @file The one real root of a rising cubic.

#include <cmath>

namespace freepath {

/// The y with y³ + 3 p y = 2 q, for p ≥ 0: Cardano's formula c - p/c with c³ = q + √(q² + p³),
/// written without the difference, which would cancel for small q.
inline double solve_rising_cubic(double p, double q) {
  const double c = std::cbrt(std::abs(q) + std::sqrt(q * q + p * p * p));
  if (c == 0.0) return 0.0;
  const double other = p / c;
  return 2.0 * q / (c * c + p + other * other);
}

}  // namespace freepath
