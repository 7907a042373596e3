#pragma once
/// @file A rendering from its scene to its files: parts, checkpoints, progress, what is left of it.

#include <string>
#include <utility>
#include <vector>

#include "apps/freepath/film_options.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_output.h"
#include "apps/freepath/run_plan.h"
#include "freepath/base/input_file.h"
#include "freepath/paths/path_scene.h"

namespace freepath::program {

/// A picture to render and what to write of it.
struct RenderJob {
  const PathScene& scene;
  ColorMode color = ColorMode::kRgb;
  const FilmPlan& film;
  const RunPlan& run;
  PictureLook look;
  std::vector<std::string> outputs;
  std::string stats;               ///< May be empty, as those that follow.
  std::string checkpoint, resume;  ///< Of this picture.
  const InputFileLog& files;       ///< That were read for the scene.
  /// What else the picture depends on: what was chosen by looking at other files.
  std::vector<std::pair<std::string, std::string>> facts = {};
};

/// What came of it.
struct RenderOutcome {
  RenderResult result;
  std::vector<std::string> written;  ///< Names of the pictures.
};

/// Renders until it is done or the stop is wished, and writes what there is.
/// @param report its settings but for layers, crop and samples of a part; gets them and the time
/// @throws Error as the renderer and the writers, for a film that is not one of this picture, and
///   for a picture of nothing
RenderOutcome render_and_write(const RenderJob& job, RenderReport& report,
                               const StopOnInterrupt& stop);

/// Whether every file that a picture is written to is there already.
bool is_rendered(const std::vector<std::string>& outputs, const std::string& stats);

}  // namespace freepath::program
