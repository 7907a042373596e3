// The lanes of the stream kernels: one ray per lane of a Highway vector. Compiled once per SIMD
// target; every -inl.h file of the project is, and is included by transport/ alone.

#if defined(FREEPATH_BASE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_BASE_LANES_INL_H_
#undef FREEPATH_BASE_LANES_INL_H_
#else
#define FREEPATH_BASE_LANES_INL_H_
#endif

#include <hwy/cache_control.h>
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

HWY_INLINE MaskF all_lanes() { return hn::Eq(hn::Zero(kFloat), hn::Zero(kFloat)); }
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

/// Asks for base[places[lane]] of every lane.
template <class T>
HWY_INLINE void prefetch_lanes(const T* base, const int32_t (&indices)[kLanes]) {
  HWY_FENCE;  // the places come from memory: taking them out of a vector costs more
  for (size_t lane = 0; lane < kLanes; ++lane) hwy::Prefetch(base + indices[lane]);
}

/// Asks for `count` values of an array, a cache line after the other.
template <class T>
HWY_INLINE void prefetch_row(const T* values, size_t count) {
  constexpr size_t kLine = 64 / sizeof(T);
  for (size_t i = 0; i < count; i += kLine) hwy::Prefetch(values + i);
}

/// Deals the elements of arrays out to chosen lanes: the n-th of those lanes gets the n-th element.
class Refill {
 public:
  explicit Refill(uint32_t lanes) : lanes_(mask_of(lanes)), indices_(ranks(lanes)) {}

  /// `values` in the chosen lanes of a row, the others as they are. Reads kLanes values.
  HWY_INLINE void deal(const float* values, float* row) const {
    hn::Store(hn::IfThenElse(lanes_, dealt(hn::LoadU(kFloat, values)), hn::Load(kFloat, row)),
              kFloat, row);
  }
  HWY_INLINE void deal(const int32_t* values, int32_t* row) const {
    const VecI dealt_values =
        hn::BitCast(kInt, dealt(hn::BitCast(kFloat, hn::LoadU(kInt, values))));
    hn::Store(hn::IfThenElse(int_mask(lanes_), dealt_values, hn::Load(kInt, row)), kInt, row);
  }
  HWY_INLINE void deal(const uint32_t* values, uint32_t* row) const {
    deal(reinterpret_cast<const int32_t*>(values), reinterpret_cast<int32_t*>(row));
  }
  /// One value in the chosen lanes of a row.
  HWY_INLINE void fill(float value, float* row) const {
    hn::Store(hn::IfThenElse(lanes_, hn::Set(kFloat, value), hn::Load(kFloat, row)), kFloat, row);
  }
  /// first, first + 1, ... in the chosen lanes of a row.
  HWY_INLINE void count_from(uint32_t first, uint32_t* row) const {
    HWY_ALIGN_MAX uint32_t numbers[kLanes];
    hn::Store(hn::Iota(kUint, first), kUint, numbers);
    deal(numbers, row);
  }
  HWY_INLINE void clear(uint32_t* row) const {
    hn::Store(hn::IfThenZeroElse(uint_mask(lanes_), hn::Load(kUint, row)), kUint, row);
  }

 private:
  using Indices = decltype(hn::IndicesFromVec(kFloat, hn::Zero(kInt)));

  /// How many of the chosen lanes come before each lane.
  static HWY_INLINE Indices ranks(uint32_t lanes) {
    const VecU one = hn::Set(kUint, 1);
    const VecU before = hn::Sub(hn::Shl(one, hn::Iota(kUint, 0U)), one);
    const VecU rank = hn::PopulationCount(hn::And(hn::Set(kUint, lanes), before));
    return hn::IndicesFromVec(kFloat, hn::BitCast(kInt, rank));
  }
  HWY_INLINE VecF dealt(VecF values) const { return hn::TableLookupLanes(values, indices_); }

  MaskF lanes_;
  Indices indices_;
};

/// Packs chosen lanes, the opposite of Refill: the n-th of them becomes the n-th of the array.
class Packing {
 public:
  HWY_INLINE explicit Packing(uint32_t lanes)
      : order_(hn::IndicesFromVec(kFloat,
                                  hn::Compress(hn::Iota(kInt, 0), int_mask(mask_of(lanes))))) {}

  /// Writes kLanes values, those behind the chosen ones of no meaning.
  HWY_INLINE void write(VecF values, float* array) const {
    hn::StoreU(hn::TableLookupLanes(values, order_), kFloat, array);
  }
  HWY_INLINE void write(VecU values, uint32_t* array) const {
    const VecF packed = hn::TableLookupLanes(hn::BitCast(kFloat, values), order_);
    hn::StoreU(hn::BitCast(kUint, packed), kUint, array);
  }

 private:
  decltype(hn::IndicesFromVec(kFloat, hn::Zero(kInt))) order_;
};

/// Whole numbers in [0, 2^23) as integers. Others give what no caller may use; a conversion that
/// saturates them would cost three times as much.
HWY_INLINE VecI small_to_int(VecF whole) {
  constexpr float kOffset = 0x1p23F;  // whose mantissa's last bit is 1
  return hn::Sub(hn::BitCast(kInt, hn::Add(whole, hn::Set(kFloat, kOffset))),
                 hn::BitCast(kInt, hn::Set(kFloat, kOffset)));
}

HWY_INLINE VecF set(float value) { return hn::Set(kFloat, value); }

/// a b + c, rounded twice. Not every target can fuse the two, and results must not depend on the
/// target: nothing in lanes may use Highway's MulAdd, nor its mathematical functions, which do.
HWY_INLINE VecF mul_add(VecF a, VecF b, VecF c) { return hn::Add(hn::Mul(a, b), c); }

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_BASE_LANES_INL_H_
