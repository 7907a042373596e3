#pragma once
/// @file What a path carries: a value in each of its channels.

#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "freepath/base/build_options.h"

namespace freepath {

/// Values of the channels of a path: R, G, B, or radiances at its wavelengths. What the channels
/// stand for, the path's SpectrumValues say. Those that it does not use are 0.
class alignas(16) SampledSpectrum {
 public:
  constexpr SampledSpectrum() = default;
  constexpr explicit SampledSpectrum(float value) { values_.fill(value); }
  constexpr SampledSpectrum(float a, float b, float c, float d = 0) {
    if (std::is_constant_evaluated()) {
      values_ = {a, b, c, d};
      return;
    }
    // Put together in a register: vectors that read what was written number by number would wait
    // until it is in the cache.
    using Four [[gnu::vector_size(4 * sizeof(float))]] = float;
    static_assert(kMaxChannels >= 4);
    const Four first = {a, b, c, d};
    std::memcpy(values_.data(), &first, sizeof first);
  }

  constexpr float operator[](int i) const { return values_[i]; }
  constexpr float& operator[](int i) { return values_[i]; }

  constexpr SampledSpectrum& operator+=(const SampledSpectrum& o) {
    for (int i = 0; i < kMaxChannels; ++i) values_[i] += o.values_[i];
    return *this;
  }
  constexpr SampledSpectrum& operator-=(const SampledSpectrum& o) {
    for (int i = 0; i < kMaxChannels; ++i) values_[i] -= o.values_[i];
    return *this;
  }
  constexpr SampledSpectrum& operator*=(const SampledSpectrum& o) {
    for (int i = 0; i < kMaxChannels; ++i) values_[i] *= o.values_[i];
    return *this;
  }
  constexpr SampledSpectrum& operator*=(float factor) {
    for (float& value : values_) value *= factor;
    return *this;
  }
  friend constexpr SampledSpectrum operator+(SampledSpectrum a, const SampledSpectrum& b) {
    return a += b;
  }
  friend constexpr SampledSpectrum operator-(SampledSpectrum a, const SampledSpectrum& b) {
    return a -= b;
  }
  friend constexpr SampledSpectrum operator*(SampledSpectrum a, const SampledSpectrum& b) {
    return a *= b;
  }
  friend constexpr SampledSpectrum operator*(SampledSpectrum a, float factor) {
    return a *= factor;
  }
  friend constexpr SampledSpectrum operator*(float factor, SampledSpectrum a) {
    return a *= factor;
  }
  friend constexpr bool operator==(const SampledSpectrum&, const SampledSpectrum&) = default;

 private:
  std::array<float, kMaxChannels> values_{};
};

/// All channels as one number, half by half: a few vector instructions, where one channel after the
/// other would wait for the one before.
template <class Combine>
constexpr float fold(const SampledSpectrum& c, const Combine& combine) {
  SampledSpectrum left = c;
  for (int count = kMaxChannels; count > 1; count = (count + 1) / 2) {
    const int half = (count + 1) / 2;
    for (int i = 0; i < count / 2; ++i) left[i] = combine(left[i], left[i + half]);
  }
  return left[0];
}
/// The sum of all channels.
constexpr float sum_of(const SampledSpectrum& c) {
  return fold(c, [](float a, float b) { return a + b; });
}
/// 0, or NaN if a channel is infinite or NaN.
constexpr float zero_if_finite(const SampledSpectrum& c) { return sum_of(c - c); }

constexpr bool is_black(const SampledSpectrum& c) {
  int lit = 0;
  for (int i = 0; i < kMaxChannels; ++i) lit |= c[i] == 0 ? 0 : -1;
  return lit == 0;
}
constexpr bool is_finite(const SampledSpectrum& c) { return zero_if_finite(c) == 0; }
/// Largest magnitude of all channels; NaN if a channel is infinite or NaN.
inline float largest_magnitude(const SampledSpectrum& c) {
  SampledSpectrum magnitude;
  for (int i = 0; i < kMaxChannels; ++i) magnitude[i] = std::abs(c[i]);
  return fold(magnitude, [](float a, float b) { return a < b ? b : a; }) + zero_if_finite(c);
}

}  // namespace freepath
