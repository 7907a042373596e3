#include "freepath/scene/assembly/build_inputs.h"

#include <algorithm>
#include <string>
#include <vector>

#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath {
namespace {

/// A texture by the name that a parameter gives.
/// @param others of the other kind, to say so where the kinds were mixed up
template <class Textures, class Others>
auto texture_of(const Textures& textures, const Others& others, const ParameterList& list,
                std::string_view name, std::string_view kind, std::string_view other_kind) {
  const std::string texture = list.get_texture(name);
  const auto found = textures.find(texture);
  if (found != textures.end()) return found->second;
  const SourceLocation& location = list.location_of(name);
  if (others.contains(texture)) {
    fail_at(location, "parameter {} needs a {} texture, and {} is a {} texture", in_quotes(name),
            kind, in_quotes(texture), other_kind);
  }
  std::vector<std::string_view> known;
  known.reserve(textures.size());
  for (const auto& entry : textures) known.emplace_back(entry.first);
  fail_at(location, "there is no {} texture {}{}", kind, in_quotes(texture),
          did_you_mean(texture, known));
}

[[noreturn]] void fail_type(const ParameterList& list, std::string_view name,
                            std::string_view expected) {
  fail_at(list.location_of(name), "parameter {} must be of type {}, not {}", in_quotes(name),
          expected, name_of(*list.type_of(name)));
}

bool is_spectrum(ParameterType type) {
  return type == ParameterType::kRgb || type == ParameterType::kSpectrum ||
         type == ParameterType::kBlackbody;
}

}  // namespace

FloatInput float_input(const BuildContext& context, const ParameterList& list,
                       std::string_view name, double otherwise, const FloatRange& range) {
  const std::optional<ParameterType> type = list.type_of(name);
  if (type == ParameterType::kTexture) {
    return texture_of(context.float_textures, context.reflectance_textures, list, name, "float",
                      "spectrum");
  }
  if (type && *type != ParameterType::kFloat) fail_type(list, name, "float or texture");
  const double value = list.get_float(name, otherwise);
  if (value < range.smallest) {
    fail_at(list.location_of(name), "parameter {} is {}; it must be at least {}", in_quotes(name),
            value, range.smallest);
  }
  if (value > range.largest) {
    fail_at(list.location_of(name), "parameter {} is {}; it must be at most {}", in_quotes(name),
            value, range.largest);
  }
  return static_cast<float>(value);
}

SpectrumInput spectrum_input(BuildContext& context, const ParameterList& list,
                             std::string_view name, const SpectralDistribution& otherwise,
                             ColorMeaning meaning) {
  const std::optional<ParameterType> type = list.type_of(name);
  if (type == ParameterType::kTexture) {
    const auto& textures = meaning == ColorMeaning::kUnbounded ? context.unbounded_textures
                                                               : context.reflectance_textures;
    return texture_of(textures, context.float_textures, list, name, "spectrum", "float");
  }
  if (type && !is_spectrum(*type)) fail_type(list, name, "rgb, spectrum, blackbody or texture");
  if (!type) return context.scene.spectra->add(otherwise, SpectrumRole::kReflectance);
  return context.scene.spectra->add(
      distribution_of(context, list.get_spectrum(name, {}), meaning, list, name),
      SpectrumRole::kReflectance);
}

SpectrumId index_input(BuildContext& context, const ParameterList& list, std::string_view name,
                       double otherwise) {
  SpectrumTable& spectra = *context.scene.spectra;
  const std::optional<ParameterType> type = list.type_of(name);
  if (type && is_spectrum(*type)) {
    return spectra.add(
        distribution_of(context, list.get_spectrum(name, {}), ColorMeaning::kUnbounded, list, name),
        SpectrumRole::kIndex);
  }
  if (type && *type != ParameterType::kFloat) {
    fail_type(list, name, "float, rgb, spectrum or blackbody");
  }
  const double value = list.get_float(name, otherwise);
  if (value <= 0) {
    fail_at(list.location_of(name), "parameter {} is {}; a refractive index must be above 0",
            in_quotes(name), value);
  }
  return spectra.add(value, SpectrumRole::kIndex);
}

}  // namespace freepath
