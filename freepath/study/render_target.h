#pragma once
/// @file What estimators are compared on.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

/// Target whose pictures are those of a scene, in the size of its camera; a name and a digest are
/// left to the caller. Making a reference changes how the scene's samples are spread meanwhile.
RenderTarget target_of(const std::shared_ptr<PathScene>& scene, ColorMode color);

/// How to estimate a picture.
struct Configuration {
  std::string tracker = "delta", transmittance = "ratio";  ///< Methods with their options.
  Interpolation interpolation = Interpolation::kStochastic;

  bool operator==(const Configuration&) const = default;
};

/// Trackers that are compared where nothing is said, separated by commas.
inline constexpr const char* kComparedTrackers =
    "delta,weighted-delta,decomposition,weighted-decomposition,spectral-decomposition";

/// All combinations of methods and interpolations.
/// @param trackers as parse_method() has them
/// @param automatic tracker that `auto` stands for
/// @throws Error for a combination that is there twice
std::vector<Configuration> all_configurations(const std::vector<std::string>& trackers,
                                              const std::vector<std::string>& transmittances,
                                              const std::vector<Interpolation>& interpolations,
                                              const std::string& automatic);

/// Whether one of its methods says that it is biased.
bool is_biased(const Configuration& configuration);

/// "nearest", "trilinear" or "stochastic".
std::string_view to_string(Interpolation interpolation);

}  // namespace freepath
