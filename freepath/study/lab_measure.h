#pragma once
/// @file One tracker in one setting of the laboratory: what its free paths are, and what they cost.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "freepath/study/lab_curves.h"
#include "freepath/study/lab_settings.h"
#include "freepath/study/lab_statistics.h"
#include "freepath/tracking/statistics.h"
#include "freepath/tracking/walk_modes.h"

namespace freepath {

/// Bins along the ray, each a whole number of voxels.
inline constexpr int kLabBins = 64;
/// Bins of |weight|, ten a decade; those at the ends take what lies beyond.
inline constexpr int kLabWeightBins = 81;
inline constexpr int kLabWeightsPerDecade = 10;
/// Least weight of a bin; the exact powers of ten are in the middle of theirs.
double lab_weight_edge(int bin);

/// How to walk.
struct LabWalk {
  std::string tracker;  ///< "name:option=value", or "auto"
  Absorption absorption = Absorption::kWeighted;
  uint64_t seed = 0;
  uint64_t paths = 0;  ///< Paths of each channel that takes its own.
};

/// What was seen in a channel.
struct LabChannel {
  LabCheck transmittance;         ///< The weight that escapes.
  LabCheck free_path;             ///< The weight that scatters, by where it does.
  LabCheck radiance;              ///< What all paths bring back.
  double variance = 0;            ///< Variance of the radiance of one path.
  std::vector<double> ended;      ///< Density of real collisions in each bin, unweighted [1/m].
  std::vector<double> scattered;  ///< Density × weight of scatterings in each bin [1/m].
  std::vector<double> error;      ///< Standard error of it [1/m].
  std::vector<double> exact;      ///< Mean of mu_s T over each bin [1/m].
  std::vector<double> weights;    ///< Share of the flights that end with a weight in each bin.
  double negative = 0;            ///< Share of the flights that end with a negative weight.
};

/// A tracker's figures. "A path" is one path for all channels, or one for each, together.
struct LabMeasurement {
  std::string tracker;
  std::string stands_for;  ///< What `auto` has chosen; empty otherwise.
  bool biased = false;     ///< Whether it says so itself.
  bool shared = true;      ///< Whether one path carries all channels.
  std::string refusal;     ///< Why it does not apply; everything below is then empty.
  uint64_t paths = 0;
  std::vector<LabChannel> channels;
  WalkStatistics statistics;
  double lookups = 0;             ///< A path.
  double null_collisions = 0;     ///< A path.
  double control_collisions = 0;  ///< A path.
  double variance = 0;            ///< Variance of the radiance of a path, mean over channels.
  double seconds = 0;             ///< A path, on one thread; differs from run to run.
};

/// Asked now and then; false is a wish to stop.
using LabGoesOn = std::function<bool()>;

/// Walks a setting's ray. The result but for its seconds depends on setting, tracker, absorption,
/// seed and number of paths alone.
/// @throws Error for a tracker that does not exist, and where `goes_on` says no
LabMeasurement measure_tracker(const LabSetting& setting, const LabCurves& curves,
                               const LabWalk& walk, const LabGoesOn& goes_on = {});

/// What `auto` stands for in a setting; any other tracker for itself.
std::string lab_tracker(const LabSetting& setting, const std::string& tracker);

}  // namespace freepath
