// The lanes' form of base/lat_long.h.

#if defined(FREEPATH_BASE_LAT_LONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_BASE_LAT_LONG_INL_H_
#undef FREEPATH_BASE_LAT_LONG_INL_H_
#else
#define FREEPATH_BASE_LAT_LONG_INL_H_
#endif

#include <limits>
#include <numbers>

#include "freepath/base/lanes-inl.h"
#include "freepath/base/lat_long.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// mirrored_if(), lane by lane.
HWY_INLINE VecF mirrored_lanes(MaskF mirrored, VecF whole, VecF angle) {
  return hn::IfThenElse(mirrored, hn::Sub(whole, angle), angle);
}

/// fast_atan2(), lane by lane.
HWY_INLINE VecF fast_atan2_lanes(VecF y, VecF x) {
  const VecF ax = hn::Abs(x);
  const VecF ay = hn::Abs(y);
  const VecF least = set(std::numeric_limits<float>::min());
  const VecF t = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), least));
  const VecF s = hn::Mul(t, t);
  const VecF s2 = hn::Mul(s, s);
  const auto cubic_from = [&](int first) {
    const float* const c = kArctangent + first;
    return hn::Add(mul_add(set(c[1]), s, set(c[0])), hn::Mul(mul_add(set(c[3]), s, set(c[2])), s2));
  };
  const VecF high = hn::Mul(hn::Mul(cubic_from(4), s2), s2);
  const VecF angle = hn::Mul(t, hn::Add(cubic_from(0), high));
  constexpr auto kHalfTurn = std::numbers::pi_v<float>;
  const VecF quarter = mirrored_lanes(hn::Gt(ay, ax), set(0.5F * kHalfTurn), angle);
  return hn::CopySign(mirrored_lanes(hn::Lt(x, hn::Zero(kFloat)), set(kHalfTurn), quarter), y);
}

/// lat_long(), place_of() and pixel_at() of all directions of a stream.
inline void locate_directions(const LatLongGrid& grid, LatLongStream& stream) {
  constexpr float kInversePi = std::numbers::inv_pi_v<float>;
  const VecF zero = hn::Zero(kFloat);
  const VecF one = set(1.0F);
  const VecF half = set(0.5F);
  const VecF width = set(static_cast<float>(grid.width));
  const VecF height = set(static_cast<float>(grid.height));
  const VecF last_column = hn::Sub(width, one);
  const VecF last_row = hn::Sub(height, one);
  const auto number_of = [&](VecF column, VecF row) {
    const VecI begin = hn::Mul(small_to_int(row), hn::Set(kInt, grid.width));
    return hn::BitCast(kUint, hn::Add(begin, small_to_int(column)));
  };
  const auto clamped = [&](VecF whole, VecF last) { return hn::Min(hn::Max(whole, zero), last); };
  const bool is_turned = grid.up == UpAxis::kZ;
  for (std::size_t i = 0; i < stream.count; i += kLanes) {
    const VecF dx = hn::Load(kFloat, &stream.direction[0][i]);
    const VecF dy = hn::Load(kFloat, &stream.direction[is_turned ? 2 : 1][i]);
    const VecF along = hn::Load(kFloat, &stream.direction[is_turned ? 1 : 2][i]);
    const VecF dz = is_turned ? hn::Neg(along) : along;
    const VecF reach = hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Mul(dz, dz)));
    const VecF u = hn::Sub(half, hn::Mul(fast_atan2_lanes(dx, dz), set(0.5F * kInversePi)));
    const VecF v = hn::Mul(fast_atan2_lanes(reach, dy), set(kInversePi));
    const VecF x = hn::Mul(u, width);
    const VecF y = hn::Mul(v, height);
    hn::Store(number_of(clamped(hn::Floor(x), last_column), clamped(hn::Floor(y), last_row)), kUint,
              &stream.pixel[i]);
    const VecF from_left = hn::Sub(x, half);
    const VecF from_top = hn::Sub(y, half);
    const VecF left = hn::Sub(hn::Floor(hn::Add(from_left, one)), one);
    const VecF above = hn::Sub(hn::Floor(hn::Add(from_top, one)), one);
    hn::Store(hn::Sub(from_left, left), kFloat, &stream.right[i]);
    hn::Store(hn::Sub(from_top, above), kFloat, &stream.down[i]);
    const VecF next = hn::Add(left, one);
    const VecF columns[2] = {
        hn::IfThenElse(hn::Lt(left, zero), hn::Add(left, width), left),
        hn::IfThenElse(hn::Lt(next, width), next, hn::Sub(next, width)),
    };
    const VecF rows[2] = {clamped(above, last_row), clamped(hn::Add(above, one), last_row)};
    for (int corner = 0; corner < 4; ++corner) {
      hn::Store(number_of(columns[corner % 2], rows[corner / 2]), kUint,
                &stream.corners[corner][i]);
    }
  }
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_BASE_LAT_LONG_INL_H_
