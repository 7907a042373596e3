#pragma once
/// @file Sine and cosine of a part of a turn, in single precision and with the same bits on every
/// machine, which those of the system's library have not. The lanes evaluate the same polynomials
/// in the same order (base/turn-inl.h).

namespace freepath {

struct SinCos {
  float sine, cosine;
};

/// sin(2π r)/r and (cos(2π r) - 1)/r² as polynomials of r², by least squares over the Chebyshev
/// nodes of |r| ≤ 1/8; with rounding, good to 9e-8.
inline constexpr float kTurnSine[4] = {6.2831855F, -41.341663F, 81.592545F, -75.40184F};
inline constexpr float kTurnCosine[4] = {-19.739208F, 64.93937F, -85.44882F, 59.42422F};

/// Sine and cosine of 2π u.
/// @param u in [0, 1]
constexpr SinCos sincos_of_turn(float u) {
  const auto quarter = static_cast<int>((u + 0.125F) * 4.0F);  // the nearest
  const float r = u - static_cast<float>(quarter) * 0.25F;
  const float z = r * r;
  const float s = r * (kTurnSine[0] + z * (kTurnSine[1] + z * (kTurnSine[2] + z * kTurnSine[3])));
  const float c = 1.0F + z * (kTurnCosine[0] +
                              z * (kTurnCosine[1] + z * (kTurnCosine[2] + z * kTurnCosine[3])));
  const bool odd = (quarter & 1) != 0;
  const float sine = odd ? c : s;
  const float cosine = odd ? s : c;
  return {(quarter & 2) != 0 ? -sine : sine, ((quarter + 1) & 2) != 0 ? -cosine : cosine};
}

}  // namespace freepath
