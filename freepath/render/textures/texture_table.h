#pragma once
/// @file All textures of a scene.

#include <cstddef>
#include <vector>

#include "freepath/base/channels.h"
#include "freepath/render/surfaces/surface_point.h"
#include "freepath/render/textures/texture.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The textures of a scene. Filled while the scene is built, then shared by all threads. A texture
/// refers only to ones added before it, so that there are no cycles.
class TextureTable {
 public:
  /// @throws Error if it refers to a texture that is not in the table, or to no image
  FloatTextureId add(FloatTexture texture);
  /// @throws Error if it refers to a texture that is not in the table, or to no image
  SpectrumTextureId add(SpectrumTexture texture);

  /// The value at a point of a surface.
  float evaluate_float(FloatTextureId id, const SurfacePoint& point) const;
  /// The value at a point of a surface in the channels of a path. Colours of images are those of
  /// SpectrumValues::reflectance.
  Channels evaluate_spectrum(SpectrumTextureId id, const SurfacePoint& point,
                             const SpectrumValues& spectra) const;

  /// Those of a constant or a texture.
  float evaluate(const FloatInput& input, const SurfacePoint& point) const;
  Channels evaluate(const SpectrumInput& input, const SurfacePoint& point,
                    const SpectrumValues& spectra) const;

  std::size_t float_count() const { return floats_.size(); }
  std::size_t spectrum_count() const { return spectra_.size(); }

 private:
  void check(const FloatInput& input) const;
  void check(const SpectrumInput& input) const;
  template <class Texture>
  void check_texture(const Texture& texture) const;

  std::vector<FloatTexture> floats_;
  std::vector<SpectrumTexture> spectra_;
};

}  // namespace freepath
