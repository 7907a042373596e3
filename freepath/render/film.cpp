#include "freepath/render/film.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "freepath/base/error.h"

namespace freepath {

namespace {

bool all_finite(const PathSample& sample) {
  return is_finite(sample.radiance) && is_finite(sample.albedo) && std::isfinite(sample.alpha) &&
         std::isfinite(sample.depth) && std::isfinite(sample.depth_weight) &&
         std::isfinite(sample.lookups);
}

/// A sum of finite floats may still be too large for a float.
float to_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

/// Variance of the mean of `samples` values.
double variance_of_mean(double sum, double sum_of_squares, double samples) {
  const double mean = sum / samples;
  const double mean_square = sum_of_squares / samples;
  if (samples < 2) return mean_square;
  return std::max(0.0, mean_square - mean * mean) / (samples - 1);
}

}  // namespace

Film::Film(int width, int height) : width_(width), height_(height) {
  if (width < 1 || height < 1) {
    fail("the film has {}x{} pixels; it needs at least 1x1", width, height);
  }
  pixels_.resize(static_cast<std::size_t>(width) * height);
}

void Film::add(std::size_t pixel, const PathSample& sample) {
  Pixel& sums = pixels_[pixel];
  if (!all_finite(sample)) {
    ++sums.non_finite;
    return;
  }
  for (int channel = 0; channel < kChannels; ++channel) {
    const double value = sample.radiance[channel];
    sums.radiance[channel] += value;
    sums.squares[channel] += value * value;
    sums.albedo[channel] += sample.albedo[channel];
  }
  sums.alpha += sample.alpha;
  sums.depth += static_cast<double>(sample.depth) * sample.depth_weight;
  sums.depth_weight += sample.depth_weight;
  sums.lookups += sample.lookups;
  ++sums.samples;
}

Film::SampleCounts Film::sample_counts() const {
  SampleCounts counts{pixels_[0].samples, 0, 0};
  for (const Pixel& pixel : pixels_) {
    counts.fewest = std::min(counts.fewest, pixel.samples);
    counts.most = std::max(counts.most, pixel.samples);
    if (pixel.samples == 0) ++counts.pixels_without;
  }
  return counts;
}

Film::NonFinite Film::non_finite_samples() const {
  NonFinite result;
  for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
    if (pixels_[pixel].non_finite == 0) continue;
    if (result.samples == 0) result.first_pixel = pixel;
    result.samples += pixels_[pixel].non_finite;
  }
  return result;
}

Image Film::to_image() const {
  Image image;
  image.width = width_;
  image.height = height_;
  image.channels = {"R",        "G",       "B",       "A",          "albedo.R",   "albedo.G",
                    "albedo.B", "depth.Z", "lookups", "variance.R", "variance.G", "variance.B"};
  image.values.reserve(pixels_.size() * image.channels.size());
  for (const Pixel& sums : pixels_) {
    const double n = std::max(1U, sums.samples);
    const auto put = [&](double value) { image.values.push_back(to_float(value)); };
    for (const double radiance : sums.radiance) put(radiance / n);
    put(sums.alpha / n);
    for (const double albedo : sums.albedo) put(albedo / n);
    put(sums.depth_weight != 0 ? sums.depth / sums.depth_weight : 0);
    put(sums.lookups / n);
    for (int channel = 0; channel < kChannels; ++channel) {
      put(variance_of_mean(sums.radiance[channel], sums.squares[channel], n));
    }
  }
  return image;
}

}  // namespace freepath
