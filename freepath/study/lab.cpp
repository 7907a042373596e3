#include "freepath/study/lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/threads.h"
#include "freepath/study/interval.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"

namespace freepath {
namespace {

constexpr double kControls[] = {0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2};
constexpr double kRateScales[] = {0.5, 0.6, 0.7, 0.85, 1, 1.25, 1.5, 2, 3, 4};
/// A point of a sweep takes this share of the paths.
constexpr uint64_t kSweepShare = 4;
/// Evolutions hold all weights of so many paths at most.
constexpr uint64_t kEvolvedPaths = 16'384;
/// Regular tracking visits every voxel, and its weights are tame.
constexpr uint64_t kRegularShare = 16;
constexpr uint64_t kFewestPaths = 1024;

const MethodInfo& info_of(const Method& method) {
  const auto infos = tracker_infos();
  return *std::find_if(infos.begin(), infos.end(),
                       [&](const MethodInfo& info) { return info.name == method.name; });
}

/// Each tracker walks with random numbers of its own in each setting, so that their errors are
/// independent.
uint64_t seed_of(uint64_t seed, const LabSetting& setting, std::string_view tracker) {
  uint64_t hash = 0xCBF29CE484222325U;  // Fowler, Noll and Vo's
  for (const std::string_view text : {std::string_view(setting.name), tracker}) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  }
  return seed + hash;
}

/// A tracker with an option at a value; none where it has no such option.
std::optional<std::string> with_option(const std::string& tracker, std::string_view option,
                                       double value) {
  Method method = parse_method(tracker, tracker_infos());
  const MethodInfo& info = info_of(method);
  for (std::size_t i = 0; i < info.options.size(); ++i) {
    if (info.options[i].name != option) continue;
    method.options[i] = static_cast<float>(value);
    return to_string(method, tracker_infos());
  }
  return {};
}

/// Does the work piece by piece, and counts the pieces.
class Lab {
 public:
  Lab(const LabOptions& options, const LabProgress& progress)
      : options_(options), progress_(progress) {}

  LabResult run() {
    LabResult result;
    result.options = options_;
    for (LabSetting& setting : read_settings()) {
      LabCurves curves(setting);
      result.settings.push_back({std::move(setting), std::move(curves), {}, {}, {}, {}});
    }
    for (const LabFindings& findings : result.settings) total_ += pieces_of(findings.setting);
    for (LabFindings& findings : result.settings) {
      measure(findings);
      evolve(findings);
      sweep(findings, "control", kControls);
      sweep(findings, "rate-scale", kRateScales);
    }
    count_tests(result);
    return result;
  }

 private:
  std::vector<LabSetting> read_settings() const {
    if (options_.paths < 1) fail("there are no paths to walk");
    for (const std::string& tracker : options_.trackers) {
      parse_method(tracker, tracker_choices());
    }
    std::vector<std::string> names = options_.settings;
    if (names.empty()) {
      for (const LabSettingInfo& info : lab_setting_infos()) names.emplace_back(info.name);
    }
    std::vector<LabSetting> settings;
    settings.reserve(names.size());
    for (const std::string& name : names) settings.push_back(make_lab_setting(name));
    return settings;
  }

  std::vector<std::string> trackers_of(const LabSetting& setting) const {
    return options_.trackers.empty() ? lab_trackers(setting) : options_.trackers;
  }

  /// Trackers whose paths carry channels that differ.
  std::vector<std::string> chromatic_trackers_of(const LabSetting& setting) const {
    std::vector<std::string> trackers;
    if (setting.channels == 1) return trackers;
    for (const std::string& tracker : trackers_of(setting)) {
      const Method method = parse_method(lab_tracker(setting, tracker), tracker_infos());
      if (info_of(method).chromatic) trackers.push_back(tracker);
    }
    return trackers;
  }

  /// Trackers to sweep an option of, at its standard value where that is listed.
  std::vector<std::string> swept_trackers(const LabSetting& setting,
                                          std::string_view option) const {
    std::vector<std::string> swept;
    for (const std::string& tracker : trackers_of(setting)) {
      const auto standard = with_option(lab_tracker(setting, tracker), option, 1);
      if (!standard || std::find(swept.begin(), swept.end(), *standard) != swept.end()) continue;
      swept.push_back(*standard);
    }
    return swept;
  }

  double pieces_of(const LabSetting& setting) const {
    return static_cast<double>(
        trackers_of(setting).size() + 2 * chromatic_trackers_of(setting).size() +
        swept_trackers(setting, "control").size() * std::size(kControls) +
        swept_trackers(setting, "rate-scale").size() * std::size(kRateScales));
  }

  /// Tells what comes next.
  /// @throws Error where that is not wanted
  void begin(std::string_view doing) {
    doing_ = doing;
    if (!goes_on_()) fail("interrupted");
    done_ += 1;
  }

