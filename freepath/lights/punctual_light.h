#pragma once
/// @file Lights at a point.

#include <optional>
#include <string>
#include <vector>

#include "freepath/base/octahedral.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/lights/light_bounds.h"
#include "freepath/lights/light_descriptions.h"
#include "freepath/lights/light_frame.h"
#include "freepath/lights/light_sample.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// An intensity that depends on the direction. What it is made of decides the kind.
class PunctualLight {
 public:
  PunctualLight(const PointLight& light, const Vec3d& origin, const SpectrumTable& table);
  PunctualLight(const SpotLight& light, const Vec3d& origin, const SpectrumTable& table);
  PunctualLight(const GoniometricLight& light, const Vec3d& origin, const SpectrumTable& table);
  PunctualLight(const ProjectionLight& light, const Vec3d& origin, const SpectrumTable& table);

  /// Intensity towards a direction; not normalised [world].
  SampledSpectrum intensity(const Vec3f& away, const SpectrumValues& values) const;
  /// The only direction from which it is seen; the probability is left 1.
  LightSample sample(const Vec3f& from, const SpectrumValues& values) const;
  /// Its power is 0 if it is black.
  const LightBounds& bounds() const { return bounds_; }

 private:
  enum class Kind { kPoint, kSpot, kGoniometric, kProjection };

  /// @param flux_of_one power for an intensity of 1, of its mean or on the axis
  void set_spectrum(SpectrumId intensity, double scale, const std::optional<double>& power,
                    double flux_of_one, const SpectrumTable& table, const std::string& name);
  void set_position(const Vec3d& position);

  Kind kind_;
  Vec3f position_;
  SpectrumId intensity_;
  float scale_ = 1;
  LightBounds bounds_;
  LightFrame frame_;
  float cosine_end_ = 0, cosine_start_ = 0;  // of a spot's edge
  float half_width_ = 0, half_height_ = 0;   // of a projection's image at z = 1
  int width_ = 0, height_ = 0;
  std::vector<float> factors_;  // of a goniometric image
  std::vector<Vec3f> colours_;  // of a projected image
};

}  // namespace freepath
