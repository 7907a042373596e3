#pragma once
/// @file Volumes and scenes that methods are compared on.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/freepath/picture_options.h"
#include "freepath/evaluation/subject.h"
#include "freepath/media/medium.h"

namespace freepath::program {

/// A subject, and what there is to know of it.
struct LoadedSubject {
  Subject subject;
  RenderSettings settings;  ///< All but samples, time and methods.
  /// Of bare volumes: their medium, for methods to be chosen by.
  std::shared_ptr<const Medium> medium;
  std::string automatic_tracker;  ///< What `auto` stands for here,
  std::string reason;             ///< and why, in one line.
};

/// Loads volumes or a scene as the options say, and prints its warnings on standard error.
/// @throws Error as the loaders and builders, naming the option or file
LoadedSubject load_subject(const CLI::App& command, const PictureOptions& options);

/// The medium of the volumes of the options, with super-voxels of another edge [voxels].
Medium load_medium(const PictureOptions& options, int super_voxel);

}  // namespace freepath::program
