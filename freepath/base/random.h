#pragma once
/// @file Counter-based random numbers: Philox4x32-7 of [Salmon11]. A number is a function of its
/// place alone (seed, pixel, sample, stream, block), hence a result never depends on threads,
/// batches or tiles. The lanes of the walk evaluate the same function (tracking/random-inl.h).

#include <array>
#include <cmath>
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

/// [0,1) with 24 bits.
constexpr float uniform_from_bits(uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24F;
}

/// The largest float below 1, at which what rounding would lift to 1 is held.
inline constexpr float kBelowOne = 1.0F - 0x1p-24F;

/// Uniform in (0,1], never 0, with a relative precision of 2^-24 down to 2^-32, so that the
/// logarithm of it reaches optical depths of 22.
constexpr float open_uniform_from_bits(uint32_t bits) {
  return (static_cast<float>(static_cast<int32_t>(bits >> 1)) + 0.5F) * 0x1p-31F;
}

/// A sequence of random numbers for one (seed, pixel, sample, stream).
class RandomStream {
 public:
  constexpr RandomStream(uint64_t seed, uint32_t pixel, uint32_t sample, uint32_t stream)
      : key_{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)},
        pixel_(pixel),
        sample_(sample),
        stream_(stream) {}

  constexpr uint32_t bits() {
    if (used_ == 4) {
      words_ = philox({block_++, stream_, sample_, pixel_}, key_);
      used_ = 0;
    }
    return words_[used_++];
  }
  /// [0,1).
  constexpr float uniform() { return uniform_from_bits(bits()); }
  /// Exponential with mean 1: an optical depth.
  float exponential() { return -std::log(open_uniform_from_bits(bits())); }

 private:
  std::array<uint32_t, 2> key_;
  std::array<uint32_t, 4> words_{};
  uint32_t pixel_, sample_, stream_;
  uint32_t block_ = 0;
  uint32_t used_ = 4;
};

}  // namespace freepath
