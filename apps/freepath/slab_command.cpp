// freepath slab: reflectance and transmittance of plane-parallel layers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "freepath/base/error.h"
#include "freepath/render/slab.h"

namespace freepath::program {
namespace {

constexpr const char* kSlabFooter =
    R"(Light falls on the top of the first layer; all results are fractions of its flux, each with its
standard error. The layers have no lateral bounds, no surfaces (a refractive index of 1) and
Henyey-Greenstein scattering; paths through them take the same walk as a renderer's. --tau, --albedo
and --g are lists, from the top down; a single value of --albedo or --g is for all layers. The result
does not depend on --threads or --batch. Ctrl-C ends early, with the paths traced so far.

Methods take options after their name: weighted-delta:rate-scale=2

Examples:
  freepath slab --tau 2 --albedo 0.9 --g 0.75
  freepath slab --tau 0.25,0.25 --albedo 0.5,0.3 --g 0 --json
  freepath slab --tau inf --albedo 0.99 --diffuse          (white-sky albedo of a half-space)
  freepath slab --tau 1,inf --albedo 1,0.9 --g 0.85,0 --mu0 0.5 --paths 1e7
  freepath slab --tau 8 --albedo 0.8 --tracker weighted-delta:rate-scale=2 --absorption analog)";

/// The options as they were typed; read_* turn them into what the library takes.
struct SlabOptions {
  std::string tau, albedo = "1", g = "0";
  double mu0 = SlabSettings{}.mu0;
  bool diffuse = false;
  std::string paths = "1e6";
  std::string tracker = WalkSettings{}.tracker, absorption = "weighted", simd = "best";
  uint64_t seed = 0;
  int threads = 0;
  std::size_t batch = SlabSettings{}.batch;
  int super_voxel = 0;
  double bound_scale = 1;
  bool json = false;
};

/// "1,2,inf": infinity is a number here.
std::vector<double> read_taus(const std::string& text) {
  std::vector<double> taus;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string item = text.substr(begin, end - begin);
    const bool last = end == text.size();
    if (item != "inf") {
      taus.push_back(parse_numbers(item, "--tau")[0]);
    } else if (last) {
      taus.push_back(std::numeric_limits<double>::infinity());
    } else {
      fail("--tau: '{}' has inf before other layers; only the last layer can be a half-space",
           text);
    }
    begin = end + 1;
  }
  return taus;
}

/// A value for each layer.
std::vector<double> read_layer_values(const std::string& text, std::string_view option,
                                      std::size_t layers) {
  std::vector<double> values = parse_numbers(text, option);
  if (values.size() == 1) values.resize(layers, values[0]);
  if (values.size() != layers) {
    fail("{}: '{}' has {} values, but --tau has {}; give one for each layer, or one for all",
         option, text, values.size(), layers);
  }
  return values;
}

std::vector<SlabLayer> read_layers(const SlabOptions& options) {
  const std::vector<double> taus = read_taus(options.tau);
  const std::vector<double> albedos = read_layer_values(options.albedo, "--albedo", taus.size());
  const std::vector<double> gs = read_layer_values(options.g, "--g", taus.size());
  std::vector<SlabLayer> layers;
  for (std::size_t i = 0; i < taus.size(); ++i) layers.push_back({taus[i], albedos[i], gs[i]});
  return layers;
}

SlabSettings read_settings(const SlabOptions& options) {
  constexpr std::array kAbsorptions{Choice<Absorption>{"analog", Absorption::kAnalog},
                                    Choice<Absorption>{"weighted", Absorption::kWeighted}};
  SlabSettings settings;
  settings.mu0 = options.mu0;
  settings.diffuse = options.diffuse;
  settings.paths = parse_count(options.paths, "--paths", 1, 1e15);
  settings.threads = options.threads;
  settings.batch = options.batch;
  settings.super_voxel = options.super_voxel;
  settings.bound_scale = static_cast<float>(options.bound_scale);
  settings.walk.tracker = options.tracker;
  settings.walk.absorption = parse_choice(options.absorption, "--absorption", kAbsorptions);
  settings.walk.simd = parse_simd(options.simd);
  settings.walk.seed = options.seed;
  return settings;
}

void print_json(const SlabResult& result, const SlabSettings& settings) {
  const nlohmann::ordered_json json = {{"reflectance", result.reflectance.mean},
                                       {"reflectance_error", result.reflectance.error},
                                       {"transmittance", result.transmittance.mean},
                                       {"transmittance_error", result.transmittance.error},
                                       {"unscattered", result.unscattered.mean},
                                       {"unscattered_error", result.unscattered.error},
                                       {"paths", result.paths},
                                       {"tracker", result.tracker},
                                       {"seed", settings.walk.seed}};
  print_json_text(json);
}

