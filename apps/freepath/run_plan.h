#pragma once
/// @file Options on how a rendering runs: which part of it, from what, until when, and what it
/// tells.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/freepath/progress_bar.h"
#include "freepath/base/input_file.h"
#include "freepath/paths/picture_identity.h"
#include "freepath/paths/renderer.h"
#include "freepath/sensors/tile.h"

namespace freepath::program {

/// The options as they were typed.
struct RunPlanOptions {
  std::string samples, tiles, checkpoint, resume;
  double every = RenderSettings{}.checkpoint_seconds;
  double noise = 0;
  std::string progress = "auto", seed_mode = "frame";
  bool skip_existing = false;
};

/// What they mean.
struct RunPlan {
  std::optional<SampleRange> samples;
  std::optional<Tile> tile;
  std::string checkpoint, resume;  ///< May have a place for a frame's number, or be empty.
  double every = 0;                ///< [s]
  std::optional<double> noise;
  bool limits_samples = false;  ///< Whether --spp is given: the most that --noise may take.
  ProgressForm progress = ProgressForm::kAutomatic;
  bool seed_per_frame = true;
  bool skip_existing = false;
  /// The options that were given and that the picture depends on.
  std::vector<std::pair<std::string, std::string>> options;
};

void add_run_plan_options(CLI::App& command, RunPlanOptions& options);

/// @throws Error naming the option, and for options that exclude each other
RunPlan read_run_plan(const CLI::App& command, const RunPlanOptions& options);

/// What a picture depends on: options, methods and the contents of the files that were read for it.
/// @param color as the program spells it
PictureIdentity picture_identity(const RunPlan& plan, const RenderSettings& settings,
                                 std::string_view color, const InputFileLog& files);

}  // namespace freepath::program
