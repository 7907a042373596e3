#include "freepath/study/errors.h"

#include <algorithm>
#include <cmath>

namespace freepath {
namespace {

constexpr double kRelativeFloor = 0.01;  // keeps the relative error of black pixels finite

/// Weights are products of floats, and means are rounded to floats: where nothing varies that is
/// all that differs, by the same in every pixel.
constexpr double kRounding = 0x1p-21;  // relative: some units in the last place

/// Sums of differences, of their variances, and of how far rounding may move them.
///
/// Samples of few bright ones among many dark have a mean and a variance that go together: a
/// picture that happened to draw few of the bright ones is too dark and states too small an error,
/// which no normal law knows of. What the other picture says of the variance of a sample does not
/// go with the first one's mean, so that the larger of both is taken: it cuts either tail.
struct Sums {
  double difference = 0;
  /// Of the difference: as each states its own, and if a sample of either varied as one of the
  /// picture, or of the reference.
  double variance = 0, picture_variance = 0, reference_variance = 0;
  double rounding = 0;

  double z() const {
    const double beyond = std::abs(difference) - rounding;
    const double largest = std::max({variance, picture_variance, reference_variance});
    return beyond <= 0 ? 0 : std::copysign(beyond / std::sqrt(largest), difference);
  }
};

/// The larger magnitude; a NaN is the largest.
double larger(double worst, double value) {
  return std::abs(value) <= worst ? worst : std::abs(value);
}

}  // namespace

SquaredError squared_error(const std::vector<float>& means, const PixelEstimates& reference) {
  SquaredError error;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const double expected = reference.mean[i];
    const double difference = means[i] - expected;
    const double square = difference * difference - reference.variance[i];
    error.channel_mse[i % 3] += square;
    error.relative_mse += square / (expected * expected + kRelativeFloor);
  }
  const auto pixels = static_cast<double>(reference.pixel_count());
  for (double& mse : error.channel_mse) {
    mse /= pixels;
    error.mse += mse / 3;
  }
  error.relative_mse /= 3 * pixels;
  return error;
}

double BiasTest::worst_block() const {
  double worst = 0;
  for (const float value : block_z) worst = larger(worst, value);
  return worst;
}

double BiasTest::worst() const {
  double worst = worst_block();
  for (const double value : z) worst = larger(worst, value);
  return worst;
}

std::string_view to_string(BiasVerdict verdict) {
  switch (verdict) {
    case BiasVerdict::kPasses:
      return "passes";
    case BiasVerdict::kFails:
      return "fails";
    case BiasVerdict::kUndecided:
      break;
  }
  return "undecided";
}

BiasVerdict BiasTest::verdict(double threshold) const {
  if (is_heavy_tailed) return BiasVerdict::kUndecided;
  // Written so that a NaN fails.
  return worst() <= threshold ? BiasVerdict::kPasses : BiasVerdict::kFails;
}

double effective_pixels(const PixelEstimates& estimates) {
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i + 2 < estimates.variance.size(); i += 3) {
    const double variance =
        double{estimates.variance[i]} + estimates.variance[i + 1] + estimates.variance[i + 2];
    sum += variance;
    squares += variance * variance;
  }
  return squares > 0 ? sum / squares * sum : 0;
}

BiasTest test_bias(const PixelEstimates& estimates, const PixelEstimates& reference) {
  BiasTest test;
  test.blocks_across = std::max(1, reference.width / BiasTest::kBlock);
  test.blocks_down = std::max(1, reference.height / BiasTest::kBlock);
  const bool knows_samples = estimates.knows_samples && reference.knows_samples;
  std::array<Sums, 3> whole;
  std::vector<Sums> blocks(std::size_t{3} * test.blocks_across * test.blocks_down);
  for (std::size_t pixel = 0; pixel < reference.pixel_count(); ++pixel) {
    if (estimates.samples[pixel] == 0 || reference.samples[pixel] == 0) continue;
    const int column = static_cast<int>(pixel % reference.width) / BiasTest::kBlock;
    const int row = static_cast<int>(pixel / reference.width) / BiasTest::kBlock;
    const std::size_t block =
        static_cast<std::size_t>(std::min(row, test.blocks_down - 1)) * test.blocks_across +
        std::min(column, test.blocks_across - 1);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::size_t i = 3 * pixel + channel;
      const double difference = double{estimates.mean[i]} - reference.mean[i];
      const double picture = estimates.variance[i];
      const double theirs = reference.variance[i];
      for (Sums* sums : {&whole[channel], &blocks[3 * block + channel]}) {
        sums->difference += difference;
        sums->variance += picture + theirs;
        if (knows_samples) {
          const double ratio = double{estimates.samples[pixel]} / reference.samples[pixel];
          sums->picture_variance += picture * (1 + ratio);
          sums->reference_variance += theirs * (1 + 1 / ratio);
        }
        sums->rounding += kRounding * std::abs(double{reference.mean[i]});
      }
    }
  }
  // Pictures whose samples have few bright and rare ones among them lie within a factor of two of
  // each other, those of weights without bound below a hundredth.
  constexpr double kFewPixels = 0.05;
  const double usual = effective_pixels(reference);
  const double own = effective_pixels(estimates);
  // Of an infinite variance it is no number.
  test.is_heavy_tailed = !std::isfinite(own) || (own > 0 && own < kFewPixels * usual);
  for (std::size_t channel = 0; channel < 3; ++channel) test.z[channel] = whole[channel].z();
  for (const Sums& sums : blocks) test.block_z.push_back(static_cast<float>(sums.z()));
  return test;
}

}  // namespace freepath
