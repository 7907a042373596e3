#pragma once
/// @file Transmittance estimators of the scalar loop.

#include <algorithm>
#include <cmath>

#include "bench/scalar_free_paths.h"

namespace freepath::bench {

/// Russian roulette below a weight of 0.1. @param gain gets the factor on what survives
/// @return whether the ray goes on
inline bool survives(float largest, Pcg& random, float& gain) {
  constexpr float kThreshold = 0.1F;
  gain = 1;
  if (largest >= kThreshold) return true;
  if (random.uniform() * kThreshold >= largest) return false;
  gain = kThreshold / largest;
  return true;
}

/// The same for a ray of one weight ≥ 0, which grows.
inline Outcome play_roulette(Pcg& random, float& weight) {
  float gain;
  if (!survives(weight, random, gain)) return Outcome::kEnd;
  weight *= gain;
  return Outcome::kNull;
}

/// 1 if the ray passes without a real collision, else 0 [Novak18, Sec. 5].
class ScalarDeltaTransmittance : public OneComponent {
 public:
  struct Local {
    float rate;
  };
  explicit ScalarDeltaTransmittance(const ScalarMedium& medium) : OneComponent(medium) {}
  Local enter(int cell) const { return {majorant(cell)}; }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& /*path*/) const {
    return random.uniform() * local.rate < sigma_t_ * look(0) ? Outcome::kEnd : Outcome::kNull;
  }
};

/// The product of mu_n/rate [Novak14, Eq. 14].
class ScalarRatio : public OneComponent {
 public:
  struct Local {
    float rate;
  };
  explicit ScalarRatio(const ScalarMedium& medium) : OneComponent(medium) {}
  Local enter(int cell) const { return {majorant(cell)}; }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    path.weight[0] *= (local.rate - sigma_t_ * look(0)) / local.rate;
    return play_roulette(random, path.weight[0]);
  }
};

/// Minima in closed form, ratio tracking of the rest [Novak14, Eq. 17].
class ScalarResidualRatio : public OneComponent {
 public:
  struct Path : Weights<1> {
    float depth = 0;  ///< ∫ of the control.
  };
  explicit ScalarResidualRatio(const ScalarMedium& medium) : OneComponent(medium) {}
  RateAndControl enter(int cell) const {
    const float control = minorant(cell);
    return {majorant(cell) - control, control};
  }
  void pass(const RateAndControl& local, float length, Path& path) const {
    path.depth += local.control * length;
  }
  void finish(Path& path) const { path.weight[0] *= std::exp(-path.depth); }

  template <class Look>
  Outcome collide(const RateAndControl& local, const Look& look, Pcg& random, Path& path) const {
    const float residual = sigma_t_ * look(0) - local.control;
    path.weight[0] *= (local.rate - residual) / local.rate;
    return play_roulette(random, path.weight[0]);
  }
};

/// Every collision adds its expected flight to the end [Novak18, Sec. 5.2], as a running sum that
/// each stretch attenuates.
class ScalarNextFlight : public OneComponent {
 public:
  struct Local {
    float rate;
  };
  struct Path : Weights<1> {
    float sum = 1;
    float depth = 0;  ///< By the rate, since the last collision.
  };
  explicit ScalarNextFlight(const ScalarMedium& medium) : OneComponent(medium) {}
  Local enter(int cell) const { return {majorant(cell)}; }
  void pass(const Local& local, float length, Path& path) const {
    path.depth += local.rate * length;
  }
  void finish(Path& path) const { path.weight[0] = path.sum * std::exp(-path.depth); }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    path.weight[0] *= (local.rate - sigma_t_ * look(0)) / local.rate;
    path.sum = path.sum * std::exp(-path.depth) + path.weight[0];
    path.depth = 0;
    float gain;
    if (!survives(std::max(path.weight[0], path.sum), random, gain)) return Outcome::kEnd;
    path.weight[0] *= gain;
    path.sum *= gain;
    return Outcome::kNull;
  }
};

}  // namespace freepath::bench
