#pragma once
/// @file The renderer: samples of all pixels on all threads, in passes.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "freepath/paths/path_job.h"
#include "freepath/paths/path_scene.h"
#include "freepath/sensors/film.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// What is there of a picture already.
struct RenderedBefore {
  Film film;
  PathCounts counts;
  double seconds = 0;  ///< Time that it took [s].
};

/// Called with what there is of a picture, whole jobs alone, while no thread adds to it.
using CheckpointFunction =
    std::function<void(const Film&, const PathCounts& counts, double seconds)>;

/// How much to render, and with what.
struct RenderSettings {
  uint32_t samples = 64;      ///< Samples of each pixel; 0: as many as the time allows.
  uint32_t first_sample = 0;  ///< Number of the first of them.
  /// [s] 0: none. Passes are planned to end in time. One that doesn't is broken off: a first pass,
  /// after which each pixel has one sample, where it would take more than twice the limit and a
  /// second, later ones a few percent past the limit.
  double time_limit = 0;
  /// Never breaks a pass off for want of time: all pixels have as many samples, two at least, so
  /// that their variance is known. The time is that of the pass which ends next to it.
  bool whole_passes = false;
  int wavelengths = 4;  ///< Wavelengths of a path, where they are rendered: 1 to kMaxChannels.
  int threads = 0;      ///< 0: as many as the machine has.
  uint32_t max_scatterings = UINT32_MAX;
  /// Renders although the weights of paths are not bounded (WeightGrowth): to study methods, not
  /// for pictures.
  bool studies_unbounded_weights = false;
  /// Estimates transmittances of homogeneous media without variance, whatever `walk` says.
  bool chooses_transmittance = false;
  /// Casts shadow rays that bring little by Russian roulette (ShadowGuide); else all are cast.
  bool shadow_roulette = true;
  /// Gives pixels the shares of the samples that a pilot asks for (sample_plan.h): `samples` is
  /// their mean over all pixels then.
  bool adaptive = false;
  /// Finds the light of lights in or near media along lines, whose variance has an end
  /// (NearLights); else at scatterings alone.
  bool near_light_lines = true;
  /// Splits paths towards a light that outshines others, like the sun, where phase functions have
  /// lobes (LobeBranch).
  bool lobe_splitting = true;
  /// Draws lamps for scatterings in spheres of glass (GlassSpheres); else paths find their light by
  /// chance.
  bool light_through_glass = true;
  /// Leaves out light from outside that is seen without a scattering: pictures of what is in the
  /// scene alone, premultiplied by alpha.
  bool transparent = false;
  /// What the film records; path layers cost time, and all cost memory.
  LayerSet layers = LayerSet::standard();
  /// Channels of spectral radiance, in the light's own units (docs/scenes.md); recorded only where
  /// wavelengths are rendered.
  WavelengthBuckets buckets = {};
  /// Renders a part alone, whose pixels are those of the whole picture.
  std::optional<Crop> crop = {};
  /// Tells the time [s] since any moment, and is asked from any thread; empty: the system's steady
  /// clock. A test can count time by it, whatever the machine does.
  std::function<double()> clock = {};
  /// Called between passes, by the thread that renders, with what there is.
  std::function<void(const Film&)> on_pass = {};
  /// A picture to go on with, with the settings that it was begun with; it is moved from.
  std::shared_ptr<RenderedBefore> before = {};
  /// Called every so many seconds, by any thread, and has to be quick: others soon wait for it.
  CheckpointFunction on_checkpoint = {};
  double checkpoint_seconds = 60;
  /// Samples in flight per thread, of a path each, or one for each channel; the picture does not
  /// depend on it.
  std::size_t batch = kPathsInFlight;
  WalkSettings walk;  ///< Its origin is that of the scene.
};

/// What is done so far.
struct RenderProgress {
  double samples_done = 0;   ///< Samples of each pixel, on average.
  double samples_total = 0;  ///< 0: as many as the time allows.
  double seconds = 0;
};

/// A picture and how it came about.
struct RenderResult {
  Film film;
  PathCounts counts = {};  ///< Counts, those before included where a picture was gone on with.
  /// Samples of the pixel with the fewest, and with the most: the same, unless a pass was broken
  /// off.
  uint32_t samples = 0, most_samples = 0;
  std::size_t pixels_without_samples = 0;  ///< These are 0 in every channel of the picture.
  /// These too, as their share of the rounds comes to no sample: a film of part of the rounds is
  /// whole all the same.
  std::size_t pixels_between = 0;
  double seconds = 0;
  bool interrupted = false;
};

/// Called now and then, by one thread at a time. False ends the rendering soon: a first pass if it
/// isn't complete within a second, others at once.
using ProgressFunction = std::function<bool(const RenderProgress&)>;

/// The tracker for a scene where nobody names one. A path for each channel has less variance in
/// clouds of colour, one path for all costs less where surfaces take most of the time.
std::string standard_tracker(const PathScene& scene);

/// Renders a scene. The picture depends on scene, colour mode, walk settings and sample count
/// alone.
///
/// Media whose extinction is grey are traced with one path for all channels, and so are others by
/// trackers that carry several; else each channel of every sample has a path.
///
/// Where a pass is broken off, jobs that are not finished are dropped whole, so that a sample is
/// the same as in any other picture. How many samples a pixel has then depends on the time that
/// its paths took; dropping those unfinished, rather than waiting for them, keeps the bias of the
/// mean small [Glynn90]. A pixel without samples has no mean.
/// @param settings the origin of its walk is that of the scene
/// @throws Error for methods that do not exist or whose weights would grow at every scattering
///   (weight_growth.h), and (an internal error) if a sample is not finite
RenderResult render_scene(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                          const ProgressFunction& progress = {});

}  // namespace freepath
