#include "freepath/base/binned_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "freepath/base/random.h"

namespace freepath {
namespace {

template <std::size_t kBins>
struct Sum {
  typename BinnedSum<kBins>::Array bins = {};
  int8_t top = BinnedSum<kBins>::kEmpty;

  void add(double number) { BinnedSum<kBins>::add(bins, top, number); }
  void merge(const Sum& other) { BinnedSum<kBins>::merge(bins, top, other.bins, other.top); }
  double value() const { return BinnedSum<kBins>::value(bins, top); }
  bool operator==(const Sum&) const = default;
};

/// Numbers of magnitudes from 2^-exponents to 2^exponents, of both signs, among them zeros.
std::vector<double> numbers_of(int count, int exponents, bool are_floats) {
  RandomStream random(7, 0, 0, static_cast<uint32_t>(exponents));
  std::vector<double> numbers;
  for (int i = 0; i < count; ++i) {
    const double magnitude = std::exp2((2.0 * random.uniform() - 1) * exponents);
    double number = (random.uniform() - 0.5) * magnitude;
    if (i % 11 == 0) number = 0;
    numbers.push_back(are_floats ? static_cast<float>(number) : number);
  }
  return numbers;
}

template <std::size_t kBins>
void expect_same_in_any_order(int exponents) {
  std::vector<double> numbers = numbers_of(1000, exponents, kBins == 2);
  Sum<kBins> all;
  for (const double number : numbers) all.add(number);
  RandomStream random(3, 1, 0, static_cast<uint32_t>(exponents));
  for (int trial = 0; trial < 50; ++trial) {
    for (std::size_t i = numbers.size(); i > 1; --i) {
      std::swap(numbers[i - 1], numbers[static_cast<std::size_t>(random.uniform() * i)]);
    }
    // In groups, merged in an order of their own.
    std::vector<Sum<kBins>> groups(1 + trial % 9);
    for (const double number : numbers) {
      groups[static_cast<std::size_t>(random.uniform() * groups.size())].add(number);
    }
    Sum<kBins> merged;
    for (std::size_t i = groups.size(); i-- > 0;) merged.merge(groups[i]);
    ASSERT_EQ(merged, all) << exponents;
    ASSERT_EQ(std::bit_cast<uint64_t>(merged.value()), std::bit_cast<uint64_t>(all.value()));
  }
}

TEST(BinnedSum, IsTheSameInAnyOrderAndGrouping) {
  for (const int exponents : {0, 3, 40, 126}) {
    expect_same_in_any_order<2>(exponents);
    expect_same_in_any_order<3>(exponents);
  }
  expect_same_in_any_order<3>(250);
}

template <std::size_t kBins>
void expect_same_of_several(int exponents) {
  const std::vector<double> numbers = numbers_of(1000, exponents, kBins == 2);
  // All at once, one by one, and in parts of all lengths, empty ones among them.
  for (const std::size_t longest : {1000U, 1U, 2U, 37U}) {
    Sum<kBins> one_by_one;
    Sum<kBins> in_parts;
    std::size_t length = longest;
    for (std::size_t first = 0; first < numbers.size(); first += length) {
      length = std::min(longest == 37 ? first % 38 : longest, numbers.size() - first);
      const auto part = std::span(numbers).subspan(first, length);
      BinnedSum<kBins>::add_all(in_parts.bins, in_parts.top, part);
      for (const double number : part) one_by_one.add(number);
      ASSERT_EQ(in_parts, one_by_one) << first;
      if (length > 0) continue;
      length = 1;
      in_parts.add(numbers[first]);
      one_by_one.add(numbers[first]);
    }
  }
}

TEST(BinnedSum, AddsSeveralAsOneByOne) {
  for (const int exponents : {0, 10, 60, 120}) {
    expect_same_of_several<2>(exponents);
    expect_same_of_several<3>(2 * exponents);
  }
}

TEST(BinnedSum, IsAsNearAsItsBinsSay) {
  for (const int exponents : {1, 10, 30, 60, 120}) {
    const std::vector<double> numbers = numbers_of(20'000, exponents, true);
    Sum<2> two;
    Sum<3> three;
    long double exact = 0;
    double largest = 0;
    for (const double number : numbers) {
      two.add(number);
      three.add(number);
      exact += number;
      largest = std::max(largest, std::abs(number));
    }
    const auto count = static_cast<double>(numbers.size());
    EXPECT_NEAR(two.value(), static_cast<double>(exact), count * largest * std::exp2(-35));
    EXPECT_NEAR(three.value(), static_cast<double>(exact), count * largest * std::exp2(-52));
  }
}

// Squares of floats: a variance of 0 must come out as one.
TEST(BinnedSum, HoldsEqualSquaresExactly) {
  for (const float x : {1.0F / 3, 1e-30F, 7.1e12F, 3.3e38F, 1e-44F}) {
    const double square = double{x} * x;
    Sum<3> sum;
    for (int i = 0; i < 1024; ++i) sum.add(square);
    EXPECT_EQ(sum.value(), 1024 * square) << x;
  }
}

TEST(BinnedSum, TakesTheSmallestAndTheLargest) {
  Sum<2> sum;
  EXPECT_EQ(sum.value(), 0);
  sum.add(1e-45);
  EXPECT_GT(sum.value(), 0);
  sum.add(3.4e38);
  sum.add(-3.4e38);
  EXPECT_EQ(sum.value(), 0);  // far below a unit of the largest
  sum.add(1e30);
  EXPECT_NEAR(sum.value(), 1e30, 1e30 * std::exp2(-34));
}

// As many as it may take, of the largest that a bin takes: by doubling.
TEST(BinnedSum, HasRoomForAllSamples) {
  const double largest = std::nextafter(std::exp2(33), 0.0);
  Sum<2> sum;
  sum.add(largest);
  for (int i = 0; i < 29; ++i) sum.merge(Sum<2>(sum));
  EXPECT_NEAR(sum.value(), std::exp2(29) * largest, std::exp2(29));
}

}  // namespace
}  // namespace freepath
