#pragma once
/// @file All textures of a scene.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/geometry/surface_point.h"
#include "freepath/materials/textures/texture.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

class TextureEvaluation;

/// The textures of a scene. Filled while the scene is built, then shared by all threads. A texture
/// refers only to ones added before it, so that there are no cycles.
///
/// Textures that are made of others more than once, at any depth, take no more time than there are
/// of them: each is evaluated once for a point.
class TextureTable {
 public:
  /// @throws Error if it refers to a texture that is not in the table, or to no image
  FloatTextureId add(FloatTexture texture);
  /// @throws Error if it refers to a texture that is not in the table, or to no image
  SpectrumTextureId add(SpectrumTexture texture);

  /// What positions of surface points are relative to [world].
  void set_origin(const Vec3d& origin) { origin_ = origin; }

  /// The value at a point of a surface.
  /// @param evaluated if given, how many textures were evaluated is added to it
  float evaluate_float(FloatTextureId id, const SurfacePoint& point,
                       uint64_t* evaluated = nullptr) const;
  /// The value at a point of a surface in the channels of a path. Colours of images are those of
  /// SpectrumValues::reflectance.
  SampledSpectrum evaluate_spectrum(SpectrumTextureId id, const SurfacePoint& point,
                                    const SpectrumValues& spectra,
                                    uint64_t* evaluated = nullptr) const;

  /// The value of an input that is the same everywhere.
  std::optional<float> constant(const FloatInput& input) const;

  /// The value of a constant or a texture at a point.
  float evaluate(const FloatInput& input, const SurfacePoint& point) const;
  SampledSpectrum evaluate(const SpectrumInput& input, const SurfacePoint& point,
                           const SpectrumValues& spectra) const;

  std::size_t float_count() const { return floats_.size(); }
  std::size_t spectrum_count() const { return spectra_.size(); }

 private:
  friend class TextureEvaluation;

  uint64_t work(const FloatInput& input) const;
  uint64_t work(const SpectrumInput& input) const;
  template <class Texture>
  uint64_t work_of(const Texture& texture) const;

  std::vector<FloatTexture> floats_;
  std::vector<SpectrumTexture> spectra_;
  /// Evaluations that each texture takes at most if nothing is remembered.
  std::vector<uint64_t> float_work_, spectrum_work_;
  Vec3d origin_{0};
};

}  // namespace freepath
