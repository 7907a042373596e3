#pragma once
/// @file What may be said of a rendering, and what the library makes of it.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "freepath/paths/renderer.h"
#include "python/src/scenes.h"
#include "python/src/walk_options.h"

namespace freepath::python {

/// What may be said of a rendering; of the rest the scene has its say.
struct RenderOptions {
  WalkOptions walk;
  std::optional<std::string> tracker, estimator, interpolation, layers, color;
  std::optional<uint32_t> samples, max_scatterings;
  std::optional<uint64_t> seed;
  double time_limit = 0;
  std::optional<double> noise;
  std::optional<std::array<double, 4>> crop;           ///< x0, y0, x1, y1 [pixels]
  std::optional<std::pair<uint32_t, uint32_t>> range;  ///< Samples, from first to before end.
  std::optional<std::pair<uint32_t, uint32_t>> tile;   ///< Number and count.
  int wavelengths = RenderSettings{}.wavelengths;
  int threads = 0;
  bool shadow_roulette = true;
  bool near_light_lines = true;
  bool lobe_splitting = true;
  bool light_through_glass = true;
  bool adaptive = false;
};

/// @throws Error for a word that is none, listing those there are
ColorMode color_mode(const PythonScene& scene, const RenderOptions& options);

/// Settings of a rendering; what the options do not say the scene's file says, and else the
/// program's standards do.
/// @throws Error for methods and words that do not exist
RenderSettings render_settings(const PythonScene& scene, const RenderOptions& options);

}  // namespace freepath::python
