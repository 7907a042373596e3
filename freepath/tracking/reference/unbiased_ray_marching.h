#pragma once
/// @file Unbiased ray marching: transmittance from several jittered optical depths.

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "freepath/tracking/method.h"
#include "freepath/tracking/reference/residual_segments.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath {

/// n + 1 independent estimates X_i of -∫mu^r, each from equidistant points under one jitter. One of
/// them, the pivot X_j, stands inside an exponential; the others make up for it by the power series
/// around it, in which powers are elementary symmetric means; the mean over all pivots is taken:
///
///     exp(-control) · mean_j exp(X_j) Σ_{k≤n} m_k({X_i - X_j : i ≠ j}) / (k! P(n ≥ k))
///
/// [Kettunen21], with their "aggressive Bhanot-Kennedy" roulette: order 0 alone with
/// probability 0.9, else 2 orders, and on with probability 2/k. Points are spread over the part of
/// the ray where the super-voxels' minima leave a residual. Endpoint matching is left out: it adds
/// look-ups, and where super-voxels have cut the border off it has nothing to match.
///
/// Unbiased always: given the pivot, the series is that of exp(-∫mu^r - X_j) in independent terms.
/// Estimates may be negative.
class UnbiasedRayMarching {
 public:
  static constexpr MethodOption kOptions[] = {
      {"order-zero", 0.9F, 0.0F, 0.99F, "probability of one estimate alone, without a series"},
      {"orders", 2.0F, 1.0F, 20.0F,
       "orders of the series that are evaluated once it is, before roulette on further ones"},
      {"points-scale", 1.0F, 1e-3F, 1e3F,
       "points in an estimate of the optical depth, as a multiple of the paper's choice"}};
  static constexpr MethodInfo kInfo = {
      "unbiased-ray-marching",
      "jittered optical depths combined by U-statistics, roulette on the order",
      "",
      "always; estimates may be negative",
      "[Kettunen21]",
      kOptions,
      /*chromatic=*/true};

  explicit UnbiasedRayMarching(std::span<const float> options)
      : order_zero_(options[0]), orders_(options[1]), points_scale_(options[2]) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& /*modes*/,
           RandomStream& random, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    thread_local ResidualSegments<kN> residual;  // for its memory alone
    residual.gather(medium, path, statistics);
    attenuate(residual.control_depth(), flight);
    if (flight.event != Event::kEscape || !(residual.depth() > 0)) return;
    draw_order(random);
    const int points = point_count(residual.depth());
    const std::size_t count = series_weights_.size();  // n + 1, as many estimates as terms
    for (auto& estimates : estimates_) estimates.assign(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const double jitter = uniform_double(random);
      const double spacing = residual.length() / points;
      for (int point = 0; point < points; ++point) {
        const auto here = residual.at_length((point + jitter) * spacing);
        const auto sigma_t = extinction<kN>(medium, medium.densities(path, here.t, random));
        for (int channel = 0; channel < kN; ++channel) {
          estimates_[channel][i] -= (sigma_t[channel] - here.control[channel]) * spacing;
        }
      }
    }
    statistics.lookups +=
        count * static_cast<uint64_t>(points) * static_cast<uint64_t>(medium.component_count());
    double passed[kN];
    for (int channel = 0; channel < kN; ++channel) passed[channel] = combine(estimates_[channel]);
    scale(passed, flight);
  }

 private:
  /// More points would not make zero out of what is not.
  static constexpr double kMaxPoints = 4096;

  /// Draws n and sets series_weights_ to 1/(k! P(n ≥ k)) for k ≤ n.
  void draw_order(RandomStream& random) {
    const double u = uniform_double(random);
    double reached = 1;  // P(n ≥ k)
    double factorial = 1;
    series_weights_.assign(1, 1.0);
    for (int k = 1;; ++k) {
      if (k == 1) reached = 1.0 - order_zero_;
      if (k > std::floor(orders_)) reached *= std::min(1.0, orders_ / k);
      if (u >= reached) return;
      factorial *= k;
      series_weights_.push_back(1 / (factorial * reached));
    }
  }

  /// Mean of n, from P(n ≥ k).
  double mean_order() const {
    double sum = 0;
    double reached = 1.0 - order_zero_;
    for (int k = 1; reached > 1e-9; ++k) {
      if (k > std::floor(orders_)) reached *= std::min(1.0, orders_ / k);
      sum += reached;
    }
    return sum;
  }

  /// The paper's fit to the cost of a power series of that depth, shared by the estimates.
  int point_count(double depth) const {
    const double series_cost =
        std::ceil(std::cbrt((0.015 + depth) * (0.65 + depth) * (60.3 + depth)));
    const double points = std::round(points_scale_ * series_cost / (mean_order() + 1));
    return static_cast<int>(std::clamp(points, 1.0, kMaxPoints));
  }

  /// The mean over pivots. Elementary symmetric means grow by one estimate after the other:
  /// m_k(n) = m_k(n-1) + k/n (m_{k-1}(n-1) x_n - m_k(n-1)) [Kettunen21].
  double combine(std::span<const double> estimates) {
    const std::size_t count = estimates.size();
    double sum = 0;
    for (std::size_t pivot = 0; pivot < count; ++pivot) {
      const double passed = std::exp(estimates[pivot]);
      if (passed == 0) continue;
      means_.assign(count, 0.0);
      means_[0] = 1;
      std::size_t seen = 0;
      for (std::size_t i = 0; i < count; ++i) {
        if (i == pivot) continue;
        ++seen;
        const double apart = estimates[i] - estimates[pivot];
        for (std::size_t k = seen; k >= 1; --k) {
          means_[k] += static_cast<double>(k) / static_cast<double>(seen) *
                       (means_[k - 1] * apart - means_[k]);
        }
      }
      double series = 0;
      for (std::size_t k = 0; k < count; ++k) series += series_weights_[k] * means_[k];
      sum += passed * series;
    }
    return sum / static_cast<double>(count);
  }

  double order_zero_;
  double orders_;
  double points_scale_;
  std::vector<double> series_weights_;
  std::vector<double> means_;
  std::vector<double> estimates_[kMaxChannels];
};

}  // namespace freepath
