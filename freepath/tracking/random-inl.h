// The lanes' form of base/random.h: four random words for each lane.

#if defined(FREEPATH_TRACKING_RANDOM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_RANDOM_INL_H_
#undef FREEPATH_TRACKING_RANDOM_INL_H_
#else
#define FREEPATH_TRACKING_RANDOM_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include "freepath/base/lanes-inl.h"
#include "freepath/base/random.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

struct RandomWords {
  VecU words[4];
};

/// High and low half of a 32 × 32 bit product.
HWY_INLINE void multiply_wide(VecU a, uint32_t multiplier, VecU& high, VecU& low) {
#if HWY_TARGET == HWY_SCALAR
  const uint64_t product = uint64_t{hn::GetLane(a)} * multiplier;
  high = hn::Set(kUint, static_cast<uint32_t>(product >> 32));
  low = hn::Set(kUint, static_cast<uint32_t>(product));
#else
  const hn::Repartition<uint64_t, UintTag> wide;
  const VecU factor = hn::Set(kUint, multiplier);
  const auto even = hn::MulEven(a, factor);
  const auto odd =
      hn::MulEven(hn::BitCast(kUint, hn::ShiftRight<32>(hn::BitCast(wide, a))), factor);
  high = hn::OddEven(hn::BitCast(kUint, odd), hn::BitCast(kUint, hn::ShiftRight<32>(even)));
  low = hn::OddEven(hn::BitCast(kUint, hn::ShiftLeft<32>(odd)), hn::BitCast(kUint, even));
#endif
}

/// Philox4x32-7 [Salmon11]; equal to philox() lane by lane.
HWY_INLINE RandomWords philox_lanes(VecU block, VecU stream, VecU sample, VecU pixel,
                                    uint64_t seed) {
  VecU c0 = block;
  VecU c1 = stream;
  VecU c2 = sample;
  VecU c3 = pixel;
  auto key0 = static_cast<uint32_t>(seed);
  auto key1 = static_cast<uint32_t>(seed >> 32);
  for (int round = 0; round < kPhiloxRounds; ++round) {
    VecU high0;
    VecU low0;
    VecU high1;
    VecU low1;
    multiply_wide(c0, kPhiloxMultiplier0, high0, low0);
    multiply_wide(c2, kPhiloxMultiplier1, high1, low1);
    c0 = hn::Xor(hn::Xor(high1, c1), hn::Set(kUint, key0));
    c2 = hn::Xor(hn::Xor(high0, c3), hn::Set(kUint, key1));
    c1 = low1;
    c3 = low0;
    key0 += kPhiloxWeyl0;
    key1 += kPhiloxWeyl1;
  }
  return {{c0, c1, c2, c3}};
}

/// [0,1) with 24 bits, as uniform_from_bits().
HWY_INLINE VecF uniform_lanes(VecU bits) {
  return hn::Mul(hn::ConvertTo(kFloat, hn::BitCast(kInt, hn::ShiftRight<8>(bits))), set(0x1p-24F));
}

/// Exponential with mean 1; the logarithm's argument lies in (0,1], as open_uniform_from_bits().
HWY_INLINE VecF exponential_lanes(VecU bits) {
  const VecF uniform =
      hn::Mul(hn::Add(hn::ConvertTo(kFloat, hn::BitCast(kInt, hn::ShiftRight<1>(bits))), set(0.5F)),
              set(0x1p-31F));
  return hn::Neg(hn::Log(kFloat, uniform));
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_RANDOM_INL_H_
