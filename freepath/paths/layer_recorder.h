#pragma once
/// @file What paths record for the layers of a picture.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/rgb.h"
#include "freepath/sensors/film.h"

namespace freepath {

/// The layers of the samples of a job. It stands beside the paths, so that they carry nothing for
/// layers that nobody asked for. Values that are not finite are left out: their paths count as 0.
class LayerRecorder {
 public:
  /// Forgets all samples, and makes room for so many.
  void begin(const Film& film, std::size_t samples) {
    samples_.assign(film.layers().has_any(kPathLayers) ? samples : 0, LayerSample{});
    ahead_.assign(samples_.size(), Rgb(0.0F));
  }
  /// Forgets `count` samples from `first` on, and makes room for them.
  void renew(std::size_t first, std::size_t count, const Film& film) {
    if (!film.layers().has_any(kPathLayers)) return;
    samples_.resize(std::max(samples_.size(), first + count));
    ahead_.resize(samples_.size());
    std::fill_n(samples_.begin() + static_cast<std::ptrdiff_t>(first), count, LayerSample{});
    std::fill_n(ahead_.begin() + static_cast<std::ptrdiff_t>(first), count, Rgb(0.0F));
  }
  bool on() const { return !samples_.empty(); }
  const LayerSample& operator[](std::size_t sample) const {
    return on() ? samples_[sample] : none_;
  }

  /// A path is about to scatter.
  /// @param scatterings so far
  /// @param radiance that it has collected so far
  void scattering(uint32_t sample, uint32_t scatterings, const Rgb& radiance) {
    const Rgb so_far = radiance - ahead_[sample];
    if (scatterings == 0) add(samples_[sample].unscattered, so_far);
    if (scatterings == 1) add(samples_[sample].at_most_once, so_far);
    ahead_[sample] = Rgb(0.0F);
  }
  /// A path has collected radiance that is scattered once more than the path has been by now.
  void ahead(uint32_t sample, const Rgb& radiance) { add(ahead_[sample], radiance); }
  /// A path has ended, of which a branch goes on.
  void end_part(uint32_t sample, uint32_t scatterings, const Rgb& radiance) {
    if (scatterings == 1) add(samples_[sample].at_most_once, radiance - ahead_[sample]);
    ahead_[sample] = radiance;  // what the branch finds comes on top of it
  }
  /// A path has ended.
  void end(uint32_t sample, uint32_t scatterings, const Rgb& radiance) {
    const Rgb so_far = radiance - ahead_[sample];
    if (scatterings == 0) {
      add(samples_[sample].unscattered, so_far);
      add(samples_[sample].at_most_once, radiance);
    }
    if (scatterings == 1) add(samples_[sample].at_most_once, so_far);
  }
  /// A path has seen light from outside without a scattering.
  void background(uint32_t sample, const Rgb& radiance) {
    add(samples_[sample].background, radiance);
  }
  /// The first event of a path.
  /// @param weight that its depth has
  void event(uint32_t sample, const Rgb& normal, const Rgb& position, float weight) {
    add(samples_[sample].normal, normal * weight);
    add(samples_[sample].position, position * weight);
  }
  /// A path's first flights have come to a surface, or out.
  void transmittance(uint32_t sample, const Rgb& value) {
    add(samples_[sample].transmittance, value);
  }

 private:
  static void add(Rgb& sum, const Rgb& value) {
    if (is_finite(value)) sum += value;
  }

  std::vector<LayerSample> samples_;
  std::vector<Rgb> ahead_;  // see ahead()
  LayerSample none_;
};

}  // namespace freepath
