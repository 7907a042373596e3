// The lanes of the stream kernels: one ray per lane of a Highway vector. Compiled once per SIMD
// target; every -inl.h file of the project is, and is included by transport/ alone.

#if defined(FREEPATH_BASE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_BASE_LANES_INL_H_
#undef FREEPATH_BASE_LANES_INL_H_
#else
#define FREEPATH_BASE_LANES_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using VecF = hn::Vec<FloatTag>;
using VecI = hn::Vec<IntTag>;
using VecU = hn::Vec<UintTag>;
using MaskF = hn::Mask<FloatTag>;
using MaskI = hn::Mask<IntTag>;
using MaskU = hn::Mask<UintTag>;

inline constexpr FloatTag kFloat;
inline constexpr IntTag kInt;
inline constexpr UintTag kUint;
inline constexpr size_t kLanes = hn::MaxLanes(FloatTag());

/// One bit per lane.
HWY_INLINE uint32_t bits_of(MaskF mask) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(kFloat, mask, bytes);
  return uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8;
}

HWY_INLINE MaskF mask_of(uint32_t bits) {
  const uint8_t bytes[8] = {static_cast<uint8_t>(bits), static_cast<uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(kFloat, bytes);
}

HWY_INLINE MaskF no_lanes() { return hn::MaskFromVec(hn::Zero(kFloat)); }

HWY_INLINE MaskI int_mask(MaskF mask) { return hn::RebindMask(kInt, mask); }
HWY_INLINE MaskU uint_mask(MaskF mask) { return hn::RebindMask(kUint, mask); }
HWY_INLINE MaskF float_mask(MaskI mask) { return hn::RebindMask(kFloat, mask); }

/// A new value in the lanes of the mask, what was there before in the others.
HWY_INLINE void assign(VecF& target, MaskF mask, VecF value) {
  target = hn::IfThenElse(mask, value, target);
}
HWY_INLINE void assign(VecI& target, MaskF mask, VecI value) {
  target = hn::IfThenElse(int_mask(mask), value, target);
}

HWY_INLINE VecF set(float value) { return hn::Set(kFloat, value); }

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_BASE_LANES_INL_H_