void print_table(const SlabResult& result) {
  const auto row = [](const char* name, const SlabEstimate& estimate) {
    print("{:<15}{:>10.6f}  +- {:.6f}\n", name, estimate.mean, estimate.error);
  };
  row("reflectance", result.reflectance);
  row("transmittance", result.transmittance);
  row("  unscattered", result.unscattered);
  row("absorptance", {1 - result.total.mean, result.total.error});
  print("{} paths, tracker {}\n", result.paths, result.tracker);
  if (!result.tracker_reason.empty()) {
    print("auto: {}, since {}\n", result.tracker, result.tracker_reason);
  }
}

void run(const SlabOptions& options) {
  const std::vector<SlabLayer> layers = read_layers(options);
  const SlabSettings settings = read_settings(options);
  const ProgressBar bar(1, 0);
  const StopOnInterrupt stop;
  const auto start = std::chrono::steady_clock::now();
  double shown = 0;
  const SlabResult result = trace_slab(layers, settings, [&](uint64_t done, uint64_t total) {
    constexpr double kSecondsBetweenReports = 0.1;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds - shown >= kSecondsBetweenReports) {
      shown = seconds;
      bar.show({static_cast<double>(done), static_cast<double>(total), seconds});
    }
    return !stop.requested();
  });
  bar.finish();
  warn_if_biased(result.tracker);
  constexpr double kWorryingWeight = 10;
  if (result.largest_weight > kWorryingWeight) {
    warn(
        "weights of paths reach {:.3g}: under {} the variance may be "
        "infinite in these layers, and the standard errors too small",
        result.largest_weight, result.tracker);
  }
  if (options.json) {
    print_json(result, settings);
  } else {
    print_table(result);
  }
}

void add_layer_options(CLI::App& command, SlabOptions& o) {
  command
      .add_option("--tau", o.tau, "Optical thickness of each layer, T,T,...; the last may be inf")
      ->required();
  command.add_option("--albedo", o.albedo, "Single-scattering albedo of each layer, 0 to 1")
      ->capture_default_str();
  command.add_option("--g", o.g, "Mean cosine of each layer's phase function, -1 to 1")
      ->capture_default_str();
  CLI::Option* const mu0 =
      command.add_option("--mu0", o.mu0, "Cosine of incidence, 1 being along the normal")
          ->capture_default_str();
  command.add_flag("--diffuse", o.diffuse, "The same radiance from all directions above")
      ->excludes(mu0);
}

void add_method_options(CLI::App& command, SlabOptions& o) {
  std::string trackers;
  for (const MethodInfo& info : tracker_infos()) {
    trackers += (trackers.empty() ? "" : ", ") + std::string(info.name);
  }
  command.add_option("--tracker", o.tracker, "Free-path sampling: " + trackers + ", auto")
      ->capture_default_str();
  command.add_option("--absorption", o.absorption, "analog or weighted")->capture_default_str();
  command
      .add_option("--super-voxel", o.super_voxel,
                  "Edge of a super-voxel [voxels]: 4, 8, 16, 32, 64, or 0 for automatic")
      ->capture_default_str();
  command
      .add_option("--bound-scale", o.bound_scale,
                  "Looser bounds: under tight ones, 1, every collision in a layer is real")
      ->capture_default_str()
      ->check(kFiniteNumber);
  command.add_option("--simd", o.simd, "best, avx512, avx2, sse4 or one-lane")
      ->capture_default_str();
}

void add_run_options(CLI::App& command, SlabOptions& o) {
  command.add_option("--paths", o.paths, "Paths to trace")->capture_default_str();
  command.add_option("--seed", o.seed, "Seed of the random numbers")
      ->capture_default_str()
      ->check(  // CLI11 would wrap a negative number around
          [](const std::string& text) {
            return text.find('-') == std::string::npos
                       ? ""
                       : fmt::format("'{}' is negative; a seed is a whole number from 0 on", text);
          },
          "");
  command.add_option("--threads", o.threads, "Threads [all]")->check(CLI::Range(1, 1024));
  command.add_option("--batch", o.batch, "Paths in flight per thread; changes no result")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 20));
  command.add_flag("--json", o.json, "Print one JSON object instead of a table");
}

}  // namespace

void add_slab_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "slab", "Reflectance and transmittance of plane-parallel layers, with standard errors");
  const auto options = std::make_shared<SlabOptions>();
  add_layer_options(*command, *options);
  add_method_options(*command, *options);
  add_run_options(*command, *options);
  command->footer(kSlabFooter);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
