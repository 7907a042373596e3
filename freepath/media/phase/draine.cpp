#include "freepath/media/phase/draine.h"

#include <numbers>

#include "freepath/media/phase/cubic.h"
#include "freepath/media/phase/direction_around.h"

namespace freepath {

Draine::Draine(float g, float alpha)
    : sharpness_(std::abs(g)),
      sign_(std::copysign(1.0F, g)),
      gap_(1.0F - std::abs(g)),
      alpha_(alpha),
      scale_(gap_ * (1.0F + sharpness_) /
             (4.0F * std::numbers::pi_v<float> *
              (1.0F + alpha * (1.0F + 2.0F * sharpness_ * sharpness_) / 3.0F))) {}

float Draine::mean_cosine() const {
  const float g2 = sharpness_ * sharpness_;
  return sign_ * sharpness_ * (1.0F + alpha_ * (3.0F + 2.0F * g2) / 5.0F) /
         (1.0F + alpha_ * (1.0F + 2.0F * g2) / 3.0F);
}

// The distribution function leads to a quartic with a closed solution [Jendersie23]. As published,
// in w = √(1 + g² - 2 g cosine), three of its roots meet at w = 1 as g goes to 0, and the result
// is divided by g. Here w = 1 - g v: as the cosine, v = cosine - g (1 - v²) / 2 runs from -1 to 1,
// and the integral of the density over it is proportional to
//
//     F(v) = (v + alpha (4 v³ + g (3 + 6 v² - v⁴)) / 12) / (1 - g v).
//
// F(v) = t, with k = 12 / alpha, is a quartic in w without a cubic term. Its resolvent cubic for
// the square z of the sum of two roots, with z = 4 (1 + g²) + g y, is a rising cubic in y that
// keeps its form down to g = 0. The two real roots of the quartic have the sum -√z; the larger one
// is w. Both square roots are taken as 1 + g times something, so that g cancels by hand.

/// h = (1 - cosine) / 2 as measured from the peak, below which lies the fraction u of all samples.
double Draine::quantile(double u) const {
  const double g = sharpness_;
  const double a = alpha_;
  const double g2 = g * g;
  const double total = 2.0 * (1.0 + a * (1.0 + 2.0 * g2) / 3.0) / ((1.0 - g) * (1.0 + g));
  const double t = (1.0 + a * (1.0 + 2.0 * g) / 3.0) / (1.0 - g) - u * total;
  double v = t / (1.0 + g * t);
  // A smaller alpha changes no digit of a float.
  if (constexpr double kSmallestAlpha = 1e-7; a > kSmallestAlpha) {
    const double k = 12.0 / a;
    const double b = 1.0 + g * t;
    const double constant =
        g * (48.0 + 64.0 * g2 - 8.0 * k - k * k * b * b) - 8.0 * k * t * (2.0 + 3.0 * g2);
    const double y = solve_rising_cubic(4.0 / 3.0 * k, -0.5 * constant);
    // √z = 2 (1 + g half_sum), and the root of the discriminant is 4 (1 + g half_difference).
    const double excess = g + 0.25 * y;
    const double half_sum = excess / (1.0 + std::sqrt(std::max(0.0, 1.0 + g * excess)));
    const double rest =
        (8.0 * g - y + (g * (12.0 + k * b) - 8.0 * half_sum) / (1.0 + g * half_sum)) / 16.0;
    const double half_difference = rest / (1.0 + std::sqrt(std::max(0.0, 1.0 + g * rest)));
    v = half_sum - 2.0 * half_difference;
  }
  v = std::clamp(v, -1.0, 1.0);
  return 0.5 * (1.0 - v) * (1.0 - 0.5 * g * (1.0 + v));
}

PhaseSample Draine::sample(const Vec3f& before, float u1, float u2) const {
  const double h = quantile(u1);
  return {direction_around(before * sign_, h, u2), evaluate_at(static_cast<float>(4.0 * h))};
}

}  // namespace freepath
