#include "freepath/sensors/film.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "freepath/base/error.h"
#include "freepath/base/moments.h"

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

void add_to(double* sums, const Spectrum& value) {
  for (int channel = 0; channel < kChannels; ++channel) sums[channel] += value[channel];
}

}  // namespace

Film::SumPlaces Film::places_of(LayerSet layers, int& count) {
  SumPlaces places;
  places.fill(-1);
  count = 0;
  const auto place = [&](Sum sum, bool wanted) {
    if (!wanted) return;
    places[sum] = count;
    count += kChannels;
  };
  const bool light = layers.has_any(kLightLayers);
  place(kNormal, layers.has(Layer::kNormal));
  place(kPosition, layers.has(Layer::kPosition));
  place(kTransmittance, layers.has(Layer::kTransmittance));
  place(kBackground, light);
  place(kUnscattered, light);
  place(kAtMostOnce, light);
  place(kEven, layers.has(Layer::kHalves));
  return places;
}

std::size_t Film::bytes_per_pixel(LayerSet layers, const WavelengthBuckets& buckets) {
  int sums = 0;
  places_of(layers, sums);
  return sizeof(Pixel) + sums * sizeof(double) + buckets.count * sizeof(BucketSum);
}

Film::Film(const PixelWindow& window, LayerSet layers, const WavelengthBuckets& buckets)
    : window_(window), layers_(layers), buckets_(buckets) {
  if (window.width < 1 || window.height < 1) {
    fail("the film has {}x{} pixels; it needs at least 1x1", window.width, window.height);
  }
  pixels_.resize(static_cast<std::size_t>(window.width) * window.height);
  places_ = places_of(layers, sums_per_pixel_);
  sums_.resize(pixels_.size() * sums_per_pixel_);
  bucket_sums_.resize(pixels_.size() * buckets.count);
}

void Film::add(std::size_t pixel, const PathSample& sample, const LayerSample& layer_sample) {
  Pixel& sums = pixels_[pixel];
  if (!all_finite(sample)) {
    ++sums.non_finite;
    return;
  }
  if (places_[kEven] >= 0 && sums.samples % 2 == 0) add_to(sums_of(pixel, kEven), sample.radiance);
  if (layers_.has_any(kPathLayers)) add_layers(pixel, layer_sample);
  for (int channel = 0; channel < kChannels; ++channel) {
    const double value = sample.radiance[channel];
    sums.radiance[channel] += value;
    sums.squares[channel] += value * value;
    sums.albedo[channel] += sample.albedo[channel];
    if (sample.overflowed) sums.squares[channel] = std::numeric_limits<double>::infinity();
  }
  sums.alpha += sample.alpha;
  sums.depth += static_cast<double>(sample.depth) * sample.depth_weight;
  sums.depth_weight += sample.depth_weight;
  sums.lookups += sample.lookups;
  ++sums.samples;
}

void Film::add_layers(std::size_t pixel, const LayerSample& sample) {
  const auto add = [&](Sum which, const Spectrum& value) {
    if (places_[which] >= 0) add_to(sums_of(pixel, which), value);
  };
  add(kNormal, sample.normal);
  add(kPosition, sample.position);
  add(kTransmittance, sample.transmittance);
  add(kBackground, sample.background);
  add(kUnscattered, sample.unscattered);
  add(kAtMostOnce, sample.at_most_once);
}

void Film::add_spectrum(std::size_t pixel, std::span<const double> wavelengths,
                        const Channels& radiance) {
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    const int bucket = buckets_.bucket_of(wavelengths[i]);
    if (bucket < 0) continue;
    BucketSum& sum = bucket_sums_[pixel * buckets_.count + bucket];
    sum.radiance += radiance[static_cast<int>(i)];
    sum.samples += 1;
  }
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

void Film::put_layer(Layer layer, std::size_t pixel, std::vector<float>& values) const {
  const Pixel& sums = pixels_[pixel];
  const double n = std::max(1U, sums.samples);
  const auto put = [&](double value) { values.push_back(to_float(value)); };
  const auto put_sum = [&](Sum which, double count) {
    for (int c = 0; c < kChannels; ++c) put(count != 0 ? sums_of(pixel, which)[c] / count : 0);
  };
  const auto put_difference = [&](const double* all, Sum part) {
    for (int c = 0; c < kChannels; ++c) put((all[c] - sums_of(pixel, part)[c]) / n);
  };
  switch (layer) {
    case Layer::kAlbedo:
      for (const double albedo : sums.albedo) put(albedo / n);
      return;
    case Layer::kDepth:
      return put(sums.depth_weight != 0 ? sums.depth / sums.depth_weight : 0);
    case Layer::kLookups:
      return put(sums.lookups / n);
    case Layer::kVariance:
      for (int c = 0; c < kChannels; ++c) {
        // As a float it may be infinite, and then says so.
        const Moments moments{sums.radiance[c], sums.squares[c]};
        values.push_back(static_cast<float>(moments.variance(std::max(sums.samples, 1U)) / n));
      }
      return;
    case Layer::kSamples:
      return put(sums.samples);
    case Layer::kNormal:
      return put_sum(kNormal, n);
    case Layer::kPosition:
      return put_sum(kPosition, sums.depth_weight);
    case Layer::kTransmittance:
      return put_sum(kTransmittance, n);
    case Layer::kBackground:
      return put_sum(kBackground, n);
    case Layer::kEmission:
      return put_difference(sums_of(pixel, kUnscattered), kBackground);
    case Layer::kDirect:
      return put_difference(sums_of(pixel, kAtMostOnce), kUnscattered);
    case Layer::kIndirect:
      return put_difference(sums.radiance, kAtMostOnce);
    case Layer::kHalves: {
      const uint32_t odd = sums.samples / 2;
      put_sum(kEven, sums.samples - odd);
      for (int c = 0; c < kChannels; ++c) {
        put(odd > 0 ? (sums.radiance[c] - sums_of(pixel, kEven)[c]) / odd : 0);
      }
      return;
    }
  }
}

Image Film::to_image(LayerSet layers) const {
  Image image;
  image.width = window_.width;
  image.height = window_.height;
  image.x = window_.x;
  image.y = window_.y;
  image.full_width = window_.full_width;
  image.full_height = window_.full_height;
  image.chromaticities = chromaticities_;
  image.channels = {"R", "G", "B", "A"};
  std::vector<Layer> chosen;
  for (const LayerInfo& info : layer_infos()) {
    if (!layers.has(info.layer) || !layers_.has(info.layer)) continue;
    chosen.push_back(info.layer);
    image.channels.insert(image.channels.end(), info.channels.begin(), info.channels.end());
  }
  for (int i = 0; i < buckets_.count; ++i) image.channels.push_back(buckets_.channel(i));
  image.values.reserve(pixels_.size() * image.channels.size());
  for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
    const Pixel& sums = pixels_[pixel];
    const double n = std::max(1U, sums.samples);
    for (const double radiance : sums.radiance) image.values.push_back(to_float(radiance / n));
    image.values.push_back(to_float(sums.alpha / n));
    for (const Layer layer : chosen) put_layer(layer, pixel, image.values);
    for (int i = 0; i < buckets_.count; ++i) {
      const BucketSum& sum = bucket_sums_[pixel * buckets_.count + i];
      image.values.push_back(sum.samples > 0 ? to_float(sum.radiance / sum.samples) : 0.0F);
    }
  }
  return image;
}

}  // namespace freepath
