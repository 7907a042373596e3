#pragma once
/// @file The picture that others are measured against.

#include <cstdint>
#include <string>

#include "freepath/study/pixel_estimates.h"
#include "freepath/study/render_target.h"

namespace freepath {

/// Where a reference comes from.
struct ReferencePlan {
  std::string file;      ///< An image; empty: it is made.
  double time = 15;      ///< [s] For one that is made; 0: unlimited.
  uint32_t samples = 0;  ///< Samples of each of its pixels; 0: as many as the time allows.
  /// Folder where those that are made are kept and found again; empty: they are not.
  std::string cache;
};

struct Reference {
  PixelEstimates estimates;
  bool variance_known = true;
  std::string origin = {};  ///< One line for people: how it was made, or where it was found.
};

/// The folder for references in the user's cache: $XDG_CACHE_HOME/freepath/references, or below
/// ~/.cache; empty where there is neither.
std::string standard_reference_cache();

/// Reads, finds or makes the reference of a target.
/// @param configuration what to make it with; of its interpolation that alone matters here whose
///   field the reference shows
/// @param settings of the rendering; samples, time and methods are those of the plan
/// @throws Error for a file of another size or that can't be read; as RenderTarget::render
Reference get_reference(const RenderTarget& target, const ReferencePlan& plan,
                        const Configuration& configuration, RenderSettings settings,
                        const ProgressFunction& progress);

}  // namespace freepath
