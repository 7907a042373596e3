#pragma once
/// @file How far pictures are from a reference, and whether chance explains it.

#include <array>
#include <cstddef>
#include <vector>

#include "freepath/evaluation/pixel_estimates.h"

namespace freepath {

/// Squared differences from a reference, less what the reference's own variance adds: for an
/// unbiased picture its variance, estimated without bias (hence it may be negative).
struct SquaredError {
  double mse = 0;                          ///< Over pixels and channels.
  double relative_mse = 0;                 ///< Each over reference² + 0.01.
  std::array<double, 3> channel_mse = {};  ///< Over pixels.
};

/// @param means three a pixel, of the reference's size
SquaredError squared_error(const std::vector<float>& means, const PixelEstimates& reference);

/// How many standard errors means lie apart, of the whole picture and of its blocks. Pixels that
/// one of the two has no samples of are left out.
struct BiasTest {
  static constexpr int kBlock = 16;  ///< Edge of a block [pixels].

  std::array<double, 3> z = {};     ///< Of the mean of each channel.
  std::vector<float> block_z = {};  ///< Of the blocks, row after row, three each.
  int blocks_across = 0, blocks_down = 0;

  /// How many tests these are.
  std::size_t tests() const { return z.size() + block_z.size(); }
  /// The largest |z|.
  double worst() const;
  double worst_block() const;
};

BiasTest test_bias(const PixelEstimates& estimates, const PixelEstimates& reference);

}  // namespace freepath
