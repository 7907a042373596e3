#pragma once
/// @file Trackers of the scalar loop. Absorption is weighted: a real collision scatters, and the
/// weight takes the albedo.

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/scalar_loop.h"

namespace freepath::bench {

/// Bounds of the extinction in a super-voxel [1/m]; the rate is the majorant.
struct RateAndControl {
  float rate;
  float control;
};

/// The one component of a medium in its first channel, which trackers of one channel begin with.
class OneComponent : public ScalarMethod<1> {
 protected:
  explicit OneComponent(const ScalarMedium& medium)
      : sigma_t_(medium.components[0].sigma_t()[0]),
        albedo_(medium.components[0].sigma_s[0] / sigma_t_),
        maxima_(medium.cells.cells->maxima.data()),
        minima_(medium.cells.cells->minima.data()) {}

  float majorant(int cell) const { return sigma_t_ * maxima_[cell]; }
  float minorant(int cell) const { return sigma_t_ * minima_[cell]; }

  float sigma_t_;  ///< [1/m per density]
  float albedo_;

 private:
  const float* maxima_;
  const float* minima_;
};

/// Real collisions by rejection [Woodcock65].
class ScalarDelta : public OneComponent {
 public:
  struct Local {
    float rate;
  };
  explicit ScalarDelta(const ScalarMedium& medium) : OneComponent(medium) {}
  Local enter(int cell) const { return {majorant(cell)}; }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    if (random.uniform() * local.rate >= sigma_t_ * look(0)) return Outcome::kNull;
    path.weight[0] *= albedo_;
    return Outcome::kScatter;
  }
};

/// P_e = |mu_e| / (mu_t + |mu_n|) [Kutz17, Sec. 4.2].
class ScalarWeightedDelta : public OneComponent {
 public:
  struct Local {
    float rate;
  };
  explicit ScalarWeightedDelta(const ScalarMedium& medium) : OneComponent(medium) {}
  Local enter(int cell) const { return {kRateScale * majorant(cell)}; }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    const float sigma_t = sigma_t_ * look(0);
    const float sigma_n = local.rate - sigma_t;
    const float total = sigma_t + std::abs(sigma_n);
    const float scale = total / local.rate;
    if (random.uniform() * total < sigma_t) {
      path.weight[0] *= albedo_ * scale;
      return Outcome::kScatter;
    }
    path.weight[0] *= std::copysign(scale, sigma_n);
    return Outcome::kNull;
  }

 private:
  static constexpr float kRateScale = 1.0F;
};

/// Each component with a rate of its own; a collision belongs to one of them [Galtier16].
class ScalarMultiVolume : public ScalarMethod<1> {
 public:
  struct Local {
    float rate;
    const float* maxima;
  };
  explicit ScalarMultiVolume(const ScalarMedium& medium)
      : count_(static_cast<int>(medium.components.size())),
        maxima_(medium.cells.cells->maxima.data()) {
    for (int k = 0; k < count_; ++k) {
      sigma_t_[k] = medium.components[k].sigma_t()[0];
      albedo_[k] = medium.components[k].sigma_s[0] / sigma_t_[k];
    }
  }

  Local enter(int cell) const {
    Local local{0, maxima_ + std::ptrdiff_t(cell) * count_};
    for (int k = 0; k < count_; ++k) local.rate += sigma_t_[k] * local.maxima[k];
    return local;
  }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    float chosen = random.uniform() * local.rate;
    int k = 0;
    for (; k + 1 < count_; ++k) {
      const float rate = sigma_t_[k] * local.maxima[k];
      if (chosen < rate) break;
      chosen -= rate;
    }
    if (chosen >= sigma_t_[k] * look(k)) return Outcome::kNull;
    path.weight[0] *= albedo_[k];
    return Outcome::kScatter;
  }

 private:
  int count_;
  const float* maxima_;
  std::array<float, Medium::kMaxComponents> sigma_t_{};  ///< [1/m per density]
  std::array<float, Medium::kMaxComponents> albedo_{};
};

/// What the minimum of the super-voxel decides needs no look-up [Kutz17, Sec. 5.1].
class ScalarDecomposition : public OneComponent {
 public:
  explicit ScalarDecomposition(const ScalarMedium& medium) : OneComponent(medium) {}
  RateAndControl enter(int cell) const { return {majorant(cell), minorant(cell)}; }

  template <class Look>
  Outcome collide(const RateAndControl& local, const Look& look, Pcg& random, Path& path) const {
    const float chosen = random.uniform() * local.rate;
    if (chosen >= local.control && chosen >= sigma_t_ * look(0)) return Outcome::kNull;
    path.weight[0] *= albedo_;
    return Outcome::kScatter;
  }
};

/// The same where residual coefficients may be negative [Kutz17, Sec. 5.2].
class ScalarWeightedDecomposition : public OneComponent {
 public:
  explicit ScalarWeightedDecomposition(const ScalarMedium& medium) : OneComponent(medium) {}
  RateAndControl enter(int cell) const { return {majorant(cell), kControl * minorant(cell)}; }

