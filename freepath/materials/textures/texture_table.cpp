#include "freepath/materials/textures/texture_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/materials/textures/texture_noise.h"

namespace freepath {
namespace {

/// Beyond so many evaluations values are remembered, which itself takes the time of some.
constexpr uint64_t kFewEvaluations = 32;

uint64_t saturated_sum(uint64_t a, uint64_t b) {
  return a > std::numeric_limits<uint64_t>::max() - b ? std::numeric_limits<uint64_t>::max()
                                                      : a + b;
}

/// Whether a sum of whole numbers is even; in floating point, where those beyond the range of
/// integers do no harm.
bool is_even(double sum) { return sum - 2 * std::floor(0.5 * sum) == 0; }

struct InFirst {
  const TexturePoint& point;

  bool operator()(const TextureMapping& mapping) const {
    const TextureCoordinates at = mapped(mapping, point);
    return is_even(std::floor(double{at.s}) + std::floor(double{at.t}));
  }
  bool operator()(const SolidMapping& mapping) const {
    const Vec3d at = mapping(point);
    return is_even(std::floor(at.x) + std::floor(at.y) + std::floor(at.z));
  }
};

float scaled(const ImageMapTexture& texture, float value) {
  value *= texture.scale;
  return texture.invert ? std::max(0.0F, 1.0F - value) : value;
}

}  // namespace

/// The evaluation of a texture, and of those that it is made of, at a point.
class TextureEvaluation {
 public:
  /// @param spectra null for floats
  /// @param remembers whether values are kept, lest they be found many times
  TextureEvaluation(const TextureTable& table, const SurfacePoint& point,
                    const SpectrumValues* spectra, bool remembers)
      : table_(table),
        point_{point, Vec3d(point.position) + table.origin_},
        spectra_(spectra),
        remembers_(remembers) {}

  float value(FloatTextureId id) {
    return known(floats_, id.index, [&] { return float_of(table_.floats_[id.index]); });
  }
  SampledSpectrum value(SpectrumTextureId id) {
    return known(spectrum_values_, id.index,
                 [&] { return spectrum_of(table_.spectra_[id.index]); });
  }
  float value(const FloatInput& input) {
    if (const float* const constant = std::get_if<float>(&input)) return *constant;
    return value(*std::get_if<FloatTextureId>(&input));
  }
  SampledSpectrum value(const SpectrumInput& input) {
    if (const auto* const constant = std::get_if<SpectrumId>(&input)) return (*spectra_)[*constant];
    return value(*std::get_if<SpectrumTextureId>(&input));
  }

  uint64_t evaluated() const { return evaluated_; }

 private:
  template <class Values, class Find>
  auto known(Values& values, uint32_t index, const Find& find) -> decltype(find()) {
    if (!remembers_) {
      ++evaluated_;
      return find();
    }
    const auto found = values.find(index);
    if (found != values.end()) return found->second;
    ++evaluated_;
    const auto value = find();
    values.emplace(index, value);
    return value;
  }

  float float_of(const FloatTexture& texture) {
    return std::visit([&](const auto& kind) { return float_of(kind); }, texture);
  }
  SampledSpectrum spectrum_of(const SpectrumTexture& texture) {
    return std::visit([&](const auto& kind) { return spectrum_of(kind); }, texture);
  }

  float float_of(float constant) { return constant; }
  float float_of(const ImageMapTexture& texture) {
    const TextureCoordinates at = mapped(texture.mapping, point_);
    return scaled(texture, texture.image->value(at.s, at.t, texture.wrap));
  }
  float float_of(const FbmTexture& texture) {
    return fractal_motion(texture.mapping(point_), texture.omega, texture.octaves);
  }
  float float_of(const WrinkledTexture& texture) {
    return turbulence(texture.mapping(point_), texture.omega, texture.octaves);
  }
  float float_of(const WindyTexture& texture) {
    const Vec3d at = texture.mapping(point_);
    return std::abs(fractal_motion(at * 0.1, 0.5F, 3)) * fractal_motion(at, 0.5F, 6);
  }
  template <class Kind>
  float float_of(const Kind& texture) {
    return compound<float>(texture);
  }

  SampledSpectrum spectrum_of(const SpectrumId& constant) { return (*spectra_)[constant]; }
  SampledSpectrum spectrum_of(const ImageMapTexture& texture) {
    const TextureCoordinates at = mapped(texture.mapping, point_);
    Vec3f rgb = texture.image->color(at.s, at.t, texture.wrap);
    for (int i = 0; i < 3; ++i) rgb[i] = std::max(0.0F, scaled(texture, rgb[i]));
    return spectra_->reflectance(rgb);
  }
  SampledSpectrum spectrum_of(const MarbleTexture& texture) {
    const Vec3d at = texture.mapping(point_) * texture.scale;
    const double bent =
        at.y + double{texture.variation} * fractal_motion(at, texture.omega, texture.octaves);
    return spectra_->reflectance(marble_color(static_cast<float>(0.5 + 0.5 * std::sin(bent))));
  }
  template <class Kind>
  SampledSpectrum spectrum_of(const Kind& texture) {
    return compound<SampledSpectrum>(texture);
  }

