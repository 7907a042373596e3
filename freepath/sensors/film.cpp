#include "freepath/sensors/film.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/moments.h"

namespace freepath {

namespace {

bool all_finite(const PathSample& sample) {
  const auto zero_if_finite = [](float value) { return value - value; };
  float sum = zero_if_finite(sample.alpha) + zero_if_finite(sample.depth) +
              zero_if_finite(sample.depth_weight) + zero_if_finite(sample.lookups);
  for (int channel = 0; channel < kChannels; ++channel) {
    sum += zero_if_finite(sample.radiance[channel]) + zero_if_finite(sample.albedo[channel]);
  }
  return sum == 0;
}

/// A sum of finite floats may still be too large for a float.
float to_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

/// A sum that layers are made of.
struct LayerSum {
  LayerSet layers;            ///< Any of these needs it.
  Rgb LayerSample::*of_path;  ///< What paths add; null: nothing that they find for layers alone.
};
/// In the order of Film::Sum.
constexpr LayerSum kLayerSums[] = {{{Layer::kNormal}, &LayerSample::normal},
                                   {{Layer::kPosition}, &LayerSample::position},
                                   {{Layer::kTransmittance}, &LayerSample::transmittance},
                                   {kLightLayers, &LayerSample::background},
                                   {kLightLayers, &LayerSample::unscattered},
                                   {kLightLayers, &LayerSample::at_most_once},
                                   {{Layer::kHalves}, nullptr}};

}  // namespace

LayerSample& LayerSample::operator+=(const LayerSample& other) {
  for (const LayerSum& sum : kLayerSums) {
    if (sum.of_path != nullptr) this->*sum.of_path += other.*sum.of_path;
  }
  return *this;
}

Film::SumOffsets Film::offsets_of(LayerSet layers, int& count) {
  static_assert(std::size(kLayerSums) == kSums);
  SumOffsets offsets;
  offsets.fill(-1);
  count = 0;
  for (int sum = 0; sum < kSums; ++sum) {
    if (!layers.has_any(kLayerSums[sum].layers)) continue;
    offsets[sum] = count;
    count += kChannels;
  }
  return offsets;
}

std::size_t Film::bytes_per_pixel(LayerSet layers, const WavelengthBuckets& buckets) {
  int sums = 0;
  offsets_of(layers, sums);
  return sizeof(Pixel) + sums * (sizeof(Sum2::Array) + 1) + buckets.count * sizeof(BucketSum);
}

Film::Film(const PixelWindow& window, LayerSet layers, const WavelengthBuckets& buckets,
           uint32_t first_sample)
    : window_(window), layers_(layers), first_sample_(first_sample), buckets_(buckets) {
  if (window.width < 1 || window.height < 1) {
    fail("the film has {}x{} pixels; it needs at least 1x1", window.width, window.height);
  }
  pixels_.resize(static_cast<std::size_t>(window.width) * window.height, Pixel());
  offsets_ = offsets_of(layers, sums_per_pixel_);
  sums_.resize(pixels_.size() * sums_per_pixel_, Sum2::Array{});
  sum_tops_.resize(sums_.size(), Sum2::kEmpty);
  bucket_sums_.resize(pixels_.size() * buckets.count, BucketSum());
}

double Film::Pixel::square(int channel) const {
  if (overflows > 0) return std::numeric_limits<double>::infinity();
  return Sum3::value(squares[channel], square_tops[channel]);
}

void Film::add_to(std::size_t pixel, Sum which, const Rgb& value) {
  if (offsets_[which] < 0) return;
  const std::size_t first = pixel * sums_per_pixel_ + offsets_[which];
  for (int channel = 0; channel < kChannels; ++channel) {
    Sum2::add(sums_[first + channel], sum_tops_[first + channel], value[channel]);
  }
}

double Film::sum_of(std::size_t pixel, Sum which, int channel) const {
  const std::size_t index = pixel * sums_per_pixel_ + offsets_[which] + channel;
  return Sum2::value(sums_[index], sum_tops_[index]);
}

namespace {

/// Samples that are added together.
constexpr std::size_t kSamplesAtOnce = 32;

}  // namespace

void Film::add(std::size_t pixel, std::span<const PathSample> samples,
               std::span<const LayerSample> layer_samples) {
  for (std::size_t i = 0; i < samples.size(); i += kSamplesAtOnce) {
    const std::size_t count = std::min(samples.size() - i, kSamplesAtOnce);
    add_some(pixel, samples.subspan(i, count),
             layer_samples.empty() ? layer_samples : layer_samples.subspan(i, count));
  }
}

void Film::add_some(std::size_t pixel, std::span<const PathSample> samples,
                    std::span<const LayerSample> layer_samples) {
  Pixel& sums = pixels_[pixel];
  std::array<std::array<double, kSamplesAtOnce>, kPixelSums> values;
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PathSample& sample = samples[i];
    if (!all_finite(sample)) {
      ++sums.non_finite;
      continue;
    }
    const bool is_even = (first_sample(pixel) + sums.samples) % 2 == 0;
    if (is_even) {
      add_to(pixel, kEven, sample.radiance);
      ++sums.even_samples;
    }
    if (layers_.has_any(kPathLayers)) add_layers(pixel, layer_samples[i]);
    for (int channel = 0; channel < kChannels; ++channel) {
      values[kRadiance + channel][count] = sample.radiance[channel];
      values[kAlbedo + channel][count] = sample.albedo[channel];
    }
    values[kAlpha][count] = sample.alpha;
    values[kDepth][count] = static_cast<double>(sample.depth) * sample.depth_weight;
    values[kDepthWeight][count] = sample.depth_weight;
    ++count;
    sums.lookups += static_cast<uint64_t>(sample.lookups);
    if (sample.overflowed) ++sums.overflows;
    ++sums.samples;
  }
  for (int sum = 0; sum < kPixelSums; ++sum) {
    Sum2::add_all(sums.sums[sum], sums.tops[sum], std::span(values[sum]).first(count));
  }
  for (int channel = 0; channel < kChannels; ++channel) {
    const std::span<double> squares = std::span(values[kRadiance + channel]).first(count);
    for (double& value : squares) value *= value;
    Sum3::add_all(sums.squares[channel], sums.square_tops[channel], squares);
  }
}

