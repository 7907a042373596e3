#pragma once
/// @file How many samples a time allows.

#include <cstdint>

#include "freepath/paths/renderer.h"

namespace freepath {

/// Time limits below this are kept by the clock alone [s]: a pilot would take too much of them.
inline constexpr double kShortestPlannedTime = 20;

/// What a pilot has found.
struct TimePlan {
  uint32_t samples = 0;  ///< Samples of each pixel that the time allows; 0: not known.
  double seconds = 0;    ///< Time that the pilot took [s].
};

/// The number of samples that a picture can have in its time limit, by a pilot: a picture of the
/// same scene by another seed, which takes a twentieth of the time, or the second or so that a pass
/// takes which is broken off. The picture's samples have no part in the decision: where a clock
/// decides while they are made, dear samples are fewer than they should be, and the mean is biased
/// [Glynn90].
///
/// Not known where the limit is below kShortestPlannedTime, or the pilot comes to no sample of
/// every pixel.
/// @param settings of the picture; its time limit counts from now, its samples are the most
/// @throws Error as render_scene
TimePlan plan_time(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                   const ProgressFunction& progress = {});

}  // namespace freepath
