#pragma once
/// @file Which part of a picture's samples a pixel takes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace freepath {

/// The samples of a pixel over those of the average pixel, in steps of about a root of two, as an
/// index into the table of steps. Samples of a picture are counted in rounds: a round is a sample
/// of each pixel on average.
class SampleShare {
 public:
  constexpr SampleShare() = default;
  /// @param step below kSteps
  constexpr explicit SampleShare(uint8_t step) : step_(step) {}
  /// The step next to a share, at least kSmallest and at most kLargest.
  static constexpr SampleShare next_to(double share) {
    // Where two steps are equally far by ratio.
    std::size_t step = 0;
    while (step + 1 < kSteps &&
           share * share * kUnit * kUnit >
               static_cast<double>(kSixteenths[step]) * kSixteenths[step + 1]) {
      ++step;
    }
    return SampleShare(static_cast<uint8_t>(step));
  }

  constexpr uint8_t step() const { return step_; }
  constexpr double value() const { return static_cast<double>(kSixteenths[step_]) / kUnit; }
  constexpr bool is_one() const { return step_ == kOne; }

  /// Samples that so many rounds come to: in each of the first few one, whatever the share.
  constexpr uint32_t samples(uint32_t rounds) const {
    if (rounds <= kFewest) return rounds;
    const uint64_t more = uint64_t{rounds - kFewest} * kSixteenths[step_] / kUnit;
    return static_cast<uint32_t>(std::min<uint64_t>(kFewest + more, UINT32_MAX));
  }

  /// The round that a sample is of.
  constexpr uint32_t round_of(uint32_t sample) const {
    if (sample < kFewest) return sample;
    const uint64_t sixteenths = kSixteenths[step_];
    const uint64_t more = uint64_t{sample - kFewest} + 1;
    return static_cast<uint32_t>(kFewest + (more * kUnit + sixteenths - 1) / sixteenths - 1);
  }

  constexpr bool operator==(const SampleShare&) const = default;

  static constexpr std::size_t kSteps = 9;
  /// Rounds in which all pixels have a sample, lest their variance be unknown.
  static constexpr uint32_t kFewest = 4;

 private:
  static constexpr uint32_t kUnit = 16;
  static constexpr std::array<uint8_t, kSteps> kSixteenths = {4, 6, 8, 11, 16, 23, 32, 45, 64};
  static constexpr uint8_t kOne = 4;

  uint8_t step_ = kOne;

 public:
  static constexpr double kSmallest = double{kSixteenths.front()} / kUnit;
  static constexpr double kLargest = double{kSixteenths.back()} / kUnit;
};

}  // namespace freepath
