#pragma once
/// @file The film: what the paths of each pixel add up to.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/channels.h"
#include "freepath/base/spectrum.h"
#include "freepath/io/image.h"
#include "freepath/sensors/layers.h"
#include "freepath/sensors/pixel_window.h"
#include "freepath/sensors/wavelength_buckets.h"

namespace freepath {

/// What one path found.
struct PathSample {
  Spectrum radiance{0.0F};  ///< Estimate of the radiance that reaches the film.
  float alpha = 0;          ///< Estimate of 1 - transmittance along the camera ray.
  Spectrum albedo{0.0F};    ///< Albedo at the first scatter; 0 if there was none.
  float depth = 0;          ///< Distance to the first scatter [world].
  float depth_weight = 0;   ///< 1 if there was a first scatter, else 0 (or its weight).
  float lookups = 0;        ///< Look-ups of fields along the path.
  /// Whether its weight left the range of float: what it found is not known, and 0 here.
  bool overflowed = false;
};

/// What one path found for layers that few ask for (kPathLayers).
struct LayerSample {
  Spectrum normal{0.0F};         ///< Times depth_weight.
  Spectrum position{0.0F};       ///< Times depth_weight [world].
  Spectrum transmittance{0.0F};  ///< 0 of a path that ended in a medium.
  // Parts of the radiance, each with the one before.
  Spectrum background{0.0F};    ///< From outside, not scattered.
  Spectrum unscattered{0.0F};   ///< From wherever, not scattered.
  Spectrum at_most_once{0.0F};  ///< Scattered at most once.

  /// Adds what another channel's path of the same sample has found.
  LayerSample& operator+=(const LayerSample& other) {
    normal += other.normal;
    position += other.position;
    transmittance += other.transmittance;
    background += other.background;
    unscattered += other.unscattered;
    at_most_once += other.at_most_once;
    return *this;
  }
};

/// Sums over the paths of each pixel, in double precision.
///
/// A pixel's samples must be added in the order of their numbers, by one thread at a time;
/// different pixels may be added to at the same time. Then the picture does not depend on threads
/// or batches.
class Film {
 public:
  /// @throws Error for an empty film
  explicit Film(const PixelWindow& window, LayerSet layers = LayerSet::standard(),
                const WavelengthBuckets& buckets = {});
  Film(int width, int height) : Film(PixelWindow::whole(width, height)) {}

  int width() const { return window_.width; }
  int height() const { return window_.height; }
  const PixelWindow& window() const { return window_; }
  /// What it records, which takes memory.
  LayerSet layers() const { return layers_; }
  const WavelengthBuckets& buckets() const { return buckets_; }
  static std::size_t bytes_per_pixel(LayerSet layers, const WavelengthBuckets& buckets = {});

  /// Of the space of R, G and B; sRGB's where none are set. Its pictures carry them.
  void set_chromaticities(const std::optional<RgbChromaticities>& chromaticities) {
    chromaticities_ = chromaticities;
  }

  /// Adds the next sample of a pixel.
  ///
  /// A sample that overflowed makes the variance of its pixel infinite.
  /// A sample with a NaN or infinite part is counted, not added: whoever adds samples reports it
  /// as an internal error (non_finite_samples).
  /// @param pixel row · width + column
  /// @param layer_sample looked at only where one of kPathLayers is recorded; has to be finite
  void add(std::size_t pixel, const PathSample& sample, const LayerSample& layer_sample = {});

  /// Adds a sample's spectral radiance to the buckets of its wavelengths.
  /// @param wavelengths [nm], those of the first channels of the radiance
  /// @param radiance finite
  void add_spectrum(std::size_t pixel, std::span<const double> wavelengths,
                    const Channels& radiance);

  /// Samples of a pixel that were added.
  uint32_t samples(std::size_t pixel) const { return pixels_[pixel].samples; }
  /// How many samples the pixels have.
  struct SampleCounts {
    uint32_t fewest = 0;
    uint32_t most = 0;
    std::size_t pixels_without = 0;  ///< Pixels that have none.
  };
  SampleCounts sample_counts() const;
  /// Samples that were not finite, and the first pixel that had one.
  struct NonFinite {
    uint64_t samples = 0;
    std::size_t first_pixel = 0;
  };
  NonFinite non_finite_samples() const;

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
  /// With these layers alone, of those that it has.
  Image to_image(LayerSet layers) const;

 private:
  struct Pixel {
    double radiance[3] = {};
    double squares[3] = {};
    double alpha = 0;
    double albedo[3] = {};
    double depth = 0;
    double depth_weight = 0;
    double lookups = 0;
    uint32_t samples = 0;
    uint32_t non_finite = 0;
  };

  /// Of three channels each, in sums_.
  enum Sum { kNormal, kPosition, kTransmittance, kBackground, kUnscattered, kAtMostOnce, kEven };
  static constexpr int kSums = 7;
  /// Where a pixel has its sums; -1: nowhere.
  using SumPlaces = std::array<int, kSums>;
  static SumPlaces places_of(LayerSet layers, int& count);

  void add_layers(std::size_t pixel, const LayerSample& sample);
  /// Of a sum that has a place.
  double* sums_of(std::size_t pixel, Sum which) {
    return sums_.data() + pixel * sums_per_pixel_ + places_[which];
  }
  const double* sums_of(std::size_t pixel, Sum which) const {
    return sums_.data() + pixel * sums_per_pixel_ + places_[which];
  }
  void put_layer(Layer layer, std::size_t pixel, std::vector<float>& values) const;

  PixelWindow window_;
  std::optional<RgbChromaticities> chromaticities_;
  LayerSet layers_;
  std::vector<Pixel> pixels_;
  int sums_per_pixel_ = 0;  // in doubles
  SumPlaces places_{};
  std::vector<double> sums_;
  WavelengthBuckets buckets_;
  /// Of a bucket of a pixel.
  struct BucketSum {
    double radiance = 0;
    double samples = 0;
  };
  std::vector<BucketSum> bucket_sums_;
};

}  // namespace freepath
