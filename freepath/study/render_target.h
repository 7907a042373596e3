#pragma once
/// @file What estimators are compared on.

#include <functional>
#include <optional>
#include <string>

#include "freepath/base/rgb_primaries.h"
#include "freepath/paths/renderer.h"

namespace freepath {

/// A picture that can be rendered in more than one way.
struct RenderTarget {
  std::string name;  ///< Name for people: "cloud.vdb".
  /// Digest of everything that the exact picture depends on: the same digest, the same picture.
  std::string digest;
  int width = 0, height = 0;  ///< [pixels]
  /// Primaries of the space of its pictures' R, G and B, where it is not sRGB's.
  std::optional<RgbChromaticities> chromaticities = {};
  /// Renders it. As `render`; of the settings' layers all but variance, samples and look-ups are
  /// left to it.
  std::function<RenderResult(const RenderSettings&, const ProgressFunction&)> render = {};
  /// Renders it with independent samples, whose variance a picture knows: samples that are spread
  /// evenly have less. Null: `render` does.
  std::function<RenderResult(const RenderSettings&, const ProgressFunction&)> render_reference = {};
};

/// How to estimate a picture.
struct Configuration {
  std::string tracker = "delta", transmittance = "ratio";  ///< Methods with their options.
  Interpolation interpolation = Interpolation::kStochastic;

  bool operator==(const Configuration&) const = default;
};

/// Whether one of its methods says that it is biased.
bool is_biased(const Configuration& configuration);

/// "nearest", "trilinear" or "stochastic".
std::string_view to_string(Interpolation interpolation);

}  // namespace freepath
