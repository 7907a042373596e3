#pragma once
/// @file What a path carries: a value in each of its channels.

#include <algorithm>
#include <array>
#include <cmath>

#include "freepath/base/build_options.h"

namespace freepath {

/// Values of the channels of a path: R, G, B, or radiances at its wavelengths. What the channels
/// stand for, the path's SpectrumValues say. Those that it does not use are 0.
class alignas(16) Channels {
 public:
  constexpr Channels() = default;
  constexpr explicit Channels(float value) { values_.fill(value); }
  constexpr Channels(float a, float b, float c, float d = 0) : values_{a, b, c, d} {}

  constexpr float operator[](int i) const { return values_[i]; }
  constexpr float& operator[](int i) { return values_[i]; }

  constexpr Channels& operator+=(const Channels& o) {
    for (int i = 0; i < kMaxChannels; ++i) values_[i] += o.values_[i];
    return *this;
  }
  constexpr Channels& operator-=(const Channels& o) {
    for (int i = 0; i < kMaxChannels; ++i) values_[i] -= o.values_[i];
    return *this;
  }
  constexpr Channels& operator*=(const Channels& o) {
    for (int i = 0; i < kMaxChannels; ++i) values_[i] *= o.values_[i];
    return *this;
  }
  constexpr Channels& operator*=(float factor) {
    for (float& value : values_) value *= factor;
    return *this;
  }
  friend constexpr Channels operator+(Channels a, const Channels& b) { return a += b; }
  friend constexpr Channels operator-(Channels a, const Channels& b) { return a -= b; }
  friend constexpr Channels operator*(Channels a, const Channels& b) { return a *= b; }
  friend constexpr Channels operator*(Channels a, float factor) { return a *= factor; }
  friend constexpr Channels operator*(float factor, Channels a) { return a *= factor; }
  friend constexpr bool operator==(const Channels&, const Channels&) = default;

 private:
  std::array<float, kMaxChannels> values_{};
};

inline bool is_black(const Channels& c) { return c == Channels(); }
inline bool is_finite(const Channels& c) {
  float product = 0;  // NaN as soon as one channel is infinite or NaN
  for (int i = 0; i < kMaxChannels; ++i) product += 0 * c[i];
  return product == 0;
}
/// Largest magnitude of all channels; NaN if a channel is infinite or NaN.
inline float largest_magnitude(const Channels& c) {
  float largest = 0;
  float nothing = 0;  // or NaN
  for (int i = 0; i < kMaxChannels; ++i) {
    const float magnitude = std::abs(c[i]);
    largest = std::max(largest, magnitude);
    nothing += magnitude - magnitude;
  }
  return largest + nothing;
}

}  // namespace freepath
