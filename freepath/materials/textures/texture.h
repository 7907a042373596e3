#pragma once
/// @file The textures of a scene as plain data, and how materials refer to them. Names, parameters
/// and meaning are those of pbrt-v4.

#include <cstdint>
#include <memory>
#include <variant>

#include "freepath/materials/textures/image_texture.h"
#include "freepath/materials/textures/texture_mapping.h"
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

/// An image on the surface. Float textures take the mean of the colour channels, or alpha where an
/// image has one that isn't 1 everywhere.
struct ImageMapTexture {
  std::shared_ptr<const TextureImage> image;
  TextureMapping mapping = {};
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

/// A mix by direction: |n · dir| of tex1, the rest of tex2, where n is the geometric normal.
template <class Input>
struct DirectionMixTexture {
  Input tex1, tex2;
  Vec3f dir{0, 1, 0};  ///< Unit [world].
};

/// Squares of side 1 in (s, t), or cubes in space: tex1 where the sum of the coordinates' whole
/// numbers is even, else tex2. Point sampled.
template <class Input>
struct CheckerboardTexture {
  Input tex1, tex2;
  std::variant<TextureMapping, SolidMapping> mapping = {};
};

/// Bilinear in (s, t), v10 at s = 1, t = 0; beyond the square of side 1 it goes on.
template <class Input>
struct BilerpTexture {
  Input v00, v01, v10, v11;
  TextureMapping mapping = {};
};

/// in_polka_dot() of (s, t).
template <class Input>
struct DotsTexture {
  Input inside, outside;
  TextureMapping mapping = {};
};

/// fractal_motion()
struct FbmTexture {
  SolidMapping mapping;
  int octaves = 8;
  float omega = 0.5F;
};

/// turbulence()
struct WrinkledTexture {
  SolidMapping mapping;
  int octaves = 8;
  float omega = 0.5F;
};

/// Waves on water: six octaves of noise, times the absolute value of three that are ten times as
/// large.
struct WindyTexture {
  SolidMapping mapping;
};

/// Layers along y, bent by `variation` times noise; marble_color() of their sine.
struct MarbleTexture {
  SolidMapping mapping;
  int octaves = 8;
  float omega = 0.5F;
  float scale = 1;
  float variation = 0.2F;
};

using FloatTexture =
    std::variant<float, ImageMapTexture, ScaleTexture<FloatInput>, MixTexture<FloatInput>,
                 DirectionMixTexture<FloatInput>, CheckerboardTexture<FloatInput>,
                 BilerpTexture<FloatInput>, DotsTexture<FloatInput>, FbmTexture, WrinkledTexture,
                 WindyTexture>;
using SpectrumTexture =
    std::variant<SpectrumId, ImageMapTexture, ScaleTexture<SpectrumInput>,
                 MixTexture<SpectrumInput>, DirectionMixTexture<SpectrumInput>,
                 CheckerboardTexture<SpectrumInput>, BilerpTexture<SpectrumInput>,
                 DotsTexture<SpectrumInput>, MarbleTexture>;

}  // namespace freepath
