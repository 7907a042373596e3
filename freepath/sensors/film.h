#pragma once
/// @file The film: what the paths of each pixel add up to.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/binned_sum.h"
#include "freepath/base/page_allocator.h"
#include "freepath/base/rgb.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/io/image.h"
#include "freepath/sensors/layers.h"
#include "freepath/sensors/pixel_window.h"
#include "freepath/sensors/sample_share.h"
#include "freepath/sensors/wavelength_buckets.h"

namespace freepath {

/// What one path found.
struct PathSample {
  Rgb radiance{0.0F};      ///< Estimate of the radiance that reaches the film.
  float alpha = 0;         ///< Estimate of 1 - transmittance along the camera ray.
  Rgb albedo{0.0F};        ///< Albedo at the first scatter; 0 if there was none.
  float depth = 0;         ///< Distance to the first scatter [world].
  float depth_weight = 0;  ///< 1 if there was a first scatter, else 0 (or its weight).
  float lookups = 0;       ///< Look-ups of fields along the path.
  /// Whether its weight left the range of float: what it found is not known, and 0 here.
  bool overflowed = false;
};

/// What one path found for layers that few ask for (kPathLayers).
struct LayerSample {
  Rgb normal{0.0F};         ///< Times depth_weight.
  Rgb position{0.0F};       ///< Times depth_weight [world].
  Rgb transmittance{0.0F};  ///< 0 of a path that ended in a medium.
  // Parts of the radiance, each with the one before.
  Rgb background{0.0F};    ///< Light from outside, not scattered.
  Rgb unscattered{0.0F};   ///< Light from anywhere, not scattered.
  Rgb at_most_once{0.0F};  ///< Scattered at most once.

  /// Adds what another channel's path of the same sample has found.
  LayerSample& operator+=(const LayerSample& other);
};

/// Samples of pixels, by their numbers: [first, first + count); of rounds, where pixels take
/// shares.
struct SampleRange {
  uint32_t first = 0;
  uint32_t count = 0;

  uint32_t end() const { return first + count; }
  bool operator==(const SampleRange&) const = default;
};

/// Sums over the paths of each pixel.
///
/// Sums don't depend on the order in which samples come, nor on how they are shared out among films
/// that are merged (BinnedSum). A pixel's samples are numbered from its first one on, as they are
/// added, by one thread at a time; different pixels may be added to at the same time.
///
/// Pixels may take different shares of the samples (SampleShare). What counts then are rounds: of a
/// pixel whose share is 1, as it is of all at first, they are its samples.
class Film {
 public:
  /// @param first_sample number of the first round of samples of each pixel
  /// @throws Error for an empty film
  explicit Film(const PixelWindow& window, LayerSet layers = LayerSet::standard(),
                const WavelengthBuckets& buckets = {}, uint32_t first_sample = 0);
  Film(int width, int height) : Film(PixelWindow::whole(width, height)) {}

  int width() const { return window_.width; }
  int height() const { return window_.height; }
  std::size_t pixel_count() const { return pixels_.size(); }
  const PixelWindow& window() const { return window_; }
  /// What it records, which takes memory.
  LayerSet layers() const { return layers_; }
  const WavelengthBuckets& buckets() const { return buckets_; }
  /// Number of the first round.
  uint32_t first_sample() const { return first_sample_; }
  /// Number of the first sample of a pixel.
  uint32_t first_sample(std::size_t pixel) const { return share(pixel).samples(first_sample_); }
  SampleShare share(std::size_t pixel) const { return SampleShare(pixels_[pixel].share); }
  /// Whether the share of any pixel is not 1.
  bool has_shares() const;
  /// Sets the share of a pixel that has no samples yet.
  void set_share(std::size_t pixel, SampleShare share) { pixels_[pixel].share = share.step(); }
  /// Rounds of a pixel whose samples were all added.
  uint32_t rounds(std::size_t pixel) const {
    return share(pixel).is_one() ? pixels_[pixel].samples : pixels_[pixel].rounds;
  }
  /// Tells that the samples of so many more rounds of a pixel were added.
  void end_rounds(std::size_t pixel, uint32_t rounds) { pixels_[pixel].rounds += rounds; }
  static std::size_t bytes_per_pixel(LayerSet layers, const WavelengthBuckets& buckets = {});

  /// Sets the primaries of the space of R, G and B; sRGB's where none are set. Its pictures carry
  /// them.
  void set_chromaticities(const std::optional<RgbChromaticities>& chromaticities) {
    chromaticities_ = chromaticities;
  }
  const std::optional<RgbChromaticities>& chromaticities() const { return chromaticities_; }

  /// Adds the next sample of a pixel.
  ///
  /// A sample that overflowed makes the variance of its pixel infinite.
  /// A sample with a NaN or infinite part is counted, not added: whoever adds samples reports it
  /// as an internal error (non_finite_samples).
  /// @param pixel row · width + column
  /// @param layer_sample looked at only where one of kPathLayers is recorded; has to be finite
  void add(std::size_t pixel, const PathSample& sample, const LayerSample& layer_sample = {}) {
    add(pixel, std::span(&sample, 1), std::span(&layer_sample, 1));
  }
  /// Adds the next samples of a pixel.
  /// @param layer_samples as many, or none where no kPathLayers are recorded
  void add(std::size_t pixel, std::span<const PathSample> samples,
           std::span<const LayerSample> layer_samples);

  /// Adds a sample's spectral radiance to the buckets of its wavelengths.
  /// @param wavelengths [nm], those of the first channels of the radiance
  /// @param radiance finite
  void add_spectrum(std::size_t pixel, std::span<const double> wavelengths,
                    const SampledSpectrum& radiance);

