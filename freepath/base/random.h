#pragma once
/// @file Counter-based random numbers: Philox4x32-7 of [Salmon11]. A number is a function of its
/// place alone (seed, pixel, sample, stream, block), hence a result never depends on threads,
/// batches or tiles. The lanes of the walk evaluate the same function (tracking/random-inl.h).

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace freepath {

inline constexpr int kPhiloxRounds = 7;  // the fewest that pass BigCrush [Salmon11, Table 2]
inline constexpr uint32_t kPhiloxMultiplier0 = 0xD2511F53U;
inline constexpr uint32_t kPhiloxMultiplier1 = 0xCD9E8D57U;
inline constexpr uint32_t kPhiloxWeyl0 = 0x9E3779B9U;
inline constexpr uint32_t kPhiloxWeyl1 = 0xBB67AE85U;

/// Philox4x32: four random words from a counter and a key [Salmon11, Sec. 3.3].
constexpr std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter,
                                         std::array<uint32_t, 2> key, int rounds = kPhiloxRounds) {
  for (int round = 0; round < rounds; ++round) {
    const uint64_t product0 = uint64_t{kPhiloxMultiplier0} * counter[0];
    const uint64_t product1 = uint64_t{kPhiloxMultiplier1} * counter[2];
    counter = {static_cast<uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
               static_cast<uint32_t>(product1),
               static_cast<uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
               static_cast<uint32_t>(product0)};
    key[0] += kPhiloxWeyl0;
    key[1] += kPhiloxWeyl1;
  }
  return counter;
}

/// What a random stream is for; streams of one path never overlap.
enum class StreamPurpose : uint32_t { kWalk = 0, kShadowWalk = 1, kScatter = 2, kCamera = 3 };

/// Number of the stream for a purpose at the given bounce of a path.
constexpr uint32_t stream_number(StreamPurpose purpose, uint32_t bounce) {
  return bounce * 4 + static_cast<uint32_t>(purpose);
}

/// [0,1) with 24 bits: for places and tables, not for what may happen less often than 2^-24.
constexpr float uniform_from_bits(uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24F;
}

/// The largest float below 1, at which what rounding would lift to 1 is held.
inline constexpr float kOneMinusEpsilon = 1.0F - 0x1p-24F;

/// Bits of the 31 of a number that have to count for it to have all its digits.
/// Where they don't (one number in 256), a second word gives the digits that follow.
inline constexpr uint32_t kFewDigits = 1U << 23;

/// The block of second words of the same stream: the second of word i is word i there.
inline constexpr uint32_t kSecondWords = 0x80000000U;

/// Where in its unit interval the number stands that 31 bits begin: digits from a second word.
constexpr float digits_after(uint32_t second) {
  return (static_cast<float>(static_cast<int32_t>(second >> 1)) + 0.5F) * 0x1p-31F;
}

/// Uniform in (0,1), with a relative precision of 2^-23 down to 2^-32 and of 2^-(63-n) at 2^-n
/// below, so that what has a probability of 1e-12 happens as often as that.
/// @param second read where the upper 31 bits of `bits` lie below kFewDigits
constexpr float uniform_from_words(uint32_t bits, uint32_t second) {
  const uint32_t half = bits >> 1;
  const float fraction = half < kFewDigits ? digits_after(second) : 0.5F;
  return std::min((static_cast<float>(static_cast<int32_t>(half)) + fraction) * 0x1p-31F,
                  kOneMinusEpsilon);
}

/// 2 artanh(s)/s - 2, over s²: an interpolant through the Chebyshev nodes of [0, 0.0295], good to
/// 3e-9 of the logarithm. The lanes evaluate the same polynomials in the same order.
inline constexpr float kArtanh[3] = {0.66666685F, 0.39988778F, 0.29580053F};
inline constexpr float kLogOf2 = 0.69314718F;
inline constexpr uint32_t kOneBits = 0x3F800000U;
inline constexpr uint32_t kRootHalfBits = 0x3F3504F3U;  ///< Bits of sqrt(1/2).

/// Exponential with mean 1, to some 2^-23 of itself, from 2^-64 to 44. The first bit says on which
/// side of log 2 it lies; below, it is -log(1 - v) of a uniform v with all its digits near 0, and
/// above, it is -log(v).
/// @param second read where the lower 31 bits of `bits` lie below kFewDigits
constexpr float exponential_from_words(uint32_t bits, uint32_t second) {
  const uint32_t low = bits & 0x7FFFFFFFU;
  const float fraction = low < kFewDigits ? digits_after(second) : 0.5F;
  const float v = (static_cast<float>(static_cast<int32_t>(low)) + fraction) * 0x1p-32F;
  const float x = low != bits ? v : 1.0F - v;
  // x = 2^k m, with m from sqrt(1/2) to sqrt(2)
  const uint32_t shifted = std::bit_cast<uint32_t>(x) + (kOneBits - kRootHalfBits);
  const int32_t k = static_cast<int32_t>(shifted >> 23) - 127;
  const auto m = std::bit_cast<float>((shifted & 0x007FFFFFU) + kRootHalfBits);
  const float f = k == 0 ? -v : m - 1.0F;
  const float s = f / (2.0F + f);
  const float z = s * s;
  const float series = 2.0F + z * (kArtanh[0] + z * (kArtanh[1] + z * kArtanh[2]));
  return -(static_cast<float>(k) * kLogOf2 + s * series);
}

/// A sequence of random numbers for one (seed, pixel, sample, stream).
class RandomStream {
 public:
  /// @param first_block of four words, if others are drawn elsewhere
  constexpr RandomStream(uint64_t seed, uint32_t pixel, uint32_t sample, uint32_t stream,
                         uint32_t first_block = 0)
      : key_{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)},
        pixel_(pixel),
        sample_(sample),
        stream_(stream),
        block_(first_block) {}

  constexpr uint32_t bits() {
    if (used_ == 4) {
      words_ = philox({block_++, stream_, sample_, pixel_}, key_);
      used_ = 0;
    }
    return words_[used_++];
  }
  /// (0,1), as uniform_from_words().
  constexpr float uniform() {
    const uint32_t word = bits();
    if ((word >> 1) < kFewDigits) [[unlikely]]
      return uniform_from_words(word, second());
    return uniform_from_words(word, 0);
  }
  /// Exponential with mean 1: an optical depth, as exponential_from_words().
  constexpr float exponential() {
    const uint32_t word = bits();
    return exponential_from_words(word, (word & 0x7FFFFFFFU) < kFewDigits ? second() : 0);
  }

 private:
  /// The second word of the one drawn last: a function of its own, so that the usual way is short.
  [[gnu::noinline]] constexpr uint32_t second() const {
    return philox({(block_ - 1) | kSecondWords, stream_, sample_, pixel_}, key_)[used_ - 1];
  }

  std::array<uint32_t, 2> key_;
  std::array<uint32_t, 4> words_{};
  uint32_t pixel_, sample_, stream_;
  uint32_t block_;
  uint32_t used_ = 4;
};

}  // namespace freepath
