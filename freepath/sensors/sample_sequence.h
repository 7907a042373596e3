#pragma once
/// @file The random numbers of the first dimensions of a path: independent, or stratified over the
/// samples of a pixel by scrambled Sobol' points.

#include <array>
#include <cstdint>

#include "freepath/base/random.h"

namespace freepath {

/// Where the numbers of a path come from.
enum class SampleKind {
  kIndependent,  ///< Independent of each other.
  kSobol         ///< Stratified over the samples of a pixel.
};

/// The numbers of one sample of a pixel: a function of (seed, pixel, sample, dimension) alone. Each
/// number is uniform in [0, 1) with 24 bits, so estimates are unbiased with either kind.
///
/// With kSobol the pairs of one pixel and dimension, for all samples, are a (0,2)-sequence in base
/// 2 under nested uniform scrambling [Owen95], its order shuffled likewise: of the first 2^m
/// samples each box of size 2^-a by 2^-(m-a) holds one. Pairs of other pixels and dimensions are
/// scrambled and shuffled by other hashes, hence independent ("padding", [Burley20]).
///
/// Both kinds take their words from streams that no walk uses (kSampleStreams and up).
class SampleSequence {
 public:
  constexpr SampleSequence(SampleKind kind, uint64_t seed, uint32_t pixel, uint32_t sample)
      : kind_(kind), seed_(seed), pixel_(pixel), sample_(sample) {}

  /// Two numbers. A dimension serves for one pair or one single number.
  std::array<float, 2> pair(uint32_t dimension) const;

  /// One number: the first of the pair.
  float single(uint32_t dimension) const;

  /// What all samples of a pixel have in common in a dimension, with kSobol.
  struct Hashes {
    uint32_t order, first, second;
  };
  static Hashes hashes(uint64_t seed, uint32_t pixel, uint32_t dimension);
  /// The pair of a sample.
  static std::array<float, 2> sobol_pair(const Hashes& hashes, uint32_t sample);

 private:
  SampleKind kind_;
  uint64_t seed_;
  uint32_t pixel_, sample_;
};

/// The first of the random streams (random.h) that sample sequences draw from, above those of the
/// bounces of a walk.
inline constexpr uint32_t kSampleStreams = 0x80000000U;

/// The second coordinate of Sobol's sequence, bits in reverse: the matrix of binomial coefficients
/// modulo 2 times the index. A coefficient (k over j) is odd where the bits of j are among those of
/// k (Lucas), so the product is a sum over supersets, one bit of the positions at a time.
constexpr uint32_t sobol_second_reversed(uint32_t index) {
  index ^= (index >> 1) & 0x55555555U;
  index ^= (index >> 2) & 0x33333333U;
  index ^= (index >> 4) & 0x0F0F0F0FU;
  index ^= (index >> 8) & 0x00FF00FFU;
  index ^= (index >> 16) & 0x0000FFFFU;
  return index;
}

}  // namespace freepath
