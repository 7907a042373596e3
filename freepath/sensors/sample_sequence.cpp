#include "freepath/sensors/sample_sequence.h"

#include "freepath/base/reversed_bits.h"

namespace freepath {
namespace {

// Streams of the hashes of Sobol' points, apart from those of independent numbers.
constexpr uint32_t kHashStreams = 0xC0000000U;

/// A nested uniform scramble of a fraction whose bits are in reverse, and come out in order: a
/// permutation in which each bit is flipped by a hash of those below it alone, an idea of
/// [Laine11]; the constants are of [Vegdahl21].
constexpr uint32_t scramble_reversed(uint32_t reversed, uint32_t hash) {
  reversed ^= reversed * 0x3D20ADEAU;
  reversed += hash;
  reversed *= (hash >> 16) | 1U;
  reversed ^= reversed * 0x05526C56U;
  reversed ^= reversed * 0x53A22864U;
  return reversed_bits(reversed);
}

}  // namespace

SampleSequence::Hashes SampleSequence::hashes(uint64_t seed, uint32_t pixel, uint32_t dimension) {
  const auto words = philox({0, kHashStreams + dimension, 0, pixel},
                            {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)});
  return {words[0], words[1], words[2]};
}

std::array<float, 2> SampleSequence::sobol_pair(const Hashes& hashes, uint32_t sample) {
  const uint32_t index = scramble_reversed(reversed_bits(sample), hashes.order);
  return {uniform_from_bits(scramble_reversed(index, hashes.first)),
          uniform_from_bits(scramble_reversed(sobol_second_reversed(index), hashes.second))};
}

std::array<float, 2> SampleSequence::pair(uint32_t dimension) const {
  if (kind_ == SampleKind::kIndependent) {
    RandomStream stream(seed_, pixel_, sample_, kSampleStreams + dimension);
    const float first = stream.uniform();
    return {first, stream.uniform()};
  }
  return sobol_pair(hashes(seed_, pixel_, dimension), sample_);
}

float SampleSequence::single(uint32_t dimension) const {
  if (kind_ == SampleKind::kIndependent) {
    return RandomStream(seed_, pixel_, sample_, kSampleStreams + dimension).uniform();
  }
  return sobol_pair(hashes(seed_, pixel_, dimension), sample_)[0];
}

}  // namespace freepath
