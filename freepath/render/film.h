#pragma once
/// @file The film: what the paths of each pixel add up to.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/spectrum.h"
#include "freepath/io/image.h"

namespace freepath {

/// What one path found.
struct PathSample {
  Spectrum radiance{0.0F};  ///< Estimate of the radiance that reaches the film.
  float alpha = 0;          ///< Estimate of 1 - transmittance along the camera ray.
  Spectrum albedo{0.0F};    ///< Albedo at the first scatter; 0 if there was none.
  float depth = 0;          ///< Distance to the first scatter [world].
  float depth_weight = 0;   ///< 1 if there was a first scatter, else 0 (or its weight).
  float lookups = 0;        ///< Look-ups of fields along the path.
};

/// Sums over the paths of each pixel, in double precision.
///
/// A pixel's samples must be added in the order of their numbers, by one thread at a time;
/// different pixels may be added to at the same time. Then the picture does not depend on threads
/// or batches.
class Film {
 public:
  /// @throws Error for an empty film
  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Adds the next sample of a pixel.
  ///
  /// A sample with a NaN or infinite part is counted, not added: whoever adds samples reports it
  /// as an internal error (non_finite_samples).
  /// @param pixel row · width + column
  void add(std::size_t pixel, const PathSample& sample);

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

  /// The picture: R, G, B, A, albedo.{R,G,B}, depth.Z, lookups, variance.{R,G,B}.
  ///
  /// A is 1 - transmittance. depth.Z is the mean distance to the first scatter, 0 where no path
  /// scattered. lookups is their mean number for a path. variance is that of the mean,
  /// (E[x²] - E[x]²) / (n - 1); of a single sample x² stands in, which is not below the variance on
  /// average. A pixel without samples is 0.
  Image to_image() const;

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

  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace freepath
