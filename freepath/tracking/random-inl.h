// The lanes' form of base/random.h: four random words for each lane.

#if defined(FREEPATH_TRACKING_RANDOM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_RANDOM_INL_H_
#undef FREEPATH_TRACKING_RANDOM_INL_H_
#else
#define FREEPATH_TRACKING_RANDOM_INL_H_
#endif

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

/// Below 2^31, as a float; as digits_after().
HWY_INLINE VecF digits_after_lanes(VecU second) {
  const VecF half = hn::ConvertTo(kFloat, hn::BitCast(kInt, hn::ShiftRight<1>(second)));
  return hn::Mul(hn::Add(half, set(0.5F)), set(0x1p-31F));
}

/// 31 bits and what comes after them, in their unit. `second()` makes the second words; it is asked
/// where a lane of the mask needs them.
template <class Second>
HWY_INLINE VecF with_all_digits(VecU low, MaskF lanes, const Second& second) {
  const VecI whole = hn::BitCast(kInt, low);
  const MaskF few = hn::And(lanes, float_mask(hn::Lt(whole, hn::Set(kInt, int32_t{kFewDigits}))));
  VecF fraction = set(0.5F);
  if (HWY_UNLIKELY(!hn::AllFalse(kFloat, few))) {
    assign(fraction, few, digits_after_lanes(second()));
  }
  return hn::Add(hn::ConvertTo(kFloat, whole), fraction);
}

/// Uniform in (0,1), as uniform_from_words(), in the lanes of the mask.
template <class Second>
HWY_INLINE VecF uniform_lanes(VecU bits, MaskF lanes, const Second& second) {
  const VecF whole = with_all_digits(hn::ShiftRight<1>(bits), lanes, second);
  return hn::Min(hn::Mul(whole, set(0x1p-31F)), set(kOneMinusEpsilon));
}

/// Exponential with mean 1, as exponential_from_words(), in the lanes of the mask.
template <class Second>
HWY_INLINE VecF exponential_lanes(VecU bits, MaskF lanes, const Second& second) {
  const VecU low = hn::And(bits, hn::Set(kUint, 0x7FFFFFFFU));
  const VecF v = hn::Mul(with_all_digits(low, lanes, second), set(0x1p-32F));
  const MaskF far =
      hn::MaskFromVec(hn::BitCast(kFloat, hn::BroadcastSignBit(hn::BitCast(kInt, bits))));
  const VecF x = hn::IfThenElse(far, v, hn::Sub(set(1.0F), v));
  const VecU shifted = hn::Add(hn::BitCast(kUint, x), hn::Set(kUint, kOneBits - kRootHalfBits));
  const VecI k = hn::Sub(hn::BitCast(kInt, hn::ShiftRight<23>(shifted)), hn::Set(kInt, 127));
  const VecF m = hn::BitCast(kFloat, hn::Add(hn::And(shifted, hn::Set(kUint, 0x007FFFFFU)),
                                             hn::Set(kUint, kRootHalfBits)));
  const MaskF one = float_mask(hn::Eq(k, hn::Zero(kInt)));
  const VecF f = hn::IfThenElse(one, hn::Neg(v), hn::Sub(m, set(1.0F)));
  const VecF s = hn::Div(f, hn::Add(set(2.0F), f));
  const VecF z = hn::Mul(s, s);
  VecF series = mul_add(z, set(kArtanh[2]), set(kArtanh[1]));
  series = mul_add(z, series, set(kArtanh[0]));
  series = mul_add(z, series, set(2.0F));
  return hn::Neg(hn::Add(hn::Mul(hn::ConvertTo(kFloat, k), set(kLogOf2)), hn::Mul(s, series)));
}

/// What numbers of a flight are for besides its tentative collisions, whose blocks count up from 0
/// and stay below 2^29; bits of a block's number.
inline constexpr uint32_t kComponentWords = 1U << 29;  ///< The component that scatters.
inline constexpr uint32_t kLeftoverWords = 2U << 29;  ///< New digits for what a choice leaves over.
inline constexpr uint32_t kDepthWords = 3U << 29;     ///< And for unspent optical depth.

/// A uniform and an exponential number out of a block for them alone.
inline HWY_NOINLINE VecF uniform_of_block(VecU block, VecU stream, VecU sample, VecU pixel,
                                          uint64_t seed) {
  const RandomWords random = philox_lanes(block, stream, sample, pixel, seed);
  return uniform_lanes(random.words[0], all_lanes(), [&] { return random.words[1]; });
}
inline HWY_NOINLINE VecF exponential_of_block(VecU block, VecU stream, VecU sample, VecU pixel,
                                              uint64_t seed) {
  const RandomWords random = philox_lanes(block, stream, sample, pixel, seed);
  return exponential_lanes(random.words[0], all_lanes(), [&] { return random.words[1]; });
}

