#pragma once
/// @file The power-series estimator of transmittance.

#include <cmath>
#include <span>

#include "freepath/tracking/method.h"
#include "freepath/tracking/reference/residual_segments.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath {

/// exp(-control) Σ_k Pois(k; D) Π_{i≤k} (1 - mu^r(x_i)/rate(x_i)), where D = ∫rate and the x_i are
/// drawn with density rate/D: the power series of exp(D - ∫mu^r), times exp(-D) [Georgiev19]. As in
/// its "p-series CMF", all orders are evaluated that make up 99 % of the Poisson weights, and
/// Russian roulette goes on with probability D/k, so that further terms keep their weight. A second
/// roulette ends products that have grown small. Channels share positions.
///
/// Unbiased whatever the rate is; where it is no bound (rate-scale < 1) terms may be negative. The
/// factors are multilinear in independent taps, hence stochastic interpolation is fine.
struct PSeries {
  static constexpr MethodOption kOptions[] = {
      {"coverage", 0.99F, 0.0F, 0.9999F,
       "share of the series' Poisson weights that is evaluated before roulette on the order"},
      {"rate-scale", 1.0F, 1e-3F, 1e3F,
       "rate that the series is expanded around, as a multiple of the residual's majorant"},
      {"roulette", 0.1F, 0.0F, 1.0F,
       "product below which Russian roulette is played, 0 for never"}};
  static constexpr MethodInfo kInfo = {
      "p-series",
      "power series of the exponential, with Russian roulette on the order",
      "",
      "always; below a rate scale of 1 estimates may be negative",
      "[Georgiev19]",
      kOptions,
      /*chromatic=*/true};

  explicit PSeries(std::span<const float> options)
      : coverage(options[0]), rate_scale(options[1]), roulette(options[2]) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& /*modes*/,
           RandomStream& random, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    thread_local ResidualSegments<kN> residual;  // for its memory alone
    residual.gather(medium, path, statistics);
    attenuate(residual.control_depth(), flight);
    const double depth = residual.depth() * rate_scale;
    if (flight.event != Event::kEscape || !(depth > 0)) return;
    double product[kN];
    double sum[kN];
    std::fill(product, product + kN, 1.0);
    std::fill(sum, sum + kN, std::exp(-depth));
    Orders orders(depth, coverage);
    while (orders.next(random)) {
      multiply(medium, path, residual, random, product, statistics);
      if (!survives(product, random)) break;
      for (int channel = 0; channel < kN; ++channel) {
        sum[channel] += orders.weight() * product[channel];
      }
    }
    scale(sum, flight);
  }

  float coverage;
  float rate_scale;
  float roulette;

 private:
  /// The orders of the series, and the weights of its terms.
  class Orders {
   public:
    Orders(double depth, double coverage)
        : depth_(depth),
          coverage_(coverage),
          sure_(depth + 8 * std::sqrt(depth) + 20),
          log_poisson_(-depth),
          covered_(std::exp(-depth)) {}

    /// Goes on to the next order, unless roulette says no.
    bool next(RandomStream& random) {
      ++order_;
      log_poisson_ += std::log(depth_ / order_);
      // Beyond `sure_` the weights are covered, whatever rounding has made of their sum.
      if (order_ > depth_ && (covered_ >= coverage_ || order_ > sure_)) {
        if (uniform_double(random) * order_ >= depth_) return false;
        log_survival_ += std::log(depth_ / order_);
      }
      covered_ += std::exp(log_poisson_);
      return true;
    }
    double weight() const { return std::exp(log_poisson_ - log_survival_); }

   private:
    double depth_;
    double coverage_;
    double sure_;
    double log_poisson_;
    double covered_;
    double log_survival_ = 0;
    double order_ = 0;
  };

  /// Draws a point and multiplies by 1 - mu^r/rate there.
  template <int kN, ReferenceMedium Medium>
  void multiply(const Medium& medium, const typename Medium::Path& path,
                const ResidualSegments<kN>& residual, RandomStream& random, double (&product)[kN],
                WalkStatistics& statistics) const {
    const auto point = residual.at_depth(uniform_double(random) * residual.depth());
    const auto sigma_t = extinction<kN>(medium, medium.densities(path, point.t, random));
    statistics.lookups += static_cast<uint64_t>(medium.component_count());
    for (int channel = 0; channel < kN; ++channel) {
      product[channel] *=
          1 - (sigma_t[channel] - point.control[channel]) / (point.rate * rate_scale);
    }
  }

  template <int kN>
  bool survives(double (&product)[kN], RandomStream& random) const {
    double largest = 0;
    for (const double value : product) largest = std::max(largest, std::abs(value));
    if (largest == 0) return false;
    if (largest >= roulette) return true;
    if (uniform_double(random) * roulette >= largest) return false;
    for (double& value : product) value *= roulette / largest;
    return true;
  }
};

}  // namespace freepath
