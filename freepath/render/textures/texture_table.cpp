#include "freepath/render/textures/texture_table.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {

namespace {

struct TextureCoordinates {
  float s, t;
};

TextureCoordinates mapped(const UvMapping& mapping, const SurfacePoint& point) {
  return {mapping.uscale * point.u + mapping.udelta, mapping.vscale * point.v + mapping.vdelta};
}

/// Whether a point lies in one of the squares of tex1.
bool in_first_square(const UvMapping& mapping, const SurfacePoint& point) {
  const TextureCoordinates at = mapped(mapping, point);
  // In floating point, where coordinates beyond the range of integers do no harm.
  const float sum = std::floor(at.s) + std::floor(at.t);
  return sum - 2.0F * std::floor(0.5F * sum) == 0.0F;
}

float scaled(const ImageMapTexture& texture, float value) {
  value *= texture.scale;
  return texture.invert ? std::max(0.0F, 1.0F - value) : value;
}

float image_value(const ImageMapTexture& texture, const SurfacePoint& point) {
  const TextureCoordinates at = mapped(texture.mapping, point);
  return scaled(texture, texture.image->value(at.s, at.t, texture.wrap));
}

Channels image_color(const ImageMapTexture& texture, const SurfacePoint& point,
                     const SpectrumValues& spectra) {
  const TextureCoordinates at = mapped(texture.mapping, point);
  Vec3f rgb = texture.image->color(at.s, at.t, texture.wrap);
  for (int i = 0; i < 3; ++i) rgb[i] = std::max(0.0F, scaled(texture, rgb[i]));
  return spectra.reflectance(rgb);
}

/// The value of a texture whose inputs `evaluate` knows.
template <class Value, class Input, class Evaluate>
Value value_of(const ScaleTexture<Input>& texture, const SurfacePoint& /*point*/,
               const Evaluate& evaluate) {
  const float scale = evaluate(texture.scale);
  return scale == 0.0F ? Value(0) : Value(evaluate(texture.tex) * scale);
}
template <class Value, class Input, class Evaluate>
Value value_of(const MixTexture<Input>& texture, const SurfacePoint& /*point*/,
               const Evaluate& evaluate) {
  const float amount = evaluate(texture.amount);
  return Value(evaluate(texture.tex1) * (1.0F - amount) + evaluate(texture.tex2) * amount);
}
template <class Value, class Input, class Evaluate>
Value value_of(const CheckerboardTexture<Input>& texture, const SurfacePoint& point,
               const Evaluate& evaluate) {
  return evaluate(in_first_square(texture.mapping, point) ? texture.tex1 : texture.tex2);
}

}  // namespace

void TextureTable::check(const FloatInput& input) const {
  const auto* const id = std::get_if<FloatTextureId>(&input);
  if (id != nullptr && id->index >= floats_.size()) {
    fail("a texture refers to float texture {}, but there are {}; add that one first", id->index,
         floats_.size());
  }
}

void TextureTable::check(const SpectrumInput& input) const {
  const auto* const id = std::get_if<SpectrumTextureId>(&input);
  if (id != nullptr && id->index >= spectra_.size()) {
    fail("a texture refers to spectrum texture {}, but there are {}; add that one first", id->index,
         spectra_.size());
  }
}

template <class Texture>
void TextureTable::check_texture(const Texture& texture) const {
  if constexpr (std::is_same_v<Texture, ImageMapTexture>) {
    if (!texture.image) fail("an imagemap texture needs an image");
  } else if constexpr (requires { texture.scale; }) {
    check(texture.tex);
    check(texture.scale);
  } else if constexpr (requires { texture.tex1; }) {
    check(texture.tex1);
    check(texture.tex2);
    if constexpr (requires { texture.amount; }) check(texture.amount);
  }
}

FloatTextureId TextureTable::add(FloatTexture texture) {
  std::visit([this](const auto& kind) { check_texture(kind); }, texture);
  floats_.push_back(std::move(texture));
  return {static_cast<uint32_t>(floats_.size() - 1)};
}

SpectrumTextureId TextureTable::add(SpectrumTexture texture) {
  std::visit([this](const auto& kind) { check_texture(kind); }, texture);
  spectra_.push_back(std::move(texture));
  return {static_cast<uint32_t>(spectra_.size() - 1)};
}

float TextureTable::evaluate_float(FloatTextureId id, const SurfacePoint& point) const {
  const auto input_value = [&](const FloatInput& input) { return evaluate(input, point); };
  return std::visit(
      [&]<class Kind>(const Kind& texture) -> float {
        if constexpr (std::is_same_v<Kind, float>) {
          return texture;
        } else if constexpr (std::is_same_v<Kind, ImageMapTexture>) {
          return image_value(texture, point);
        } else {
          return value_of<float>(texture, point, input_value);
        }
      },
      floats_[id.index]);
}

Channels TextureTable::evaluate_spectrum(SpectrumTextureId id, const SurfacePoint& point,
                                         const SpectrumValues& spectra) const {
  const auto input_value = [&]<class Input>(const Input& input) {
    if constexpr (std::is_same_v<Input, FloatInput>) {
      return evaluate(input, point);
    } else {
      return evaluate(input, point, spectra);
    }
  };
  return std::visit(
      [&]<class Kind>(const Kind& texture) -> Channels {
        if constexpr (std::is_same_v<Kind, SpectrumId>) {
          return spectra[texture];
        } else if constexpr (std::is_same_v<Kind, ImageMapTexture>) {
          return image_color(texture, point, spectra);
        } else {
          return value_of<Channels>(texture, point, input_value);
        }
      },
      spectra_[id.index]);
}

float TextureTable::evaluate(const FloatInput& input, const SurfacePoint& point) const {
  if (const float* const constant = std::get_if<float>(&input)) return *constant;
  return evaluate_float(*std::get_if<FloatTextureId>(&input), point);
}

Channels TextureTable::evaluate(const SpectrumInput& input, const SurfacePoint& point,
                                const SpectrumValues& spectra) const {
  if (const auto* const constant = std::get_if<SpectrumId>(&input)) return spectra[*constant];
  return evaluate_spectrum(*std::get_if<SpectrumTextureId>(&input), point, spectra);
}

}  // namespace freepath