  template <class Value, class Input>
  Value compound(const ScaleTexture<Input>& texture) {
    const float scale = value(texture.scale);
    return scale == 0.0F ? Value(0) : Value(value(texture.tex) * scale);
  }
  template <class Value, class Input>
  Value compound(const MixTexture<Input>& texture) {
    return mix<Value>(texture.tex1, texture.tex2, value(texture.amount));
  }
  template <class Value, class Input>
  Value compound(const DirectionMixTexture<Input>& texture) {
    return mix<Value>(texture.tex2, texture.tex1, std::abs(point_.surface.normal.dot(texture.dir)));
  }
  template <class Value, class Input>
  Value compound(const CheckerboardTexture<Input>& texture) {
    return value(std::visit(InFirst{point_}, texture.mapping) ? texture.tex1 : texture.tex2);
  }
  template <class Value, class Input>
  Value compound(const BilerpTexture<Input>& texture) {
    const TextureCoordinates at = mapped(texture.mapping, point_);
    const Value low(value(texture.v00) * (1.0F - at.s) + value(texture.v10) * at.s);
    const Value high(value(texture.v01) * (1.0F - at.s) + value(texture.v11) * at.s);
    return Value(low * (1.0F - at.t) + high * at.t);
  }
  template <class Value, class Input>
  Value compound(const DotsTexture<Input>& texture) {
    const TextureCoordinates at = mapped(texture.mapping, point_);
    return value(in_polka_dot(at.s, at.t) ? texture.inside : texture.outside);
  }
  template <class Value, class Input>
  Value mix(const Input& first, const Input& second, float amount) {
    if (amount == 0.0F) return value(first);
    if (amount == 1.0F) return value(second);
    return Value(value(first) * (1.0F - amount) + value(second) * amount);
  }

  const TextureTable& table_;
  const TexturePoint point_;
  const SpectrumValues* const spectra_;
  const bool remembers_;
  std::unordered_map<uint32_t, float> floats_;
  std::unordered_map<uint32_t, SampledSpectrum> spectrum_values_;
  uint64_t evaluated_ = 0;
};

uint64_t TextureTable::work(const FloatInput& input) const {
  const auto* const id = std::get_if<FloatTextureId>(&input);
  if (id == nullptr) return 0;
  if (id->index >= floats_.size()) {
    fail("a texture refers to float texture {}, but there are {}; add that one first", id->index,
         floats_.size());
  }
  return float_work_[id->index];
}

uint64_t TextureTable::work(const SpectrumInput& input) const {
  const auto* const id = std::get_if<SpectrumTextureId>(&input);
  if (id == nullptr) return 0;
  if (id->index >= spectra_.size()) {
    fail("a texture refers to spectrum texture {}, but there are {}; add that one first", id->index,
         spectra_.size());
  }
  return spectrum_work_[id->index];
}

/// How many evaluations a texture takes at most if nothing is remembered.
template <class Texture>
uint64_t TextureTable::work_of(const Texture& texture) const {
  uint64_t sum = 1;
  const auto add = [&](const auto&... inputs) { ((sum = saturated_sum(sum, work(inputs))), ...); };
  if constexpr (std::is_same_v<Texture, ImageMapTexture>) {
    if (!texture.image) fail("an imagemap texture needs an image");
  } else if constexpr (requires { texture.tex; }) {
    add(texture.tex, texture.scale);
  } else if constexpr (requires { texture.amount; }) {
    add(texture.tex1, texture.tex2, texture.amount);
  } else if constexpr (requires { texture.tex1; }) {
    add(texture.tex1, texture.tex2);
  } else if constexpr (requires { texture.v00; }) {
    add(texture.v00, texture.v01, texture.v10, texture.v11);
  } else if constexpr (requires { texture.inside; }) {
    add(texture.inside, texture.outside);
  }
  return sum;
}

FloatTextureId TextureTable::add(FloatTexture texture) {
  float_work_.push_back(std::visit([this](const auto& kind) { return work_of(kind); }, texture));
  floats_.push_back(std::move(texture));
  return {static_cast<uint32_t>(floats_.size() - 1)};
}

SpectrumTextureId TextureTable::add(SpectrumTexture texture) {
  spectrum_work_.push_back(std::visit([this](const auto& kind) { return work_of(kind); }, texture));
  spectra_.push_back(std::move(texture));
  return {static_cast<uint32_t>(spectra_.size() - 1)};
}

float TextureTable::evaluate_float(FloatTextureId id, const SurfacePoint& point,
                                   uint64_t* evaluated) const {
  TextureEvaluation evaluation(*this, point, nullptr, float_work_[id.index] > kFewEvaluations);
  const float value = evaluation.value(id);
  if (evaluated != nullptr) *evaluated += evaluation.evaluated();
  return value;
}

SampledSpectrum TextureTable::evaluate_spectrum(SpectrumTextureId id, const SurfacePoint& point,
                                                const SpectrumValues& spectra,
                                                uint64_t* evaluated) const {
  TextureEvaluation evaluation(*this, point, &spectra, spectrum_work_[id.index] > kFewEvaluations);
  const SampledSpectrum value = evaluation.value(id);
  if (evaluated != nullptr) *evaluated += evaluation.evaluated();
  return value;
}

std::optional<float> TextureTable::constant(const FloatInput& input) const {
  if (const float* const value = std::get_if<float>(&input)) return *value;
  const auto* const value =
      std::get_if<float>(&floats_[std::get_if<FloatTextureId>(&input)->index]);
  return value == nullptr ? std::nullopt : std::optional(*value);
}

float TextureTable::evaluate(const FloatInput& input, const SurfacePoint& point) const {
  if (const float* const constant = std::get_if<float>(&input)) return *constant;
  return evaluate_float(*std::get_if<FloatTextureId>(&input), point);
}

SampledSpectrum TextureTable::evaluate(const SpectrumInput& input, const SurfacePoint& point,
                                       const SpectrumValues& spectra) const {
  if (const auto* const constant = std::get_if<SpectrumId>(&input)) return spectra[*constant];
  return evaluate_spectrum(*std::get_if<SpectrumTextureId>(&input), point, spectra);
}

}  // namespace freepath
