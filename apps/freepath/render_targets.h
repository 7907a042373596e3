#pragma once
/// @file Volumes and scenes that methods are compared on.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/freepath/parse.h"
#include "apps/freepath/picture_options.h"
#include "freepath/study/render_target.h"

namespace freepath::program {

/// A target, and what there is to know of it.
struct LoadedTarget {
  RenderTarget target;
  RenderSettings settings;  ///< All but samples, time and methods.
  PictureSize film;         ///< The whole picture's size, of which a scene may crop a part.
  /// Of bare volumes: their medium, for methods to be chosen by.
  std::optional<VolumeMedium> volumes;
  std::string automatic_tracker;  ///< What `auto` stands for here,
  std::string reason;             ///< and why, in one line.
};

/// Loads volumes or a scene as the options say, and prints its warnings on standard error.
/// @param size in place of that of the options or of the scene
/// @throws Error as the loaders and builders, naming the option or file
LoadedTarget load_target(const CLI::App& command, const PictureOptions& options,
                         const std::optional<PictureSize>& size = {});

/// The same of volumes, with another medium and in another size. It has no digest.
LoadedTarget target_of_medium(const PictureOptions& options, VolumeMedium volumes,
                              const PictureSize& size);

}  // namespace freepath::program