void Film::add_layers(std::size_t pixel, const LayerSample& sample) {
  for (int sum = 0; sum < kSums; ++sum) {
    Rgb LayerSample::*const found = kLayerSums[sum].of_path;
    if (found != nullptr) add_to(pixel, static_cast<Sum>(sum), sample.*found);
  }
}

void Film::add_spectrum(std::size_t pixel, std::span<const double> wavelengths,
                        const SampledSpectrum& radiance) {
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    const int bucket = buckets_.bucket_of(wavelengths[i]);
    if (bucket < 0) continue;
    BucketSum& sum = bucket_sums_[pixel * buckets_.count + bucket];
    Sum2::add(sum.radiance, sum.top, radiance[static_cast<int>(i)]);
    ++sum.samples;
  }
}

void Film::merge_pixel(std::size_t pixel, const Film& other, std::size_t other_pixel) {
  Pixel& sums = pixels_[pixel];
  const Pixel& more = other.pixels_[other_pixel];
  if (sums.samples == 0) sums.share = more.share;
  sums.rounds += more.rounds;
  for (int i = 0; i < kPixelSums; ++i) {
    Sum2::merge(sums.sums[i], sums.tops[i], more.sums[i], more.tops[i]);
  }
  for (int i = 0; i < kChannels; ++i) {
    Sum3::merge(sums.squares[i], sums.square_tops[i], more.squares[i], more.square_tops[i]);
  }
  sums.lookups += more.lookups;
  sums.samples += more.samples;
  sums.even_samples += more.even_samples;
  sums.non_finite += more.non_finite;
  sums.overflows += more.overflows;
  const std::size_t first = pixel * sums_per_pixel_;
  const std::size_t other_first = other_pixel * sums_per_pixel_;
  for (int i = 0; i < sums_per_pixel_; ++i) {
    Sum2::merge(sums_[first + i], sum_tops_[first + i], other.sums_[other_first + i],
                other.sum_tops_[other_first + i]);
  }
  for (int i = 0; i < buckets_.count; ++i) {
    BucketSum& bucket = bucket_sums_[pixel * buckets_.count + i];
    const BucketSum& added = other.bucket_sums_[other_pixel * buckets_.count + i];
    Sum2::merge(bucket.radiance, bucket.top, added.radiance, added.top);
    bucket.samples += added.samples;
  }
}

Film::SampleCounts Film::sample_counts() const {
  SampleCounts counts{.fewest = rounds(0)};
  for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
    counts.fewest = std::min(counts.fewest, rounds(pixel));
    counts.most = std::max(counts.most, rounds(pixel));
    if (pixels_[pixel].samples > 0) continue;
    ++(rounds(pixel) > 0 ? counts.pixels_between : counts.pixels_without);
  }
  return counts;
}

