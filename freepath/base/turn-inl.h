// The lanes' form of base/turn.h.

#if defined(FREEPATH_BASE_TURN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_BASE_TURN_INL_H_
#undef FREEPATH_BASE_TURN_INL_H_
#else
#define FREEPATH_BASE_TURN_INL_H_
#endif

#include "freepath/base/lanes-inl.h"
#include "freepath/base/turn.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// c0 + z (c1 + z (c2 + z c3))
HWY_INLINE VecF cubic(VecF z, const float (&c)[4]) {
  VecF sum = mul_add(z, set(c[3]), set(c[2]));
  sum = mul_add(z, sum, set(c[1]));
  return mul_add(z, sum, set(c[0]));
}

/// Sine and cosine of 2π u for u in [0, 1]; equal to sincos_of_turn() lane by lane.
HWY_INLINE void sincos_of_turn_lanes(VecF u, VecF& sine, VecF& cosine) {
  const VecF whole = hn::Floor(mul_add(u, set(4.0F), set(0.5F)));
  const VecF r = hn::Sub(u, hn::Mul(whole, set(0.25F)));
  const VecF z = hn::Mul(r, r);
  const VecF s = hn::Mul(r, cubic(z, kTurnSine));
  const VecF c = mul_add(z, cubic(z, kTurnCosine), set(1.0F));
  const VecI quarter = small_to_int(whole);
  const VecI one = hn::Set(kInt, 1);
  const MaskF odd = float_mask(hn::Eq(hn::And(quarter, one), one));
  // The second bit, moved to where a float has its sign.
  const auto sign = [](VecI number) {
    return hn::BitCast(kFloat, hn::ShiftLeft<30>(hn::And(number, hn::Set(kInt, 2))));
  };
  sine = hn::Xor(hn::IfThenElse(odd, c, s), sign(quarter));
  cosine = hn::Xor(hn::IfThenElse(odd, s, c), sign(hn::Add(quarter, one)));
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_BASE_TURN_INL_H_
