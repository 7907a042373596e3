#pragma once
/// @file The laboratory: all trackers in all settings, side by side.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/study/lab_curves.h"
#include "freepath/study/lab_measure.h"
#include "freepath/study/lab_settings.h"
#include "freepath/study/lab_throughput.h"

namespace freepath {

/// What to do.
struct LabOptions {
  std::vector<std::string> settings;  ///< Empty: all.
  std::vector<std::string> trackers;  ///< Empty: lab_trackers() of each setting.
  uint64_t paths = 400'000;           ///< Paths of each tracker; sweeps and evolutions take fewer.
  uint64_t seed = 0;
  int threads = 0;  ///< 0: as many as the machine has; changes no result.
  Absorption absorption = Absorption::kWeighted;
};

/// The trackers of the registry, and the options that the paper compares. Ray marching takes steps
/// so long that its bias shows.
std::vector<std::string> lab_trackers(const LabSetting& setting);

/// What a tracker costs with an option at a value.
struct LabSweepPoint {
  double value = 0;
  double lookups = 0;   ///< A path.
  double variance = 0;  ///< Of the radiance of a path, mean over channels.
  double seconds = 0;   ///< A path, on one thread.
  bool heavy = false;   ///< Weights spread so widely that the variance is a guess, most often low.
};
struct LabSweep {
  std::string tracker;
  std::string option;  ///< "control" or "rate-scale"
  std::vector<LabSweepPoint> points;
};

/// All that was found out in a setting.
struct LabFindings {
  LabSetting setting;
  LabCurves curves;
  std::vector<LabMeasurement> trackers;
  std::vector<LabThroughput> along_ray, scatterings;  ///< Where channels differ.
  std::vector<LabSweep> sweeps;
};

struct LabResult {
  LabOptions options;
  std::vector<LabFindings> settings;
  std::size_t tests = 0;  ///< Comparisons of unbiased trackers that count.
  double level = 0;       ///< Level of each, so that the family's is kLabLevel.
};

inline constexpr double kLabLevel = 1e-3;

enum class LabVerdict {
  kRefuses,    ///< The tracker does not apply.
  kAgrees,     ///< No comparison that counts is off.
  kDiffers,    ///< One of them differs.
  kUndecided,  ///< None counts: the weights spread too widely.
};
LabVerdict verdict_of(const LabMeasurement& measurement, double level);

/// The comparisons of a measurement, three a channel.
std::vector<LabCheck> checks_of(const LabMeasurement& measurement);

/// Called between pieces of work, by one thread; false ends the laboratory.
/// @param share of the work that is done
/// @param doing what comes next
using LabProgress = std::function<bool(double share, std::string_view doing)>;

/// @throws Error for settings and trackers that do not exist, no paths, and where `progress` says
/// no
LabResult run_lab(const LabOptions& options, const LabProgress& progress = {});

}  // namespace freepath
