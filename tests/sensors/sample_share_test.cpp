#include "freepath/sensors/sample_share.h"

#include <gtest/gtest.h>

#include <cmath>

namespace freepath {
namespace {

TEST(SampleShare, IsOneAtFirst) {
  constexpr SampleShare kShare;
  static_assert(kShare.is_one());
  for (uint32_t rounds = 0; rounds < 40; ++rounds) EXPECT_EQ(kShare.samples(rounds), rounds);
}

// However rounds are cut, each sample is of one part.
TEST(SampleShare, SamplesGrowWithRounds) {
  for (uint8_t step = 0; step < SampleShare::kSteps; ++step) {
    const SampleShare share(step);
    EXPECT_EQ(share.samples(0), 0U);
    for (uint32_t rounds = 1; rounds < 200; ++rounds) {
      EXPECT_GE(share.samples(rounds), share.samples(rounds - 1));
      EXPECT_GE(share.samples(rounds), std::min(rounds, SampleShare::kFewest));
    }
    for (const uint32_t rounds : {64U, 1000U, 1U << 26}) {
      EXPECT_EQ(share.samples(rounds), 4 + std::floor((rounds - 4) * share.value()))
          << share.value();
    }
  }
}

TEST(SampleShare, KnowsTheRoundOfASample) {
  for (uint8_t step = 0; step < SampleShare::kSteps; ++step) {
    const SampleShare share(step);
    for (uint32_t sample = 0; sample < 200; ++sample) {
      const uint32_t round = share.round_of(sample);
      EXPECT_LE(share.samples(round), sample) << share.value();
      EXPECT_GT(share.samples(round + 1), sample) << share.value();
    }
  }
}

TEST(SampleShare, IsNextToWhatIsWanted) {
  for (uint8_t step = 0; step < SampleShare::kSteps; ++step) {
    EXPECT_EQ(SampleShare::next_to(SampleShare(step).value()), SampleShare(step));
  }
  EXPECT_EQ(SampleShare::next_to(0).value(), 0.25);
  EXPECT_EQ(SampleShare::next_to(1e30).value(), 4);
  // Between 1 and 23/16 by ratio.
  EXPECT_EQ(SampleShare::next_to(1.19).value(), 1);
  EXPECT_EQ(SampleShare::next_to(1.21).value(), 1.4375);
}

}  // namespace
}  // namespace freepath