  /// Adds the samples of a pixel of another film, which are other ones than its own. It takes that
  /// one's share where it has no samples yet; where the shares differ, its rounds mean nothing
  /// after.
  /// @param other with the same layers and buckets
  void merge_pixel(std::size_t pixel, const Film& other, std::size_t other_pixel);

  /// Samples of a pixel that were added.
  uint32_t samples(std::size_t pixel) const { return pixels_[pixel].samples; }
  /// How many rounds of samples the pixels have.
  struct SampleCounts {
    uint32_t fewest = 0;
    uint32_t most = 0;
    std::size_t pixels_without = 0;  ///< Pixels that have none.
    /// Pixels whose share of their rounds comes to no sample.
    std::size_t pixels_between = 0;
  };
  SampleCounts sample_counts() const;
  /// Samples that were not finite, and the first pixel that had one.
  struct NonFinite {
    uint64_t samples = 0;
    std::size_t first_pixel = 0;
  };
  NonFinite non_finite_samples() const;

  /// The variance of the mean of a pixel's channel, as to_image() has it.
  double variance(std::size_t pixel, int channel) const;
  /// The mean of a pixel's channel.
  double mean(std::size_t pixel, int channel) const;
  /// The mean number of look-ups of a pixel's samples.
  double mean_lookups(std::size_t pixel) const {
    return static_cast<double>(pixels_[pixel].lookups) / std::max(1U, pixels_[pixel].samples);
  }

  /// The picture: R, G, B, A and the layers (layer_infos()).
  ///
  /// A is 1 - transmittance. depth.Z is the mean distance to the first scatter, 0 where no path
  /// scattered. lookups is their mean number for a path. variance is that of the mean,
  /// (E[x²] - E[x]²) / (n - 1), infinite where it exceeds a float; of a single sample x² stands in,
  /// which is not below the variance on average. normal is the mean over all paths, 0 for those
  /// without a first event; position is one over first events. emission + background + direct +
  /// indirect is R, G, B, up to rounding. A and B are means over the samples of even and odd
  /// number. A pixel without samples is 0.
  ///
  /// After them come the buckets of wavelengths, if there are any: the mean over what came into
  /// each, 0 where nothing did.
  Image to_image() const { return to_image(layers_); }
  /// The picture with these layers alone, of those that it has.
  Image to_image(LayerSet layers) const;

  /// Blocks of memory that hold its sums, always the same ones in the same order for films of the
  /// same size, layers and buckets: to be written to a file, or to be read from one.
  std::vector<std::span<std::byte>> sums_in_memory();
  std::vector<std::span<const std::byte>> sums_in_memory() const;
  /// @throws Error where sums that were read can't be sums
  void check_sums() const;

 private:
  using Sum2 = BinnedSum<2>;
  /// Squares have twice as many digits as what they are of, and a variance is their difference.
  using Sum3 = BinnedSum<3>;

  /// Sums that every pixel has.
  enum PixelSum { kRadiance = 0, kAlbedo = 3, kAlpha = 6, kDepth, kDepthWeight, kPixelSums };

  struct Pixel {
    std::array<Sum2::Array, kPixelSums> sums = {};
    std::array<Sum3::Array, kChannels> squares = {};
    uint64_t lookups = 0;
    uint32_t samples = 0;
    uint32_t even_samples = 0;  // those of even number
    uint32_t non_finite = 0;
    uint32_t overflows = 0;
    uint32_t rounds : 28 = 0;  // where the share is not 1
    uint32_t share : 4 = SampleShare().step();
    std::array<int8_t, kPixelSums> tops = filled<kPixelSums>();
    std::array<int8_t, kChannels> square_tops = filled<kChannels>();

    double value(int sum) const { return Sum2::value(sums[sum], tops[sum]); }
    double square(int channel) const;
  };
  template <std::size_t kCount>
  static constexpr std::array<int8_t, kCount> filled() {
    std::array<int8_t, kCount> tops{};
    tops.fill(Sum2::kEmpty);
    return tops;
  }

  /// Sums of three channels each, in sums_ (kLayerSums).
  enum Sum { kNormal, kPosition, kTransmittance, kBackground, kUnscattered, kAtMostOnce, kEven };
  static constexpr int kSums = kEven + 1;
  /// Where a pixel has its sums; -1: nowhere.
  using SumOffsets = std::array<int, kSums>;
  static SumOffsets offsets_of(LayerSet layers, int& count);

  void add_some(std::size_t pixel, std::span<const PathSample> samples,
                std::span<const LayerSample> layer_samples);
  void add_layers(std::size_t pixel, const LayerSample& sample);
  void add_to(std::size_t pixel, Sum which, const Rgb& value);
  /// Value of a sum that the film has.
  double sum_of(std::size_t pixel, Sum which, int channel) const;
  void put_layer(Layer layer, std::size_t pixel, std::vector<float>& values) const;
  template <class Self, class Bytes>
  static std::vector<Bytes> blocks_of(Self& film);

  PixelWindow window_;
  std::optional<RgbChromaticities> chromaticities_;
  LayerSet layers_;
  uint32_t first_sample_ = 0;
  /// In huge pages: a pass goes through all pixels.
  template <class T>
  using Pixels = std::vector<T, PageAllocator<T>>;
  Pixels<Pixel> pixels_;
  int sums_per_pixel_ = 0;
  SumOffsets offsets_{};
  Pixels<Sum2::Array> sums_;
  Pixels<int8_t> sum_tops_;
  WavelengthBuckets buckets_;
  /// Sum of a bucket of a pixel.
  struct BucketSum {
    Sum2::Array radiance = {};
    uint32_t samples = 0;
    int8_t top = Sum2::kEmpty;
    std::array<int8_t, 3> unused = {};
  };
  Pixels<BucketSum> bucket_sums_;
};

}  // namespace freepath
