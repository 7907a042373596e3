// freepath plan: what a picture will cost, and what to render it with.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/picture_options.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_targets.h"
#include "freepath/base/error.h"
#include "freepath/study/comparison_figures.h"
#include "freepath/study/plan.h"
#include "freepath/transport/auto_tracker.h"

namespace freepath::program {
namespace {

constexpr const char* kPlanFooter =
    R"(Renders a small picture of the volume or scene with every tracker that applies, some tenths of a
second each, and predicts what the whole picture takes on this machine: look-ups of a path, and the
time to a noise. Noise is the standard error of a pixel, root of the mean square over the picture,
over the picture's mean; 0.01 is a clean picture of a cloud. Of volumes, sizes of super-voxels are
tried as well. Nothing is written.

Examples:
  freepath plan cloud.vdb
  freepath plan cloud.vdb --size 1920x1080 --albedo 0.999 --noise 0.02
  freepath plan scene.pbrt --json)";

/// Pixels of a pilot's picture: few enough for many samples of each, from which variance is known.
constexpr double kPilotPixels = 64.0 * 36;

struct PlanOptions {
  PictureOptions picture;
  std::string transmittance = "ratio", interpolation = "stochastic";
  double noise = 0.01;
  double time = PilotSettings{}.time;
  bool json = false;
};

/// A tracker, or an edge of super-voxels, and what it would take.
struct PlanTable {
  std::vector<PilotResult> results;
  std::optional<std::size_t> best;
};

struct PicturePlan {
  std::string automatic, reason;
  PlanTable trackers;
  /// Of volumes.
  std::vector<int> edges;
  PlanTable super_voxels;
  int chosen_edge = 0;
  std::size_t super_voxel_count = 0;
  double pixel_ratio = 1;  ///< Of the whole picture to the pilot's.
};

/// A size of the same shape with fewer pixels.
PictureSize pilot_size(const PictureSize& whole) {
  const double pixels = static_cast<double>(whole.width) * whole.height;
  const double scale = std::min(1.0, std::sqrt(kPilotPixels / pixels));
  return {std::max(1, static_cast<int>(std::lround(whole.width * scale))),
          std::max(1, static_cast<int>(std::lround(whole.height * scale)))};
}

std::vector<PilotCandidate> tracker_candidates(const PlanOptions& options) {
  std::vector<PilotCandidate> candidates;
  for (const MethodInfo& info : tracker_infos()) {
    if (info.biased) continue;
    PilotCandidate candidate;
    candidate.name = std::string(info.name);
    candidate.configuration.tracker = candidate.name;
    candidate.configuration.transmittance =
        read_method(options.transmittance, "--transmittance", transmittance_infos());
    candidate.configuration.interpolation = read_interpolation(options.interpolation);
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

/// A line with the fraction that is done, on a terminal.
class PilotLine {
 public:
  PilotLine() = default;
  ~PilotLine() { clear_status(); }
  PilotLine(const PilotLine&) = delete;
  PilotLine& operator=(const PilotLine&) = delete;
  bool show(const char* what, double fraction) const {
    show_status(fmt::format("pilot of {}: {:3.0f} %", what, 100 * fraction));
    return !stop_.requested();
  }

 private:
  StopOnInterrupt stop_;
};

/// Tries sizes of super-voxels with the best tracker: each makes a medium of the same fields.
void plan_super_voxels(const PlanOptions& options, const PictureSize& size,
                       const VolumeMedium& volumes, const PilotSettings& settings,
                       const PilotLine& line, PicturePlan& plan) {
  const Medium& medium = *volumes.medium;
  plan.chosen_edge = medium.super_voxels().cell_size;
  plan.super_voxel_count = medium.super_voxel_count();
  std::vector<LoadedTarget> targets;
  for (const int edge : kSuperVoxelSizes) {
    try {
      auto other = std::make_shared<const Medium>(medium.components(), edge);
      targets.push_back(
          target_of_medium(options.picture, {std::move(other), volumes.temperatures}, size));
      plan.edges.push_back(edge);
    } catch (const Error&) {
      // Too many super-voxels of that size.
    }
  }
  if (targets.empty()) return;
  std::vector<PilotCandidate> candidates;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    PilotCandidate candidate = plan.trackers.results[*plan.trackers.best].candidate;
    candidate.name = fmt::format("{}", plan.edges[i]);
    candidate.target = &targets[i].target;
    candidates.push_back(std::move(candidate));
  }
  plan.super_voxels.results =
      run_pilots(targets.front().target, candidates, settings,
                 [&](double fraction) { return line.show("super-voxels", fraction); });
  plan.super_voxels.best = cheapest(plan.super_voxels.results);
  for (PilotResult& result : plan.super_voxels.results) result.candidate.target = nullptr;
}

PicturePlan make_plan(const CLI::App& command, const PlanOptions& options) {
  const LoadedTarget whole = load_target(command, options.picture);
  const PictureSize size = pilot_size(whole.film);
  const LoadedTarget loaded = whole.volumes
                                  ? target_of_medium(options.picture, *whole.volumes, size)
                                  : load_target(command, options.picture, size);
  PilotSettings settings;
  settings.time = options.time;
  settings.seed = options.picture.seed;
  settings.render = loaded.settings;
  PicturePlan plan;
  plan.automatic = loaded.automatic_tracker;
  plan.reason = loaded.reason;
  const auto pixels = [](const RenderTarget& target) {
    return static_cast<double>(target.width) * target.height;
  };
  plan.pixel_ratio = pixels(whole.target) / pixels(loaded.target);
  const PilotLine line;
  plan.trackers.results =
      run_pilots(loaded.target, tracker_candidates(options), settings,
                 [&](double fraction) { return line.show("trackers", fraction); });
  plan.trackers.best = cheapest(plan.trackers.results);
  if (whole.volumes && plan.trackers.best) {
    plan_super_voxels(options, size, *whole.volumes, settings, line, plan);
  }
  return plan;
}

std::string seconds_text(const PilotResult& result, const PicturePlan& plan, double noise) {
  const auto seconds = result.seconds_to(noise);
  if (!seconds) return "-";
  const double scale = plan.pixel_ratio;
  std::string text = number_text(scale * seconds->value, 3);
  if (seconds->low) {
    text += fmt::format(" ({} to {})", number_text(scale * *seconds->low, 2),
                        number_text(scale * *seconds->high, 2));
  }
  return text;
}

void print_table(const PlanTable& table, const PicturePlan& plan, double noise,
                 const char* first_column) {
  print("{:<26}{:>10}{:>12}{:>28}\n", first_column, "look-ups", "ns/path",
        fmt::format("seconds to a noise of {:g}", noise));
  for (std::size_t i = 0; i < table.results.size(); ++i) {
    const PilotResult& result = table.results[i];
    if (!result.refusal.empty()) {
      print("{:<26}does not apply: {}\n", result.candidate.name, result.refusal);
      continue;
    }
    print("{:<26}{:>10}{:>12}{:>28}{}\n", result.candidate.name,
          number_text(result.lookups_per_path, 3), number_text(result.nanoseconds_per_path, 3),
          seconds_text(result, plan, noise), table.best == i ? "  <- least" : "");
  }
}

void print_plan(const PicturePlan& plan, const PlanOptions& options) {
  print("auto: {}, since {}\n\n", plan.automatic, plan.reason);
  print_table(plan.trackers, plan, options.noise, "tracker");
  if (!plan.trackers.best) {
    const bool any = std::any_of(plan.trackers.results.begin(), plan.trackers.results.end(),
                                 [](const PilotResult& result) { return result.refusal.empty(); });
    if (any) {
      print("\nThe pilot saw no noise: any tracker will do.\n");
    } else {
      print("\nNo tracker applies with these methods.\n");
    }
    return;
  }
  const PilotResult& best = plan.trackers.results[*plan.trackers.best];
  if (plan.super_voxels.best) {
    print("\nsuper-voxels: edge of {} voxels, {} of them; with {}:\n", plan.chosen_edge,
          plan.super_voxel_count, best.candidate.name);
    print_table(plan.super_voxels, plan, options.noise, "edge [voxels]");
  }
  print("\nTake --tracker {} --transmittance {} --interpolation {}", best.candidate.name,
        best.candidate.configuration.transmittance,
        to_string(best.candidate.configuration.interpolation));
  if (plan.super_voxels.best) {
    const int edge = plan.edges[*plan.super_voxels.best];
    if (edge != plan.chosen_edge) print(" --super-voxel {}", edge);
  }
  print("\n");
}

nlohmann::ordered_json to_json(const PlanTable& table, const PicturePlan& plan, double noise) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PilotResult& result : table.results) {
    nlohmann::ordered_json entry = {{"name", result.candidate.name}};
    if (!result.refusal.empty()) {
      entry["refusal"] = result.refusal;
    } else {
      entry["lookups_per_path"] = result.lookups_per_path;
      entry["nanoseconds_per_path"] = result.nanoseconds_per_path;
      const auto seconds = result.seconds_to(noise);
      const auto scaled = [&](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(plan.pixel_ratio * *value) : nlohmann::ordered_json();
      };
      entry["seconds"] = seconds ? scaled(seconds->value) : nlohmann::ordered_json();
      entry["seconds_low"] = seconds ? scaled(seconds->low) : nlohmann::ordered_json();
      entry["seconds_high"] = seconds ? scaled(seconds->high) : nlohmann::ordered_json();
    }
    list.push_back(entry);
  }
  return list;
}

