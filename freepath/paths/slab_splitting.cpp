#include "freepath/paths/slab_splitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace freepath {
namespace {

/// Whether a symmetric tridiagonal matrix without diagonal has an eigenvalue above x, by the signs
/// of the pivots of (matrix - x) (Sylvester's law of inertia).
/// @param squares of the entries beside the diagonal
bool has_eigenvalue_above(double x, std::span<const double> squares) {
  double pivot = -x;
  for (const double square : squares) {
    if (pivot >= 0) return true;
    pivot = -x - square / pivot;
  }
  return pivot >= 0;
}

}  // namespace

std::vector<double> legendre_moments(const PhaseFunction& phase, int count) {
  // Midpoints of the angle: peaks forward and backward are resolved to a fifth of a degree.
  constexpr int kAngles = 1024;
  std::vector<double> moments(count, 0.0);
  for (int i = 0; i < kAngles; ++i) {
    const double angle = (i + 0.5) * std::numbers::pi / kAngles;
    const double mu = std::cos(angle);
    const double sine = std::sin(angle);
    const double density =
        phase.evaluate(Vec3f(0, 0, 1), Vec3f(static_cast<float>(sine), 0, static_cast<float>(mu)));
    const double share = density * sine;
    double before = 0;
    double legendre = 1;
    for (int l = 0; l < count; ++l) {
      moments[l] += share * legendre;
      const double next = ((2 * l + 1) * mu * legendre - l * before) / (l + 1);
      before = legendre;
      legendre = next;
    }
  }
  const double whole = moments[0];
  for (double& moment : moments) moment /= whole;
  return moments;
}

double relaxation_exponent(double albedo, std::span<const double> moments) {
  if (!(albedo < 1)) return 0;
  const auto h = [&](std::size_t l) {
    return (2 * static_cast<double>(l) + 1) * (1 - albedo * moments[l]);
  };
  std::vector<double> squares;
  for (std::size_t l = 1; l < moments.size(); ++l) {
    const auto order = static_cast<double>(l);
    squares.push_back(order * order / (h(l - 1) * h(l)));
  }
  double low = 1;  // unscattered light's
  if (!has_eigenvalue_above(low, squares)) return 1;
  double high = 2;
  while (has_eigenvalue_above(high, squares)) high *= 2;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (has_eigenvalue_above(middle, squares) ? low : high) = middle;
  }
  return 1 / low;
}

}  // namespace freepath
