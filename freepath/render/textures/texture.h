#pragma once
/// @file The textures of a scene as plain data, and how materials refer to them. Names, parameters
/// and meaning are those of pbrt-v4.

#include <cstdint>
#include <memory>
#include <variant>

#include "freepath/render/textures/image_texture.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// A texture of numbers in a TextureTable.
struct FloatTextureId {
  uint32_t index = 0;

  bool operator==(const FloatTextureId&) const = default;
};
/// A texture of spectra in a TextureTable.
struct SpectrumTextureId {
  uint32_t index = 0;

  bool operator==(const SpectrumTextureId&) const = default;
};

/// What a parameter of a material or texture can be: the same everywhere, or a texture.
using FloatInput = std::variant<float, FloatTextureId>;
using SpectrumInput = std::variant<SpectrumId, SpectrumTextureId>;

/// From the texture coordinates of a surface to those of a texture:
/// s = uscale · u + udelta, t = vscale · v + vdelta.
struct UvMapping {
  float uscale = 1, vscale = 1;
  float udelta = 0, vdelta = 0;
};

/// An image on the surface. Float textures take the mean of the colour channels, or alpha where an
/// image has one that isn't 1 everywhere.
struct ImageMapTexture {
  std::shared_ptr<const TextureImage> image;
  UvMapping mapping;
  ImageWrap wrap = ImageWrap::kRepeat;
  float scale = 1;
  bool invert = false;  ///< 1 - value, after the scale, not below 0.
};

/// A product. A spectrum texture is scaled by a float.
template <class Input>
struct ScaleTexture {
  Input tex;
  FloatInput scale = 1.0F;
};

/// (1 - amount) · tex1 + amount · tex2.
template <class Input>
struct MixTexture {
  Input tex1, tex2;
  FloatInput amount = 0.5F;
};

/// Squares of side 1 in (s, t): tex1 where floor(s) + floor(t) is even, else tex2. Point sampled.
template <class Input>
struct CheckerboardTexture {
  Input tex1, tex2;
  UvMapping mapping;
};

using FloatTexture = std::variant<float, ImageMapTexture, ScaleTexture<FloatInput>,
                                  MixTexture<FloatInput>, CheckerboardTexture<FloatInput>>;
using SpectrumTexture = std::variant<SpectrumId, ImageMapTexture, ScaleTexture<SpectrumInput>,
                                     MixTexture<SpectrumInput>, CheckerboardTexture<SpectrumInput>>;

}  // namespace freepath