  template <class Look>
  Outcome collide(const RateAndControl& local, const Look& look, Pcg& random, Path& path) const {
    if (random.uniform() * local.rate < local.control) {
      path.weight[0] *= albedo_;
      return Outcome::kScatter;
    }
    const float sigma_t = sigma_t_ * look(0);
    const float residual = sigma_t - local.control;
    const float sigma_n = local.rate - sigma_t;
    const float total = std::abs(residual) + std::abs(sigma_n);
    const float scale = total / (local.rate - local.control);
    if (random.uniform() * total < std::abs(residual)) {
      path.weight[0] *= albedo_ * std::copysign(scale, residual);
      return Outcome::kScatter;
    }
    path.weight[0] *= std::copysign(scale, sigma_n);
    return Outcome::kNull;
  }

 private:
  static constexpr float kControl = 1.0F;
};

/// What the spectral trackers have in common: a rate for the largest channel, probabilities from
/// the mean over channels of |weight · coefficient| (history-average), and their weights.
template <int kN>
class OneComponentSpectral : public ScalarMethod<kN> {
 public:
  using Path = Weights<kN>;

 protected:
  using Coefficients = std::array<float, kN>;

  explicit OneComponentSpectral(const ScalarMedium& medium)
      : maxima_(medium.cells.cells->maxima.data()), minima_(medium.cells.cells->minima.data()) {
    for (int channel = 0; channel < kN; ++channel) {
      sigma_t_[channel] = medium.components[0].sigma_t()[channel];
      sigma_s_[channel] = medium.components[0].sigma_s[channel];
      largest_ = std::max(largest_, sigma_t_[channel]);
    }
  }

  static float mean(const Coefficients& sigma, const Path& path) {
    float sum = 0;
    for (int channel = 0; channel < kN; ++channel) {
      sum += std::abs(path.weight[channel] * sigma[channel]);
    }
    return sum / kN;
  }

  /// Scattering at a density that may be a residual one. @param scale 1/(rate · P)
  Outcome scatter(float density, float scale, Path& path) const {
    for (int channel = 0; channel < kN; ++channel) {
      path.weight[channel] *= sigma_s_[channel] * density * scale;
    }
    return Outcome::kScatter;
  }

  /// Scattering against null, by a look-up. @param density the rest that a control has left
  /// @param rate of what is left to decide
  Outcome choose(float density, const Coefficients& sigma_n, float rate, Pcg& random,
                 Path& path) const {
    Coefficients sigma_t;
    for (int channel = 0; channel < kN; ++channel) sigma_t[channel] = density * sigma_t_[channel];
    const float real = mean(sigma_t, path);
    const float null = mean(sigma_n, path);
    const float scale = (real + null) / rate;
    if (random.uniform() * (real + null) < real) return scatter(density, scale / real, path);
    float largest = 0;
    for (int channel = 0; channel < kN; ++channel) {
      path.weight[channel] *= sigma_n[channel] * (scale / null);
      largest = std::max(largest, std::abs(path.weight[channel]));
    }
    return largest > 0 ? Outcome::kNull : Outcome::kEnd;
  }

  Coefficients sigma_t_;  ///< [1/m per density]
  Coefficients sigma_s_;  ///< [1/m per density]
  float largest_ = 0;     ///< Of sigma_t_.
  const float* maxima_;
  const float* minima_;
};

/// One path for all channels [Kutz17, Sec. 4.2].
template <int kN>
class ScalarSpectral : public OneComponentSpectral<kN> {
 public:
  struct Local {
    float rate;
  };
  using Path = Weights<kN>;
  explicit ScalarSpectral(const ScalarMedium& medium) : OneComponentSpectral<kN>(medium) {}
  Local enter(int cell) const { return {this->largest_ * this->maxima_[cell]}; }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    const float density = look(0);
    std::array<float, kN> sigma_n;
    for (int channel = 0; channel < kN; ++channel) {
      sigma_n[channel] = local.rate - density * this->sigma_t_[channel];
    }
    return this->choose(density, sigma_n, local.rate, random, path);
  }
};

/// The same, with a control that decides for all channels without a look-up [Kutz17, Sec. 5.3].
template <int kN>
class ScalarSpectralDecomposition : public OneComponentSpectral<kN> {
 public:
  struct Local {
    float rate;
    float control;  ///< Density of the control.
  };
  using Path = Weights<kN>;
  explicit ScalarSpectralDecomposition(const ScalarMedium& medium)
      : OneComponentSpectral<kN>(medium) {}
  Local enter(int cell) const {
    return {this->largest_ * this->maxima_[cell], this->minima_[cell]};
  }

  template <class Look>
  Outcome collide(const Local& local, const Look& look, Pcg& random, Path& path) const {
    std::array<float, kN> control;
    std::array<float, kN> sigma;  // of the rest, then of null
    for (int channel = 0; channel < kN; ++channel) {
      control[channel] = local.control * this->sigma_t_[channel];
      sigma[channel] = local.rate - control[channel];
    }
    const float decided = this->mean(control, path);
    const float rest = this->mean(sigma, path);
    const float total = decided + rest;
    if (random.uniform() * total < decided) {
      return this->scatter(local.control, total / (local.rate * decided), path);
    }
    const float density = look(0);
    for (int channel = 0; channel < kN; ++channel) {
      sigma[channel] = local.rate - density * this->sigma_t_[channel];
    }
    return this->choose(density - local.control, sigma, local.rate * rest / total, random, path);
  }
};

}  // namespace freepath::bench