  LabWalk walk_of(const std::string& tracker, uint64_t seed, uint64_t paths) const {
    return {tracker, options_.absorption, seed, std::max(paths, kFewestPaths)};
  }

  void measure(LabFindings& findings) {
    for (const std::string& tracker : trackers_of(findings.setting)) {
      begin(fmt::format("{}: {}", findings.setting.name, tracker));
      const bool regular = tracker == "regular";
      const uint64_t paths = regular ? options_.paths / kRegularShare : options_.paths;
      findings.trackers.push_back(measure_tracker(
          findings.setting, findings.curves,
          walk_of(tracker, seed_of(options_.seed, findings.setting, tracker), paths), goes_on_));
    }
  }

  void evolve(LabFindings& findings) {
    for (const std::string& tracker : chromatic_trackers_of(findings.setting)) {
      const LabWalk walk = walk_of(tracker, seed_of(options_.seed, findings.setting, tracker),
                                   std::min(options_.paths, kEvolvedPaths));
      begin(fmt::format("{}: throughput of {}", findings.setting.name, tracker));
      findings.along_ray.push_back(
          throughput_along_ray(findings.setting, findings.curves, walk, goes_on_));
      begin(fmt::format("{}: throughput of {}", findings.setting.name, tracker));
      findings.scatterings.push_back(
          throughput_of_scatterings(findings.setting, findings.curves, walk, goes_on_));
    }
  }

  /// All points of a sweep share random numbers, so that their differences are those of the option.
  void sweep(LabFindings& findings, const std::string& option, std::span<const double> values) {
    for (const std::string& tracker : swept_trackers(findings.setting, option)) {
      LabSweep sweep{tracker, option, {}};
      for (const double value : values) {
        const std::string method = with_option(tracker, option, value).value_or(tracker);
        begin(fmt::format("{}: {}", findings.setting.name, method));
        const LabMeasurement measured =
            measure_tracker(findings.setting, findings.curves,
                            walk_of(method, options_.seed, options_.paths / kSweepShare), goes_on_);
        if (!measured.refusal.empty()) break;
        LabSweepPoint point{value, measured.lookups, measured.variance, measured.seconds};
        for (const LabChannel& channel : measured.channels) {
          point.heavy = point.heavy || channel.radiance.standing != LabStanding::kTested;
        }
        sweep.points.push_back(point);
      }
      if (!sweep.points.empty()) findings.sweeps.push_back(std::move(sweep));
    }
  }

  static void count_tests(LabResult& result) {
    for (const LabFindings& findings : result.settings) {
      for (const LabMeasurement& measurement : findings.trackers) {
        if (measurement.biased) continue;
        for (const LabCheck& check : checks_of(measurement)) {
          result.tests += check.standing == LabStanding::kTested ? 1 : 0;
        }
      }
    }
    result.level = level_of_each(kLabLevel, result.tests);
  }

  const LabOptions& options_;
  const LabProgress& progress_;
  double total_ = 0;
  double done_ = 0;
  std::string doing_;
  LabGoesOn goes_on_ = [this] { return !progress_ || progress_(done_ / total_, doing_); };
};

}  // namespace

std::vector<std::string> lab_trackers(const LabSetting& setting) {
  std::vector<std::string> trackers;
  for (const MethodInfo& info : tracker_infos()) {
    const std::string name(info.name);
    trackers.push_back(info.biased ? name + ":step=0.1" : name);
    const auto add = [&](const char* option) { trackers.push_back(name + ":" + option); };
    if (name == "weighted-delta") add("rate-scale=0.7");
    if (name == "weighted-decomposition") add("control=1.3");
    if (setting.channels == 1) continue;  // where the following do not differ
    if (name == "spectral") {
      add("collision-probability=max");
      add("collision-probability=average");
      add("collision-probability=history-max");
    }
    if (name == "spectral-decomposition") add("collision-probability=max");
  }
  return trackers;
}

std::vector<LabCheck> checks_of(const LabMeasurement& measurement) {
  std::vector<LabCheck> checks;
  for (const LabChannel& channel : measurement.channels) {
    checks.insert(checks.end(), {channel.transmittance, channel.free_path, channel.radiance});
  }
  return checks;
}

LabVerdict verdict_of(const LabMeasurement& measurement, double level) {
  if (!measurement.refusal.empty()) return LabVerdict::kRefuses;
  bool tested = false;
  for (const LabCheck& check : checks_of(measurement)) {
    if (check.standing != LabStanding::kTested) continue;
    if (check.p < level) return LabVerdict::kDiffers;
    tested = true;
  }
  return tested ? LabVerdict::kAgrees : LabVerdict::kUndecided;
}

LabResult run_lab(const LabOptions& options, const LabProgress& progress) {
  Threads threads(options.threads);
  return threads.execute([&] { return Lab(options, progress).run(); });
}

}  // namespace freepath