void print_json(const PicturePlan& plan, const PlanOptions& options) {
  const auto name_of_best = [](const PlanTable& table) {
    return table.best ? nlohmann::ordered_json(table.results[*table.best].candidate.name)
                      : nlohmann::ordered_json();
  };
  nlohmann::ordered_json json = {{"auto", plan.automatic},
                                 {"reason", plan.reason},
                                 {"noise", options.noise},
                                 {"best", name_of_best(plan.trackers)},
                                 {"trackers", to_json(plan.trackers, plan, options.noise)}};
  if (plan.super_voxels.best) {
    json["super_voxel"] = plan.chosen_edge;
    json["super_voxel_count"] = plan.super_voxel_count;
    json["best_super_voxel"] = plan.edges[*plan.super_voxels.best];
    json["super_voxels"] = to_json(plan.super_voxels, plan, options.noise);
  }
  print_json_text(json, 2);
}

void run(const CLI::App& command, const PlanOptions& options) {
  read_method(options.transmittance, "--transmittance", transmittance_infos());
  read_interpolation(options.interpolation);
  const PicturePlan plan = make_plan(command, options);
  if (options.json) {
    print_json(plan, options);
  } else {
    print_plan(plan, options);
  }
}

}  // namespace

void add_plan_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "plan", "Predict what a picture takes, and choose what to render it with");
  command->footer(kPlanFooter);
  const auto options = std::make_shared<PlanOptions>();
  command->add_option("--noise", options->noise, "Noise to predict the time to, relative")
      ->capture_default_str()
      ->check(kFiniteNumber & CLI::PositiveNumber);
  command->add_option("--pilot-time", options->time, "Seconds for each tracker and size")
      ->capture_default_str()
      ->check(kFiniteNumber & CLI::PositiveNumber);
  command
      ->add_option("--transmittance", options->transmittance,
                   "Transmittance of shadow rays: " + method_names(transmittance_infos()))
      ->capture_default_str();
  command->add_option("--interpolation", options->interpolation, "nearest, trilinear or stochastic")
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one JSON object");
  add_picture_options(*command, options->picture);
  command->callback([command, options] { run(*command, *options); });
}

}  // namespace freepath::program
