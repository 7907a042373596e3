#include "freepath/scene/assembly/build_context.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/named_spectra.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;

/// What a value becomes by its kind.
struct ToDistribution {
  BuildContext& context;
  ColorMeaning meaning;
  const SourceLocation& location;
  std::string_view name;

  SpectralDistribution operator()(const RgbValue& value) const {
    const RgbColorSpace& space = rgb_color_space(name_of(value.color_space));
    Vec3d rgb(value.r, value.g, value.b);
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(rgb[i]) || rgb[i] < 0) {
        fail_at(location, "'{}' is ({}, {}, {}): a colour has to be finite and not negative", name,
                rgb.x, rgb.y, rgb.z);
      }
    }
    switch (meaning) {
      case ColorMeaning::kUnbounded:
        if (rgb.x == rgb.y && rgb.y == rgb.z) return {rgb.x};
        return {RgbSpectrum::unbounded(rgb, space)};
      case ColorMeaning::kIlluminant:
        return {RgbSpectrum::illuminant(rgb, space)};
      case ColorMeaning::kReflectance:
        break;
    }
    if (std::max({rgb.x, rgb.y, rgb.z}) > 1) {
      context.diagnostics.warn(
          location, fmt::format("'{}' has values above 1, which are clipped to 1", name));
      for (int i = 0; i < 3; ++i) rgb[i] = std::min(rgb[i], 1.0);
    }
    return {RgbSpectrum::reflectance(rgb, space)};
  }

  SpectralDistribution operator()(const BlackbodyValue& value) const {
    return at_location(location,
                       [&] { return SpectralDistribution(BlackbodySpectrum(value.temperature)); });
  }

  SpectralDistribution operator()(const NamedSpectrum& value) const {
    return at_location(location, [&] { return SpectralDistribution(named_spectrum(value.name)); });
  }

  SpectralDistribution operator()(const std::shared_ptr<const SpectrumSamples>& value) const {
    const std::vector<double>& values = value->values;
    for (const double sample : values) {
      if (!std::isfinite(sample) || sample < 0) {
        fail_at(location, "'{}' has the value {}: a spectrum has to be finite and not negative",
                name, sample);
      }
    }
    const bool everywhere = value->wavelengths.front() <= kShortestWavelength &&
                            value->wavelengths.back() >= kLongestWavelength;
    if (everywhere && std::all_of(values.begin(), values.end(),
                                  [&](double sample) { return sample == values.front(); })) {
      return {values.front()};
    }
    return {LinearSpectrum(value->wavelengths, values, OutsideSamples::kZero)};
  }
};

}  // namespace

SpectralDistribution distribution_of(BuildContext& context, const SpectrumValue& value,
                                     ColorMeaning meaning, const ParameterList& list,
                                     std::string_view name) {
  return std::visit(ToDistribution{context, meaning, list.location_of(name), name}, value);
}

fs::path file_of(BuildContext& context, const ParameterList& list, std::string_view name) {
  const std::string text = list.get_string(name, "");
  const SourceLocation& location = list.location_of(name);
  if (!list.type_of(name)) fail_at(location, "'{}' is missing: the file to read", name);
  const fs::path path(text);
  const fs::path candidates[] = {fs::path(*location.file).parent_path() / path,
                                 fs::path(context.pbrt.file).parent_path() / path};
  if (text.empty()) fail_at(location, "'{}' names no file", name);
  std::error_code ignored;
  for (const fs::path& candidate : candidates) {
    if (!fs::exists(candidate, ignored)) continue;
    context.files.push_back(candidate);
    return candidate;
  }
  fail_at(location, "there is no file {} (looked for '{}')", in_quotes(text),
          candidates[0].string());
}

Image read_scene_image(BuildContext& context, const std::string& path,
                       const SourceLocation& location) {
  return at_location(location, [&] {
    Image image = read_image(path);
    const std::string warning = mend_invalid_pixels(image, path, context.options.invalid);
    if (!warning.empty()) context.diagnostics.warn(location, warning);
    return in_srgb(std::move(image));
  });
}

}  // namespace freepath