bool Film::has_shares() const {
  return std::any_of(pixels_.begin(), pixels_.end(),
                     [](const Pixel& pixel) { return !SampleShare(pixel.share).is_one(); });
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

double Film::mean(std::size_t pixel, int channel) const {
  const Pixel& sums = pixels_[pixel];
  return sums.value(kRadiance + channel) / std::max(1U, sums.samples);
}

double Film::variance(std::size_t pixel, int channel) const {
  const Pixel& sums = pixels_[pixel];
  const uint32_t n = std::max(1U, sums.samples);
  return Moments{sums.value(kRadiance + channel), sums.square(channel)}.variance(n) / n;
}

void Film::put_layer(Layer layer, std::size_t pixel, std::vector<float>& values) const {
  const Pixel& sums = pixels_[pixel];
  const double n = std::max(1U, sums.samples);
  const auto put = [&](double value) { values.push_back(to_float(value)); };
  const auto put_each = [&](const auto& value_of) {
    for (int c = 0; c < kChannels; ++c) put(value_of(c));
  };
  const auto put_sum = [&](Sum which, double count) {
    put_each([&](int c) { return count != 0 ? sum_of(pixel, which, c) / count : 0; });
  };
  const auto put_difference = [&](Sum all, Sum part) {
    put_each([&](int c) { return (sum_of(pixel, all, c) - sum_of(pixel, part, c)) / n; });
  };
  switch (layer) {
    case Layer::kAlbedo:
      return put_each([&](int c) { return sums.value(kAlbedo + c) / n; });
    case Layer::kDepth: {
      const double weight = sums.value(kDepthWeight);
      return put(weight != 0 ? sums.value(kDepth) / weight : 0);
    }
    case Layer::kLookups:
      return put(mean_lookups(pixel));
    case Layer::kVariance:
      // As a float it may be infinite, and then says so.
      for (int c = 0; c < kChannels; ++c) values.push_back(static_cast<float>(variance(pixel, c)));
      return;
    case Layer::kSamples:
      return put(sums.samples);
    case Layer::kNormal:
      return put_sum(kNormal, n);
    case Layer::kPosition:
      return put_sum(kPosition, sums.value(kDepthWeight));
    case Layer::kTransmittance:
      return put_sum(kTransmittance, n);
    case Layer::kBackground:
      return put_sum(kBackground, n);
    case Layer::kEmission:
      return put_difference(kUnscattered, kBackground);
    case Layer::kDirect:
      return put_difference(kAtMostOnce, kUnscattered);
    case Layer::kIndirect:
      return put_each(
          [&](int c) { return (sums.value(kRadiance + c) - sum_of(pixel, kAtMostOnce, c)) / n; });
    case Layer::kHalves: {
      const uint32_t odd = sums.samples - sums.even_samples;
      put_sum(kEven, sums.even_samples);
      return put_each([&](int c) {
        return odd > 0 ? (sums.value(kRadiance + c) - sum_of(pixel, kEven, c)) / odd : 0;
      });
    }
  }
}

template <class Self, class Bytes>
std::vector<Bytes> Film::blocks_of(Self& film) {
  const auto bytes = [](auto& values) {
    const std::span all(values);
    if constexpr (std::is_const_v<typename Bytes::element_type>) {
      return std::as_bytes(all);
    } else {
      return std::as_writable_bytes(all);
    }
  };
  return {bytes(film.pixels_), bytes(film.sums_), bytes(film.sum_tops_), bytes(film.bucket_sums_)};
}

std::vector<std::span<std::byte>> Film::sums_in_memory() {
  return blocks_of<Film, std::span<std::byte>>(*this);
}

std::vector<std::span<const std::byte>> Film::sums_in_memory() const {
  return blocks_of<const Film, std::span<const std::byte>>(*this);
}

void Film::check_sums() const {
  const auto check = [](int8_t top) {
    if (top < Sum2::kLowest || top > Sum2::kHighest) fail("its sums are damaged");
  };
  for (const Pixel& pixel : pixels_) {
    if (pixel.share >= SampleShare::kSteps) fail("its shares of samples are damaged");
    for (const int8_t top : pixel.tops) check(top);
    for (const int8_t top : pixel.square_tops) check(top);
  }
  for (const int8_t top : sum_tops_) check(top);
  for (const BucketSum& bucket : bucket_sums_) check(bucket.top);
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
  layers = layers.common(layers_);
  for (std::string& channel : channels_of(layers)) image.channels.push_back(std::move(channel));
  for (int i = 0; i < buckets_.count; ++i) image.channels.push_back(buckets_.channel(i));
  image.values.reserve(pixels_.size() * image.channels.size());
  for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
    const Pixel& sums = pixels_[pixel];
    const double n = std::max(1U, sums.samples);
    for (int c = 0; c < kChannels; ++c) image.values.push_back(to_float(mean(pixel, c)));
    image.values.push_back(to_float(sums.value(kAlpha) / n));
    for (const LayerInfo& info : layer_infos()) {
      if (layers.has(info.layer)) put_layer(info.layer, pixel, image.values);
    }
    for (int i = 0; i < buckets_.count; ++i) {
      const BucketSum& sum = bucket_sums_[pixel * buckets_.count + i];
      const double radiance = Sum2::value(sum.radiance, sum.top);
      image.values.push_back(sum.samples > 0 ? to_float(radiance / sum.samples) : 0.0F);
    }
  }
  return image;
}

}  // namespace freepath
