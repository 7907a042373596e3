#include "freepath/media/phase/droplets.h"

#include <cmath>

#include "freepath/media/phase/stretched.h"

namespace freepath {
namespace {

/// The fit in double precision: g_hg, g_d, alpha, weight.
struct Fit {
  double g_hg, g_d, alpha, weight;
};

Fit fit_below_a_tenth(double d) {
  return {13.8 * d * d, 1.1456 * d * std::sin(9.29044 * d), 250.0,
          0.252977 - 312.983 * std::pow(d, 4.3)};
}

Fit fit_below_one_and_a_half(double d) {
  const double log_d = std::log(d);
  const double inner = (log_d - 0.238604) * (log_d + 1.00667) / (0.507522 - 0.15677 * log_d);
  return {0.862 - 0.143 * log_d * log_d,
          0.379685 * std::cos(1.19692 * std::cos(inner) + 1.37932 * log_d + 0.0625835) + 0.344213,
          250.0, 0.146209 * std::cos(3.38707 * log_d + 2.11193) + 0.316072 + 0.0778917 * log_d};
}

Fit fit_below_five(double d) {
  const double log_d = std::log(d);
  const double log_log_d = std::log(log_d);
  return {0.0604931 * log_log_d + 0.940256,
          0.500411 - 0.081287 / (1.27551 - 2.0 * log_d + std::tan(log_d)),
          7.30354 * log_d + 6.31675,
          0.026914 * (log_d - std::cos(5.68947 * (log_log_d - 0.0292149))) + 0.376475};
}

Fit fit_from_five(double d) {
  return {std::exp(-0.0990567 / (d - 1.67154)), std::exp(-2.20679 / (d + 3.91029) - 0.428934),
          std::exp(3.62489 - 8.29288 / (d + 5.52825)),
          std::exp(-0.599085 / (d - 0.641583) - 0.665888)};
}

}  // namespace

// The constants are those of [Jendersie23].
Droplets::Parameters Droplets::fit(float diameter) {
  const double d = diameter;
  const Fit fit = d < 0.1   ? fit_below_a_tenth(d)
                  : d < 1.5 ? fit_below_one_and_a_half(d)
                  : d < 5.0 ? fit_below_five(d)
                            : fit_from_five(d);
  return {static_cast<float>(fit.g_hg), static_cast<float>(fit.g_d), static_cast<float>(fit.alpha),
          static_cast<float>(fit.weight)};
}

Droplets::Droplets(const Parameters& parameters)
    : peak_(parameters.g_hg), rest_(parameters.g_d, parameters.alpha), weight_(parameters.weight) {}

PhaseSample Droplets::sample(const Vec3f& before, float u1, float u2) const {
  // The azimuth pays for the choice: it needs fewer digits than the angle from the peak.
  const float peak = 1.0F - weight_;
  const PhaseSample drawn = u2 < peak ? peak_.sample(before, u1, stretched(u2, 0.0F, peak))
                                      : rest_.sample(before, u1, stretched(u2, peak, weight_));
  return {drawn.direction, evaluate(before, drawn.direction)};
}

}  // namespace freepath
