#include "freepath/spectra/rgb_spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "freepath/base/error.h"
#include "freepath/spectra/reflectance_table.h"

namespace freepath {
namespace {

double sigmoid(double x) {
  if (std::isinf(x)) return x > 0 ? 1 : 0;
  return 0.5 + 0.5 * x / std::sqrt(1 + x * x);
}

/// The x with sigmoid(x) = value, for a value in [0, 1]; infinite at both ends.
double sigmoid_inverse(double value) {
  const double product = value * (1 - value);
  if (product > 0) return (value - 0.5) / std::sqrt(product);
  return std::copysign(std::numeric_limits<double>::infinity(), value - 0.5);
}

/// How far a polynomial is from a colour, and what a step towards it is made of.
struct Misfit {
  Vec3d residual;       ///< RGB of the polynomial minus the wanted one.
  Matrix3d derivative;  ///< Row i: d RGB / d c_i.

  double squared() const { return residual.dot(residual); }
};

Misfit misfit_of(const SigmoidPolynomial& polynomial, const Vec3d& rgb,
                 const RgbColorSpace& space) {
  Vec3d found(0), by_square(0), by_linear(0), by_constant(0);
  const auto weights = space.reflectance_weights();
  const auto [c0, c1, c2] = polynomial.c;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double u = 2.0 * static_cast<double>(i) / static_cast<double>(weights.size() - 1) - 1;
    const double x = (c0 * u + c1) * u + c2;
    const double inverse_root = 1 / std::sqrt(1 + x * x);
    found += weights[i] * (0.5 + 0.5 * x * inverse_root);
    const Vec3d slope = weights[i] * (0.5 * inverse_root * inverse_root * inverse_root);
    by_constant += slope;
    by_linear += slope * u;
    by_square += slope * (u * u);
  }
  return {found - rgb,
          {by_square.x, by_square.y, by_square.z, by_linear.x, by_linear.y, by_linear.z,
           by_constant.x, by_constant.y, by_constant.z}};
}

/// The step that minimises the squared residual of the linearised colour, with the diagonal of the
/// normal equations raised by the fraction `damping`.
Vec3d damped_step(const Misfit& misfit, double damping) {
  Matrix3d normal = misfit.derivative * misfit.derivative.transposed();
  for (int i = 0; i < 3; ++i) {
    // The constant keeps a direction that nothing depends on any more from being singular.
    normal[i][i] += damping * normal[i][i] + 1e-18;
  }
  const Vec3d gradient = misfit.residual * misfit.derivative.transposed();
  return -gradient * normal.inverse();
}

bool is_nonnegative(const Vec3d& rgb) {
  return std::isfinite(rgb.x) && std::isfinite(rgb.y) && std::isfinite(rgb.z) && rgb.x >= 0 &&
         rgb.y >= 0 && rgb.z >= 0;
}

}  // namespace

double SigmoidPolynomial::coordinate(double wavelength) {
  constexpr double kMiddle = 0.5 * (kShortestWavelength + kLongestWavelength);
  constexpr double kHalf = 0.5 * (kLongestWavelength - kShortestWavelength);
  return (wavelength - kMiddle) / kHalf;
}

double SigmoidPolynomial::operator()(double wavelength) const {
  const double u = coordinate(wavelength);
  return sigmoid((c[0] * u + c[1]) * u + c[2]);
}

SigmoidPolynomial fit_reflectance(const Vec3d& rgb, const RgbColorSpace& space) {
  const double largest = std::max({rgb.x, rgb.y, rgb.z});
  if (!is_nonnegative(rgb) || largest > 1) {
    fail("RGB of a reflectance has to be in [0, 1], not ({}, {}, {})", rgb.x, rgb.y, rgb.z);
  }
  if (rgb.x == rgb.y && rgb.y == rgb.z) return {{0, 0, sigmoid_inverse(rgb.x)}};

  constexpr int kMostSteps = 100;
  constexpr double kPrecision = 1e-6;  // of the largest component
  constexpr double kMostDamping = 1e12;
  const double grey = std::clamp((rgb.x + rgb.y + rgb.z) / 3, 0.01, 0.99);
  SigmoidPolynomial best = {{0, 0, sigmoid_inverse(grey)}};
  Misfit misfit = misfit_of(best, rgb, space);
  const double near_enough = kPrecision * kPrecision * largest * largest;
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    if (misfit.squared() < near_enough) break;
    const Vec3d change = damped_step(misfit, damping);
    const SigmoidPolynomial next = {
        {best.c[0] + change.x, best.c[1] + change.y, best.c[2] + change.z}};
    const Misfit next_misfit = misfit_of(next, rgb, space);
    // Written so that a NaN is refused.
    if (next_misfit.squared() < misfit.squared()) {
      best = next;
      misfit = next_misfit;
      damping *= 0.1;
    } else {
      damping *= 10;
    }
  }
  return best;
}

RgbSpectrum RgbSpectrum::reflectance(const Vec3d& rgb, const RgbColorSpace& space) {
  return {space.reflectances()(rgb), 1, rgb, space};
}

RgbSpectrum RgbSpectrum::unbounded(const Vec3d& rgb, const RgbColorSpace& space) {
  if (!is_nonnegative(rgb)) {
    fail("RGB has to be finite and not negative, not ({}, {}, {})", rgb.x, rgb.y, rgb.z);
  }
  const double scale = 2 * std::max({rgb.x, rgb.y, rgb.z});
  if (scale == 0) return {{}, 0, rgb, space};
  return {space.reflectances()(rgb / scale), scale, rgb, space};
}

RgbSpectrum RgbSpectrum::illuminant(const Vec3d& rgb, const RgbColorSpace& space) {
  RgbSpectrum result = unbounded(rgb, space);
  result.is_light_ = true;
  return result;
}

}  // namespace freepath
