#pragma once
/// @file How the throughput of paths that carry several channels evolves.

#include <string>
#include <vector>

#include "freepath/study/lab_measure.h"

namespace freepath {

/// The weights of paths in a channel at one stage of their way. Paths that have ended count 0 in
/// the mean, and not at all in the percentiles.
struct LabWeights {
  double mean = 0;
  double standard_error = 0;  ///< Standard error of the mean.
  double exact = 0;           ///< What the mean estimates; NaN where it is not known.
  LabStanding standing = LabStanding::kTested;
  double low = 0, median = 0, high = 0;  ///< |weight| that 5, 50 and 95 % of the paths stay below.
  double largest = 0;                    ///< |weight|
};

/// All paths at one stage.
struct LabStage {
  double at = 0;     ///< x [world], or the number of scatterings.
  double alive = 1;  ///< Share of the paths that have not ended.
  std::vector<LabWeights> channels;
};

struct LabThroughput {
  std::string tracker;
  uint64_t paths = 0;
  std::vector<LabStage> stages;
};

inline constexpr int kLabCuts = 32;         ///< Cuts of the ray, and its end.
inline constexpr int kLabScatterings = 32;  ///< Scatterings that are followed.

/// Weights along the ray: it is cut into stretches, and a flight that leaves one goes on with its
/// weight in the next, so that every cut sees the weights of the paths that fly on. Their mean is
/// the transmittance up to the cut, in each channel: sections 2 and 6 of docs/equations.md.
/// @throws Error as measure_tracker, and for a tracker that gives each channel a path of its own
LabThroughput throughput_along_ray(const LabSetting& setting, const LabCurves& curves,
                                   const LabWalk& walk, const LabGoesOn& goes_on = {});

/// Weights after each scattering of paths that are scattered straight on, with weighted absorption.
/// The setting is repeated end to end, so that none escapes. Where the albedo of a channel is the
/// same everywhere, the mean after n scatterings is its n-th power.
/// @throws Error as above
LabThroughput throughput_of_scatterings(const LabSetting& setting, const LabCurves& curves,
                                        const LabWalk& walk, const LabGoesOn& goes_on = {});

}  // namespace freepath
