// The lanes' form of HenyeyGreenstein: each lane with a mean cosine of its own.

#if defined(FREEPATH_MEDIA_PHASE_HENYEY_GREENSTEIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_MEDIA_PHASE_HENYEY_GREENSTEIN_INL_H_
#undef FREEPATH_MEDIA_PHASE_HENYEY_GREENSTEIN_INL_H_
#else
#define FREEPATH_MEDIA_PHASE_HENYEY_GREENSTEIN_INL_H_
#endif

#include <numbers>

#include "freepath/base/turn-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

struct VectorLanes {
  VecF x, y, z;
};

HWY_INLINE VectorLanes scaled(const VectorLanes& v, VecF factor) {
  return {hn::Mul(v.x, factor), hn::Mul(v.y, factor), hn::Mul(v.z, factor)};
}
HWY_INLINE VectorLanes sum_of(const VectorLanes& a, const VectorLanes& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE VecF squared_length(const VectorLanes& v) {
  return mul_add(v.z, v.z, mul_add(v.x, v.x, hn::Mul(v.y, v.y)));
}

/// The vector with these coordinates around a unit vector; see TangentFrame.
HWY_INLINE VectorLanes around(const VectorLanes& unit, const VectorLanes& local) {
  const VecF one = set(1.0F);
  const VecF sign = hn::CopySign(one, unit.z);
  const VecF a = hn::Div(set(-1.0F), hn::Add(sign, unit.z));
  const VecF b = hn::Mul(hn::Mul(unit.x, unit.y), a);
  const VecF stretch = hn::Mul(hn::Mul(hn::Mul(sign, unit.x), unit.x), a);
  const VectorLanes tangent{hn::Add(one, stretch), hn::Mul(sign, b),
                            hn::Mul(hn::Neg(sign), unit.x)};
  const VectorLanes bitangent{b, hn::Add(sign, hn::Mul(hn::Mul(unit.y, unit.y), a)),
                              hn::Neg(unit.y)};
  return sum_of(sum_of(scaled(tangent, local.x), scaled(bitangent, local.y)),
                scaled(unit, local.z));
}

class HenyeyGreensteinLanes {
 public:
  /// @param g mean cosine, |g| < 1
  explicit HWY_INLINE HenyeyGreensteinLanes(VecF g)
      : sharpness_(hn::Abs(g)),
        sign_(hn::CopySign(set(1.0F), g)),
        gap_(hn::Sub(set(1.0F), sharpness_)) {}

  /// HenyeyGreenstein::evaluate(before, after), lane by lane.
  HWY_INLINE VecF evaluate(const VectorLanes& before, const VectorLanes& after) const {
    return evaluate_at(squared_length({hn::Sub(after.x, hn::Mul(before.x, sign_)),
                                       hn::Sub(after.y, hn::Mul(before.y, sign_)),
                                       hn::Sub(after.z, hn::Mul(before.z, sign_))}));
  }

  /// HenyeyGreenstein::sample(before, u1, u2), lane by lane.
  HWY_INLINE VectorLanes sample(const VectorLanes& before, VecF u1, VecF u2, VecF& pdf) const {
    const VecF one = set(1.0F);
    const VecF two = set(2.0F);
    const VecF rest = hn::Sub(one, u1);
    const VecF ratio = hn::Div(gap_, hn::Add(gap_, hn::Mul(hn::Mul(two, sharpness_), rest)));
    const VecF spread = hn::Add(one, hn::Mul(sharpness_, rest));
    const VecF h = hn::Min(one, hn::Mul(hn::Mul(hn::Mul(ratio, ratio), u1), spread));
    const VecF across = hn::Mul(two, hn::Sqrt(hn::Mul(h, hn::Sub(one, h))));
    VecF sine;
    VecF cosine;
    sincos_of_turn_lanes(u2, sine, cosine);
    const VectorLanes local{hn::Mul(across, cosine), hn::Mul(across, sine),
                            hn::Sub(one, hn::Mul(two, h))};
    const VectorLanes after = around(scaled(before, sign_), local);
    pdf = evaluate_at(hn::Mul(set(4.0F), h));
    return scaled(after, hn::Div(one, hn::Sqrt(squared_length(after))));
  }

 private:
  HWY_INLINE VecF evaluate_at(VecF distance2) const {
    const VecF d = hn::Add(hn::Mul(gap_, gap_), hn::Mul(sharpness_, distance2));
    const VecF whole = hn::Mul(set(4.0F * std::numbers::pi_v<float>), d);
    return hn::Div(hn::Mul(gap_, hn::Add(set(1.0F), sharpness_)), hn::Mul(whole, hn::Sqrt(d)));
  }

  VecF sharpness_, sign_, gap_;
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_MEDIA_PHASE_HENYEY_GREENSTEIN_INL_H_
