#pragma once
/// @file What shines on a scene from everywhere around.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "freepath/base/rgb.h"
#include "freepath/base/up_axis.h"
#include "freepath/io/invalid_values.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/light_descriptions.h"
#include "freepath/lights/sun.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The daylight sky.
struct SkyEnvironment {};

/// What shines on the volume.
struct LightOptions {
  /// The sky, one radiance, or the name of a latitude-longitude image.
  std::variant<SkyEnvironment, Rgb, std::string> environment = SkyEnvironment{};
  InvalidPolicy invalid = InvalidPolicy::kZero;  ///< Policy for pixels of the image.
  bool sun = true;  ///< Whether its disc shines; it shapes the sky in any case.
  SunParameters sun_parameters{.elevation = 38, .azimuth = 255};
};

/// What shines on a volume from everywhere around.
struct Surroundings {
  /// Radiance that is the same from everywhere, in linear sRGB, or an image; none: nothing.
  std::optional<std::variant<Rgb, ImageEnvironment>> environment = {};
  std::optional<Sun> sun = {};
};

/// @param warnings gets what there is to say about the image, if not null
/// @throws Error as the environments and the image reader
Surroundings make_surroundings(const LightOptions& options, UpAxis up,
                               std::vector<std::string>* warnings = nullptr);

/// The lights of a scene that surroundings stand for.
/// @throws Error for a radiance that is negative or not finite
std::vector<LightDescription> to_lights(const Surroundings& surroundings, SpectrumTable& table);

}  // namespace freepath
