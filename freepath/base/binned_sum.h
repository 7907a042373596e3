#pragma once
/// @file Sums that do not depend on the order of what is added.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace freepath {

/// Adds numbers so that the result is the same, bit by bit, in whatever order they come and however
/// they are grouped [Demmel15].
///
/// The range of numbers is cut into bins of kBits binary digits, the same for all sums. A number is
/// split into whole multiples of the units of bins, by rounding from the highest down, which
/// depends on the number alone; each bin is a sum of integers, hence exact. Kept are the bin of the
/// largest magnitude so far and those right below it, `kBins` in all: a number counts with an error
/// of at most 2^-(kBits · (kBins - 1) + 1) of the largest one, which is far below the error of a
/// mean.
///
/// The bins and the number of the highest lie apart, where the caller wants them.
///
/// Numbers of magnitudes from 2^-306 to 2^305, or 0; 2^29 of them at most, or 2^30 where their
/// magnitudes are not all the largest that a bin takes.
template <std::size_t kBins>
class BinnedSum {
 public:
  using Array = std::array<int64_t, kBins>;
  static constexpr int kBits = 34;
  static constexpr int kLowest = -9;
  static constexpr int kHighest = 8;
  /// `top` of a sum of nothing; its bins are 0.
  static constexpr int8_t kEmpty = kLowest;

  /// Adds a finite number.
  static void add(Array& bins, int8_t& top, double number) {
    if (std::abs(number) >= kLimits[index(top)]) raise(bins, top, bin_of(number));
    double rest = number;
    for (std::size_t i = 0; i < kBins; ++i) {
      const int bin = top - static_cast<int>(i);
      const double count = rounded(rest * kUnits[index(-bin)]);
      bins[i] += static_cast<int64_t>(count);
      rest -= count * kUnits[index(bin)];
    }
  }

  /// Adds finite numbers, as add() does one after the other; of several in half the time.
  static void add_all(Array& bins, int8_t& top, std::span<const double> numbers) {
    double largest = 0;
    for (const double number : numbers) largest = std::max(largest, std::abs(number));
    if (largest >= kLimits[index(top)]) raise(bins, top, bin_of(largest));
    Array shifted{};
    std::array<double, kBins> units;
    std::array<double, kBins> per_unit;
    for (std::size_t i = 0; i < kBins; ++i) {
      units[i] = kUnits[index(top - static_cast<int>(i))];
      per_unit[i] = kUnits[index(static_cast<int>(i) - top)];
    }
    for (double rest : numbers) {
      for (std::size_t i = 0; i < kBins; ++i) {
        const double count = rest * per_unit[i] + kShift;
        shifted[i] += std::bit_cast<int64_t>(count) - std::bit_cast<int64_t>(kShift);
        rest -= (count - kShift) * units[i];
      }
    }
    for (std::size_t i = 0; i < kBins; ++i) bins[i] += shifted[i];
  }

  /// Adds what another sum holds.
  static void merge(Array& bins, int8_t& top, Array other, int8_t other_top) {
    if (other_top > top) raise(bins, top, other_top);
    if (top > other_top) raise(other, other_top, top);
    for (std::size_t i = 0; i < kBins; ++i) bins[i] += other[i];
  }

  /// The sum, rounded.
  static double value(const Array& bins, int8_t top) {
    double sum = 0;
    for (std::size_t i = kBins; i-- > 0;) {
      sum += static_cast<double>(bins[i]) * kUnits[index(top - static_cast<int>(i))];
    }
    return sum;
  }

 private:
  /// 1.5 · 2^52, around which doubles are whole numbers that differ as their bits do.
  static constexpr double kShift = 6755399441055744.0;
  static constexpr int kFirst = -16;
  static constexpr int kCount = 33;
  static constexpr std::size_t index(int bin) { return static_cast<std::size_t>(bin - kFirst); }

  static constexpr double power_of_two(int exponent) {
    return std::bit_cast<double>(static_cast<uint64_t>(exponent + 1023) << 52);
  }
  static constexpr std::array<double, kCount> make_units() {
    std::array<double, kCount> units{};
    for (int i = 0; i < kCount; ++i) units[i] = power_of_two(kBits * (i + kFirst));
    return units;
  }
  /// Magnitudes from which on numbers belong to a higher bin: half its unit.
  static constexpr std::array<double, kCount> make_limits() {
    std::array<double, kCount> limits{};
    for (int i = 0; i < kCount; ++i) limits[i] = power_of_two(kBits * (i + kFirst + 1) - 1);
    return limits;
  }
  static constexpr std::array<double, kCount> kUnits = make_units();
  static constexpr std::array<double, kCount> kLimits = make_limits();

  /// The highest bin of which a number's part is not 0.
  static int8_t bin_of(double number) {
    int bin = kLowest;
    while (bin < kHighest && std::abs(number) >= kLimits[index(bin)]) ++bin;
    return static_cast<int8_t>(bin);
  }

  /// The nearest whole number, of those between two the even one: magnitudes below 2^51.
  static double rounded(double number) { return (number + kShift) - kShift; }

  /// Makes room for larger numbers; the lowest bins are given up.
  static void raise(Array& bins, int8_t& top, int8_t new_top) {
    const auto by = static_cast<std::size_t>(new_top - top);
    for (std::size_t i = kBins; i-- > 0;) bins[i] = i >= by ? bins[i - by] : 0;
    top = new_top;
  }
};

}  // namespace freepath
