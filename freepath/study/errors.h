#pragma once
/// @file How far pictures are from a reference, and whether chance explains it.

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "freepath/study/pixel_estimates.h"

namespace freepath {

/// Squared differences from a reference, less what the reference's own variance adds: for an
/// unbiased picture its variance, estimated without bias (hence it may be negative).
struct SquaredError {
  double mse = 0;           ///< Over pixels and channels.
  double relative_mse = 0;  ///< Mean of squared errors, each over reference² + 0.01.
  std::array<double, 3> channel_mse = {};  ///< Over pixels.
};

/// @param means three a pixel, of the reference's size
SquaredError squared_error(const std::vector<float>& means, const PixelEstimates& reference);

/// What a bias test says.
enum class BiasVerdict {
  kPasses,
  kFails,
  /// A few pixels hold most of the variance: means are not normal, and rare samples that were not
  /// drawn are missing in variances as well.
  kUndecided,
};

/// "passes", "fails" or "undecided".
std::string_view to_string(BiasVerdict verdict);

/// How many standard errors means lie apart, of the whole picture and of its blocks. Pixels that
/// one of the two has no samples of are left out. Of the variances of a sample that both pictures
/// state the larger one counts, for both, where their numbers of samples are known: so that scores
/// of means of few rare and bright samples are no larger than normal ones.
struct BiasTest {
  /// Edge of a block [pixels]; the last ones of a row and a column take what is left.
  static constexpr int kBlock = 16;

  std::array<double, 3> z = {};     ///< Standard errors of the mean of each channel.
  std::vector<float> block_z = {};  ///< Standard errors of the blocks, row after row, three each.
  int blocks_across = 0, blocks_down = 0;
  bool is_heavy_tailed = false;  ///< See BiasVerdict::kUndecided.

  /// How many tests these are.
  std::size_t tests() const { return z.size() + block_z.size(); }
  /// The largest |z|.
  double worst() const;
  double worst_block() const;
  /// @param threshold the largest |z| that chance explains
  BiasVerdict verdict(double threshold) const;
};

/// The number of pixels of equal variance by which the variance of the mean would be made:
/// (Σv)²/Σv².
double effective_pixels(const PixelEstimates& estimates);

BiasTest test_bias(const PixelEstimates& estimates, const PixelEstimates& reference);

}  // namespace freepath
