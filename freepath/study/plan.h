#pragma once
/// @file What a picture will cost, from short pilot runs.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "freepath/study/interval.h"
#include "freepath/study/process_time.h"
#include "freepath/study/render_target.h"

namespace freepath {

/// A way to render the target that a pilot tries.
struct PilotCandidate {
  std::string name;
  Configuration configuration;
  /// Another target than the plan's, such as one with other super-voxels; null: that.
  const RenderTarget* target = nullptr;
};

struct PilotSettings {
  double time =
      0.6;         ///< [s] Of each candidate, shared by its rounds; each takes a sample at least.
  int rounds = 3;  ///< At least 2: intervals come from them.
  uint64_t seed = 0;
  RenderSettings render;  ///< Settings but for samples, time and methods.
  /// Tells the work done so far, by which pictures are measured [s].
  std::function<double()> cpu_clock = process_cpu_seconds;
};

/// What a candidate did.
struct PilotResult {
  PilotCandidate candidate;
  std::string refusal;  ///< Why it can't render this; empty: it can.
  bool is_biased = false;
  double lookups_per_path = 0;      ///< Look-ups, those of shadow rays included.
  double nanoseconds_per_path = 0;  ///< CPU time.
  uint64_t overflows = 0;           ///< RenderResult::overflows
  /// Time · noise², which stays the same as an unbiased picture goes on [s]: CPU time
  /// over threads; noise is the standard error of a pixel, root of the mean square over pixels and
  /// channels, over the mean of the picture. Nothing where the pilot saw no noise.
  std::optional<Interval> cost;

  /// Time until the picture has this noise [s].
  std::optional<Interval> seconds_to(double noise) const;
};

/// Runs all candidates, round after round.
/// @return in their order
std::vector<PilotResult> run_pilots(const RenderTarget& target,
                                    const std::vector<PilotCandidate>& candidates,
                                    const PilotSettings& settings,
                                    const std::function<bool(double fraction)>& progress = {});

/// The candidate without bias that needs the least time; nothing where none has a cost.
std::optional<std::size_t> cheapest(const std::vector<PilotResult>& results);

}  // namespace freepath
