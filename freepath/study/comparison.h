#pragma once
/// @file Estimators measured against each other on one picture.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/study/errors.h"
#include "freepath/study/interval.h"
#include "freepath/study/pixel_estimates.h"
#include "freepath/study/reference.h"
#include "freepath/study/render_target.h"

namespace freepath {

/// What to run. Of the settings that all runs share, methods, samples, time and layers are those of
/// the runs.
struct ComparisonSettings {
  std::vector<Configuration> configurations;
  /// Time of a configuration in all, shared evenly by its repeats: seconds, samples of each pixel,
  /// or both, whichever ends first. 0: unlimited.
  double time = 10;
  uint32_t samples = 0;
  /// Runs methods that refuse stochastic interpolation with trilinear one, whose field is the same.
  bool may_interpolate = false;
  int repeats = 5;  ///< Independent runs of each configuration.
  /// Repeats to run, a part that merge_rounds() puts together with others: from first_round to
  /// before end_round, 0: to the last.
  int first_round = 0, end_round = 0;
  uint64_t seed = 0;    ///< Seed of all runs; each gets one of its own.
  double level = 1e-3;  ///< Probability that any of all bias tests raises a false alarm.
  RenderSettings render;
  ReferencePlan reference;
  /// References that references_of() has returned; empty: they are made by the plan.
  std::vector<Reference> references = {};
};

/// Error of a run as it went on.
struct ConvergencePoint {
  uint32_t samples = 0;  ///< Samples of each pixel.
  double seconds = 0;
  double mse = 0;
};

/// What one run did.
struct ComparisonRun {
  double seconds = 0;      ///< Time by the wall's clock.
  double cpu_seconds = 0;  ///< Time of all threads of the process.
  uint32_t samples = 0;    ///< Samples of the pixel that has the fewest.
  /// Samples of all pixels; one is what an estimate of all channels takes.
  uint64_t camera_samples = 0;
  uint64_t overflows = 0;  ///< RenderResult::overflows
  WalkStatistics free_paths, shadow_rays;
  SquaredError error;
  /// Variance of a pixel, over all pixels, by its own samples.
  std::array<double, 3> variance = {};
  double flip = 0;  ///< Mean over pixels.
  std::vector<ConvergencePoint> convergence;
};

/// What came of a configuration.
struct ConfigurationResult {
  Configuration configuration;
  std::string name;        ///< Name as short as tells it from the others.
  bool is_biased = false;  ///< Whether it says so itself.
  std::vector<ComparisonRun> runs;
  PixelEstimates first;     ///< Estimates of the first run.
  PixelEstimates together;  ///< Estimates of all runs.
  std::vector<float> flip;  ///< Error of each pixel of the first run.
  BiasTest bias;            ///< Test of all runs together.
  BiasVerdict verdict = BiasVerdict::kPasses;
  /// Over the baseline, by CPU seconds.
  std::optional<Interval> efficiency;

  /// Whether its pictures are unbiased as far as anyone can tell.
  bool is_trusted() const;
  bool has_overflows() const;
  /// Mean of a figure over the runs, with its interval.
  Interval over_runs(const std::function<double(const ComparisonRun&)>& figure) const;
  /// 1/(MSE · cost) over that of the baseline in the same round; nothing where an error is below
  /// the noise of the reference.
  std::optional<Interval> efficiency_over(
      const ConfigurationResult& baseline,
      const std::function<double(const ComparisonRun&)>& cost) const;
};

/// All that was measured.
struct Comparison {
  std::vector<ConfigurationResult> configurations;
  std::size_t baseline = 0;  ///< Which one efficiencies are relative to: the first with `delta`.
  std::vector<Reference> references;  ///< References, one for each field that interpolations make.
  std::vector<std::size_t> reference_of;  ///< Index of each configuration's reference.
  double level = 0;                       ///< ComparisonSettings::level
  double threshold = 0;                   ///< Largest |z| that chance explains.
  std::size_t tests = 0;                  ///< How many it is for.
  double seconds = 0;                     ///< Time in all, with the reference.

  const Reference& reference(std::size_t configuration) const {
    return references[reference_of[configuration]];
  }
};

/// What is going on.
struct ComparisonProgress {
  std::string step;     ///< "reference", or "delta, run 2 of 5".
  double fraction = 0;  ///< Part of all the work that is done.
  double seconds = 0;   ///< Since it began.
};

/// False ends it soon, with Interrupted.
using ComparisonProgressFunction = std::function<bool(const ComparisonProgress&)>;

/// Thrown where the caller wished to stop.
class Interrupted : public Error {
 public:
  using Error::Error;
};

/// Runs every configuration `repeats` times, one round after the other: a round runs all of them,
/// beginning with another one each time, so that what slows the machine down meets all alike.
/// Every run has a seed of its own, and so has the reference.
///
/// MSE is stated less the variance of the reference. The intervals take rounds for independent.
/// @throws Error for methods that do not exist or refuse the medium, before anything long is run,
///   naming them; as RenderTarget::render; Interrupted
Comparison compare(const RenderTarget& target, const ComparisonSettings& settings,
                   const ComparisonProgressFunction& progress = {});

/// References of a comparison alone, one for each field that its interpolations make.
/// @throws Error as compare()
std::vector<Reference> references_of(const RenderTarget& target, const ComparisonSettings& settings,
                                     const ComparisonProgressFunction& progress = {});

/// Comparison of all rounds, of others that have run some each, with the same settings and
/// references: that of one go, but for times, where each has run one round.
/// @param rounds at least one, in the order of their rounds
/// @throws Error where they are of other configurations
Comparison merge_rounds(std::vector<Comparison> rounds);

}  // namespace freepath