/// The second words of blocks; see RandomStream.
inline HWY_NOINLINE RandomWords second_words(VecU block, VecU stream, VecU sample, VecU pixel,
                                             uint64_t seed) {
  return philox_lanes(hn::Or(block, hn::Set(kUint, kSecondWords)), stream, sample, pixel, seed);
}

/// What is left of a number beyond a part of it has too few digits this near to the part's end.
inline constexpr float kCoarse = 0x1p-8F;

/// Where the random numbers of a group of lanes stand: rows of a WalkGroup. Makes numbers beyond
/// those of a tentative collision's own block, each a function of its place as they are.
struct RandomCounter {
  const uint32_t* block;
  const uint32_t* stream;
  const uint32_t* sample;
  const uint32_t* pixel;
  uint64_t seed;

  /// A number for a purpose of its own. Numbers of one block and purpose differ in `salt`.
  HWY_INLINE VecF uniform(uint32_t purpose, VecU salt) const {
    return uniform_of_block(hn::Or(hn::Load(kUint, block), hn::Set(kUint, purpose)),
                            hn::Xor(hn::Load(kUint, stream), salt), hn::Load(kUint, sample),
                            hn::Load(kUint, pixel), seed);
  }

  /// An optical depth, for a flight that goes on at a place of which `salt` tells.
  HWY_INLINE VecF exponential(VecU salt) const {
    return exponential_of_block(hn::Or(hn::Load(kUint, block), hn::Set(kUint, kDepthWords)),
                                hn::Xor(hn::Load(kUint, stream), salt), hn::Load(kUint, sample),
                                hn::Load(kUint, pixel), seed);
  }

  /// The number that chooses the component which scatters.
  HWY_INLINE VecF component_uniform() const { return uniform(kComponentWords, hn::Zero(kUint)); }

  /// Decides by a uniform number: true with probability part/(part + rest). The smaller of the two
  /// stands at the number's low end, where it has all its digits. Leaves a number that is uniform
  /// whatever was decided: what is left of the larger gets new digits where it has lost them.
  /// @param number of the decision, of those that one block makes
  HWY_INLINE MaskF split(VecF part, VecF rest, MaskF lanes, uint32_t number, VecF& uniform) const {
    const VecF chosen = hn::Mul(uniform, hn::Add(part, rest));
    const VecF smaller = hn::Min(part, rest);
    const MaskF low = hn::Lt(chosen, smaller);
    VecF above = hn::IfThenElse(low, chosen, hn::Sub(chosen, smaller));
    const VecF limit = hn::Mul(smaller, set(kCoarse));
    const MaskF coarse = hn::AndNot(low, hn::And(lanes, hn::Lt(above, limit)));
    if (HWY_UNLIKELY(!hn::AllFalse(kFloat, coarse))) {
      const VecF digits = this->uniform(kLeftoverWords, hn::Set(kUint, number << 24));
      assign(above, coarse, hn::Mul(digits, limit));
    }
    const VecF width = hn::IfThenElse(low, smaller, hn::Max(part, rest));
    const MaskF some = hn::Gt(width, hn::Zero(kFloat));
    uniform =
        hn::Min(hn::Div(above, hn::IfThenElse(some, width, set(1.0F))), set(kOneMinusEpsilon));
    return hn::Not(hn::Xor(low, hn::Le(part, rest)));
  }
};

/// exp(x) for x ≤ 0, to 2^-22 of itself.
HWY_INLINE VecF exp_of_negative(VecF x) {
  constexpr float kPerLogOf2 = 1.44269504F;
  // log 2 in two parts, the first with so few digits that its multiples are exact
  constexpr float kLogOf2High = 0.693359375F;
  constexpr float kLogOf2Low = -2.12194440e-4F;
  const VecF held = hn::Max(x, set(-120.0F));  // where exp is 0
  const VecF k = hn::Floor(mul_add(held, set(kPerLogOf2), set(0.5F)));
  VecF r = hn::Sub(held, hn::Mul(k, set(kLogOf2High)));
  r = hn::Sub(r, hn::Mul(k, set(kLogOf2Low)));
  // (exp(r) - 1 - r)/r², through the Chebyshev nodes of |r| ≤ log(2)/2
  VecF series = mul_add(r, set(1.3926263e-3F), set(8.3632374e-3F));
  series = mul_add(r, series, set(4.1666554e-2F));
  series = mul_add(r, series, set(1.6666577e-1F));
  series = mul_add(r, series, set(0.5F));
  const VecF power = hn::Add(set(1.0F), mul_add(hn::Mul(r, r), series, r));
  // In two steps, so that results below the least normal number come out.
  const VecI whole = hn::ConvertTo(kInt, k);
  const VecI half = hn::ShiftRight<1>(whole);
  const auto power_of_2 = [](VecI exponent) {
    return hn::BitCast(kFloat, hn::ShiftLeft<23>(hn::Add(exponent, hn::Set(kInt, 127))));
  };
  return hn::Mul(hn::Mul(power, power_of_2(half)), power_of_2(hn::Sub(whole, half)));
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_RANDOM_INL_H_
