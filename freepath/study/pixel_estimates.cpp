#include "freepath/study/pixel_estimates.h"

#include <array>
#include <cmath>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr std::array kColours = {"R", "G", "B"};

/// Where three channels of a prefix stand; nothing if one is missing.
std::optional<std::array<int, 3>> channels_of(const Image& image, const std::string& prefix) {
  std::array<int, 3> channels{};
  for (int channel = 0; channel < 3; ++channel) {
    const auto found = find_channel(image, prefix + kColours[channel]);
    if (!found) return {};
    channels[channel] = *found;
  }
  return channels;
}

std::vector<float> copy_channels(const Image& image, const std::array<int, 3>& channels) {
  std::vector<float> values;
  values.reserve(3 * image.pixel_count());
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    for (const int channel : channels) {
      values.push_back(image.values[pixel * image.channels.size() + channel]);
    }
  }
  return values;
}

std::vector<float> copy_channel(const Image& image, const char* name) {
  std::vector<float> values;
  const auto found = find_channel(image, name);
  if (!found) return values;
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    values.push_back(image.values[pixel * image.channels.size() + *found]);
  }
  return values;
}

void check_finite(const std::vector<float>& values, int width, const std::string& name) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    const std::size_t pixel = i / 3;
    fail("{}: pixel ({}, {}) is not finite", name, pixel % width, pixel / width);
  }
}

}  // namespace

PixelEstimates estimates_of(const Image& image, const std::string& name, bool& variance_known) {
  PixelEstimates estimates{.width = image.width, .height = image.height};
  estimates.chromaticities = image.chromaticities;
  estimates.mean = copy_channels(image, colour_channels(image, name));
  check_finite(estimates.mean, image.width, name);
  const auto variances = channels_of(image, "variance.");
  const auto even = channels_of(image, "A.");
  const auto odd = channels_of(image, "B.");
  variance_known = variances || (even && odd);
  if (variances) {
    estimates.variance = copy_channels(image, *variances);
  } else if (variance_known) {
    // Halves a and b, independent, make the mean (a + b)/2, whose variance is E[(a - b)²]/4.
    const std::vector<float> a = copy_channels(image, *even);
    const std::vector<float> b = copy_channels(image, *odd);
    for (std::size_t i = 0; i < a.size(); ++i) {
      estimates.variance.push_back(0.25F * (a[i] - b[i]) * (a[i] - b[i]));
    }
  } else {
    estimates.variance.assign(estimates.mean.size(), 0.0F);
  }
  for (std::size_t i = 0; i < estimates.variance.size(); ++i) {
    if (estimates.variance[i] >= 0) continue;  // or infinite
    fail("{}: the variance of pixel ({}, {}) is negative or no number", name, i / 3 % image.width,
         i / 3 / image.width);
  }
  estimates.samples = copy_channel(image, "samples");
  estimates.knows_samples = !estimates.samples.empty();
  if (!estimates.knows_samples) estimates.samples.assign(image.pixel_count(), 1.0F);
  estimates.lookups = copy_channel(image, "lookups");
  return estimates;
}

PixelEstimates estimates_of(const Film& film) {
  bool known = false;
  return estimates_of(film.to_image({Layer::kVariance, Layer::kSamples, Layer::kLookups}),
                      "the picture", known);
}

std::vector<float> colours_of(const Film& film) {
  const Image image = film.to_image(LayerSet{});
  return copy_channels(image, colour_channels(image, "the picture"));
}

Image to_image(const PixelEstimates& estimates) {
  Image image{.width = estimates.width, .height = estimates.height};
  image.chromaticities = estimates.chromaticities;
  image.channels = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"};
  for (std::size_t pixel = 0; pixel < estimates.pixel_count(); ++pixel) {
    const auto begin = static_cast<std::ptrdiff_t>(3 * pixel);
    image.values.insert(image.values.end(), estimates.mean.begin() + begin,
                        estimates.mean.begin() + begin + 3);
    image.values.insert(image.values.end(), estimates.variance.begin() + begin,
                        estimates.variance.begin() + begin + 3);
    image.values.push_back(estimates.samples[pixel]);
  }
  return image;
}

PixelEstimates merged(const std::vector<const PixelEstimates*>& parts) {
  PixelEstimates sum = *parts.front();
  for (std::size_t pixel = 0; pixel < sum.pixel_count(); ++pixel) {
    double samples = 0;
    for (const PixelEstimates* part : parts) samples += part->samples[pixel];
    sum.samples[pixel] = static_cast<float>(samples);
    const auto weighted = [&](const std::vector<float> PixelEstimates::*values, std::size_t index,
                              bool squared) {
      double total = 0;
      for (const PixelEstimates* part : parts) {
        const double weight = samples > 0 ? part->samples[pixel] / samples : 0;
        total += weight * (squared ? weight : 1) * (part->*values)[index];
      }
      return static_cast<float>(total);
    };
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      sum.mean[i] = weighted(&PixelEstimates::mean, i, false);
      sum.variance[i] = weighted(&PixelEstimates::variance, i, true);
    }
    if (!sum.lookups.empty()) sum.lookups[pixel] = weighted(&PixelEstimates::lookups, pixel, false);
  }
  return sum;
}

}  // namespace freepath
