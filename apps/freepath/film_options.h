#pragma once
/// @file Options on what is recorded of a picture, and what becomes of it.

#include <memory>
#include <optional>
#include <string>

#include "apps/freepath/denoiser.h"
#include "apps/freepath/tev_display.h"
#include "freepath/paths/renderer.h"
#include "freepath/sensors/layers.h"
#include "freepath/sensors/pixel_window.h"

namespace CLI {  // NOLINT(readability-identifier-naming)
class App;
}

namespace freepath::program {

/// The options as they were typed.
struct FilmOptions {
  std::string layers, crop, display, exr;
  bool denoise = false;
  bool transparent = false;
};

/// Layers that a denoiser looks at; it leaves the background as it is.
inline constexpr LayerSet kDenoiserLayers = {Layer::kAlbedo, Layer::kNormal, Layer::kBackground};

/// What they mean.
struct FilmPlan {
  std::optional<LayerSet> layers;  ///< None: nothing was said.
  std::optional<Crop> crop;
  std::shared_ptr<const Denoiser> denoiser;  ///< Null: none.
  std::optional<DisplayAddress> display;
  ExrFormat exr;
  /// Whether light from outside lights the scene but isn't seen behind it.
  bool transparent = false;

  /// Layers that a picture gets.
  LayerSet written() const { return layers.value_or(LayerSet::standard()); }
  /// Layers to record: a denoiser looks at more than is written.
  LayerSet recorded() const { return denoiser ? written().with(kDenoiserLayers) : written(); }
};

void add_film_options(CLI::App& command, FilmOptions& options);

/// @throws Error naming the option; where no denoiser can be loaded, how to get one
FilmPlan read_film_options(const FilmOptions& options);

/// "standard" or "neutral". @throws Error naming --view
ViewTransform read_view(const std::string& text);

/// Adds --exr, to a command that writes pictures.
void add_exr_option(CLI::App& command, std::string& text);

/// Refuses a picture that this machine's memory can't hold: it would end the program, or others.
void check_memory(const PixelWindow& window, const FilmPlan& plan,
                  const WavelengthBuckets& buckets = {});

/// Shows the picture while these settings are rendered with, on the display that a plan names.
/// A display that can't be reached, or is lost, is warned of.
/// @param name of the picture there
/// @return null if there is none; must outlive the rendering
std::shared_ptr<TevDisplay> show_passes(const FilmPlan& plan, const std::string& name,
                                        RenderSettings& settings);

}  // namespace freepath::program
