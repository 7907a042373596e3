// The lanes' random numbers and functions, on every target: bit for bit those of the scalar code,
// and of each other.

#include "freepath/transport/simd_targets.h"
// simd_targets.h comes first: it says which targets there are.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/tracking/random_lanes_test.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes next: it includes this file once for each target.
#include <hwy/highway.h>

#include "freepath/tracking/random-inl.h"

#ifndef FREEPATH_TESTS_TRACKING_RANDOM_LANES_TEST_ONCE
#define FREEPATH_TESTS_TRACKING_RANDOM_LANES_TEST_ONCE
#include <cstdint>
#include <vector>

namespace freepath::testing {

/// What lanes make of words, of numbers, and of pairs of parts.
struct LaneRows {
  std::vector<uint32_t> bits, second;                    // in, as many as a multiple of 64
  std::vector<float> number, part, rest;                 // in
  std::vector<float> uniform, exponential, power, left;  // out
  std::vector<uint8_t> decision;                         // out
};

}  // namespace freepath::testing
#endif

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

void fill_lane_rows(freepath::testing::LaneRows& rows) {
  HWY_ALIGN_MAX uint32_t zeros[kLanes] = {};
  for (size_t i = 0; i < rows.bits.size(); i += kLanes) {
    const VecU bits = hn::LoadU(kUint, &rows.bits[i]);
    const auto second = [&] { return hn::LoadU(kUint, &rows.second[i]); };
    hn::StoreU(uniform_lanes(bits, all_lanes(), second), kFloat, &rows.uniform[i]);
    hn::StoreU(exponential_lanes(bits, all_lanes(), second), kFloat, &rows.exponential[i]);
    hn::StoreU(exp_of_negative(hn::LoadU(kFloat, &rows.number[i])), kFloat, &rows.power[i]);
    HWY_ALIGN_MAX uint32_t sample[kLanes];
    hn::Store(hn::Iota(kUint, static_cast<uint32_t>(i)), kUint, sample);
    const RandomCounter random = {zeros, zeros, sample, zeros, 5};
    VecF uniform = random.uniform(kComponentWords, hn::Zero(kUint));
    const MaskF first = random.split(hn::LoadU(kFloat, &rows.part[i]),
                                     hn::LoadU(kFloat, &rows.rest[i]), all_lanes(), 1, uniform);
    hn::StoreU(uniform, kFloat, &rows.left[i]);
    const uint32_t decided = bits_of(first);
    for (size_t lane = 0; lane < kLanes; ++lane) rows.decision[i + lane] = decided >> lane & 1;
  }
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "tests/statistics.h"

namespace freepath::testing {
namespace {

std::vector<std::function<void(LaneRows&)>> targets_here() {
  const std::pair<int64_t, void (*)(LaneRows&)> targets[] = {
#if HWY_TARGETS & HWY_AVX3
    {HWY_AVX3, &N_AVX3::fill_lane_rows},
#endif
#if HWY_TARGETS & HWY_AVX2
    {HWY_AVX2, &N_AVX2::fill_lane_rows},
#endif
#if HWY_TARGETS & HWY_SSE4
    {HWY_SSE4, &N_SSE4::fill_lane_rows},
#endif
    {HWY_STATIC_TARGET, &HWY_STATIC_DISPATCH(fill_lane_rows)},
  };
  std::vector<std::function<void(LaneRows&)>> here;
  for (const auto& [bit, fill] : targets) {
    if ((hwy::SupportedTargets() & bit) != 0) here.emplace_back(fill);
  }
  return here;
}

/// Words of all sizes, the smallest and the largest, with either first bit.
LaneRows rows_of(std::size_t count, float part, float rest) {
  LaneRows rows;
  RandomStream random(3, 1, 4, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const uint32_t word = i < 64 ? uint32_t(i / 4) : random.bits() >> (i % 32);
    rows.bits.push_back(i % 4 == 0   ? word
                        : i % 4 == 1 ? ~word
                        : i % 4 == 2 ? word | 0x80000000U
                                     : ~word & 0x7FFFFFFFU);
    rows.second.push_back(i < 4 ? 0 : random.bits());
    rows.number.push_back(-std::ldexp(random.uniform(), static_cast<int>(i % 32) - 24));
    rows.part.push_back(part);
    rows.rest.push_back(rest);
  }
  for (auto* row : {&rows.uniform, &rows.exponential, &rows.power, &rows.left}) row->resize(count);
  rows.decision.resize(count);
  return rows;
}

TEST(RandomLanes, AreTheScalarNumbersBitForBitOnEveryTarget) {
  LaneRows rows = rows_of(1 << 16, 1, 3);
  std::vector<LaneRows> results;
  for (const auto& fill : targets_here()) {
    fill(rows);
    for (std::size_t i = 0; i < rows.bits.size(); ++i) {
      ASSERT_EQ(rows.uniform[i], uniform_from_words(rows.bits[i], rows.second[i])) << rows.bits[i];
      ASSERT_EQ(rows.exponential[i], exponential_from_words(rows.bits[i], rows.second[i]))
          << rows.bits[i];
      const double power = std::exp(double{rows.number[i]});
      // Below the least normal number digits are as wide as the least of all.
      ASSERT_NEAR(rows.power[i], power, std::max(2.5e-7 * power, 0x1p-149)) << rows.number[i];
    }
    results.push_back(rows);
  }
  ASSERT_GE(results.size(), 2U);
  for (const LaneRows& other : results) {
    EXPECT_EQ(other.power, results[0].power);
    EXPECT_EQ(other.left, results[0].left);
    EXPECT_EQ(other.decision, results[0].decision);
  }
}

// Whatever is decided, and however rare it is, what is left is uniform: also far below 2^-24.
TEST(RandomLanes, ASplitNumberStaysUniform) {
  constexpr std::size_t kNumbers = 1 << 18;
  for (const float ratio : {1e-3F, 0.3F, 1.0F, 2.5F, 1e3F}) {
    LaneRows rows = rows_of(kNumbers, ratio, 1);
    targets_here().front()(rows);
    // Of either outcome: in octaves from 1/2 down, where few digits would show, and in 16 parts.
    std::vector<uint64_t> octaves[2] = {std::vector<uint64_t>(12), std::vector<uint64_t>(12)};
    std::vector<uint64_t> parts[2] = {std::vector<uint64_t>(16), std::vector<uint64_t>(16)};
    uint64_t total[2] = {};
    for (std::size_t i = 0; i < kNumbers; ++i) {
      const float left = rows.left[i];
      ASSERT_TRUE(left > 0 && left < 1) << left;
      ++total[rows.decision[i]];
      ++octaves[rows.decision[i]][std::min(-std::ilogb(left) - 1, 11)];
      ++parts[rows.decision[i]][static_cast<std::size_t>(left * 16)];
    }
    EXPECT_GT(binomial_two_sided_p(total[1], kNumbers, double(ratio) / (1 + double(ratio))), 1e-4);
    for (int outcome = 0; outcome < 2; ++outcome) {
      std::vector<double> of_octaves;
      for (int i = 0; i < 12; ++i) {
        of_octaves.push_back(static_cast<double>(total[outcome]) *
                             std::ldexp(1.0, -std::min(i + 1, 11)));
      }
      EXPECT_TRUE(check_chi_square("octaves", chi_square_test(octaves[outcome], of_octaves)))
          << ratio << ", " << outcome;
      const std::vector<double> alike(16, static_cast<double>(total[outcome]) / 16);
      EXPECT_TRUE(check_chi_square("parts", chi_square_test(parts[outcome], alike)))
          << ratio << ", " << outcome;
    }
  }
}

}  // namespace
}  // namespace freepath::testing
#endif  // HWY_ONCE
