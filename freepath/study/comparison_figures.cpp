#include "freepath/study/comparison_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freepath {
namespace {

WalkStatistics both(const ComparisonRun& run) {
  WalkStatistics sum = run.free_paths;
  sum.merge(run.shadow_rays);
  return sum;
}

/// A count over the samples of a run: with a tracker that takes a path for each channel, all three
/// paths of a sample count as one.
std::function<double(const ComparisonRun&)> each_path(uint64_t WalkStatistics::*count) {
  return [count](const ComparisonRun& run) {
    const uint64_t paths = std::max<uint64_t>(run.camera_samples, 1);
    return static_cast<double>(both(run).*count) / static_cast<double>(paths);
  };
}

double nanoseconds_per_lookup(const ComparisonRun& run) {
  const uint64_t lookups = both(run).lookups;
  return lookups > 0 ? 1e9 * run.cpu_seconds / static_cast<double>(lookups)
                     : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

const std::vector<ComparisonFigure>& comparison_figures() {
  static const std::vector<ComparisonFigure> kFigures = {
      {"mse", "MSE", "mean squared error over pixels and channels, less the reference's variance",
       [](const ComparisonRun& run) { return run.error.mse; }},
      {"relative_mse", "rel. MSE", "the same, each pixel's over reference² + 0.01",
       [](const ComparisonRun& run) { return run.error.relative_mse; }},
      {"flip", "FLIP", "difference that people see when they flip between picture and reference",
       [](const ComparisonRun& run) { return run.flip; }},
      {"variance_r", "variance R", "mean variance of a pixel's red, by its own samples",
       [](const ComparisonRun& run) { return run.variance[0]; }},
      {"variance_g", "G", "mean variance of a pixel's green",
       [](const ComparisonRun& run) { return run.variance[1]; }},
      {"variance_b", "B", "mean variance of a pixel's blue",
       [](const ComparisonRun& run) { return run.variance[2]; }},
      {"samples", "samples", "of each pixel, in one run",
       [](const ComparisonRun& run) { return static_cast<double>(run.samples); }},
      {"seconds", "wall [s]", "time of one run",
       [](const ComparisonRun& run) { return run.seconds; }},
      {"cpu_seconds", "CPU [s]", "time that all threads worked in one run",
       [](const ComparisonRun& run) { return run.cpu_seconds; }},
      {"lookups_per_path", "look-ups",
       "densities read for a path of all channels, with its shadow rays",
       each_path(&WalkStatistics::lookups)},
      {"tentative_collisions_per_path", "tentative", "tentative collisions in a path",
       each_path(&WalkStatistics::tentative_collisions)},
      {"null_collisions_per_path", "null", "null collisions in a path",
       each_path(&WalkStatistics::null_collisions)},
      {"control_collisions_per_path", "control",
       "collisions in a path that were decided without a look-up",
       each_path(&WalkStatistics::control_collisions)},
      {"nanoseconds_per_lookup", "ns/look-up", "CPU time over look-ups, all else included",
       nanoseconds_per_lookup},
      {"largest_weight", "largest weight", "largest |weight| after any collision",
       [](const ComparisonRun& run) {
         return double{std::max(run.free_paths.largest_weight, run.shadow_rays.largest_weight)};
       }},
  };
  return kFigures;
}

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const double magnitude = std::floor(std::log10(std::abs(value)));
  if (magnitude < -4 || magnitude > 6) return fmt::format("{:.{}e}", value, digits - 1);
  const int decimals = std::max(0, digits - 1 - static_cast<int>(magnitude));
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace freepath
