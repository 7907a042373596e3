#include "apps/freepath/render_volumes.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>

#include "apps/freepath/console.h"
#include "apps/freepath/parse.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/media/phase/parse_phase_function.h"

namespace freepath::program {
namespace {

constexpr std::array kNegatives{Choice<NegativePolicy>{"error", NegativePolicy::kError},
                                Choice<NegativePolicy>{"clamp", NegativePolicy::kClamp}};
constexpr std::array kInvalids{Choice<InvalidPolicy>{"error", InvalidPolicy::kError},
                               Choice<InvalidPolicy>{"zero", InvalidPolicy::kZero}};

/// The value for a volume, null where none is given.
template <class Value>
const Value* value_for(std::size_t volume, std::size_t volumes, const std::vector<Value>& values,
                       std::string_view option) {
  if (values.empty()) return nullptr;
  if (values.size() == 1) return values.data();
  if (values.size() == volumes) return &values[volume];
  fail("{}: it is given {} for {}; give it once, or once for each volume in their order", option,
       counted(values.size(), "time"), counted(volumes, "volume"));
}

OpticalProperties read_optics(const VolumeOptions& options, std::size_t volume) {
  const std::size_t volumes = options.files.size();
  OpticalProperties optics;
  const auto number = [&](const std::vector<double>& values, const char* option, float& target) {
    const double* const value = value_for(volume, volumes, values, option);
    if (value != nullptr) target = static_cast<float>(*value);
  };
  const auto spectrum = [&](const std::vector<std::string>& values, const char* option,
                            auto& target) {
    const std::string* const value = value_for(volume, volumes, values, option);
    if (value != nullptr) target = parse_spectrum(*value, option);
  };
  if (!options.albedo.empty() && (!options.sigma_a.empty() || !options.sigma_s.empty())) {
    fail("--albedo and --sigma-a or --sigma-s say the same thing twice; give one or the other");
  }
  number(options.density_scale, "--density-scale", optics.density_scale);
  if (!options.g.empty() && !options.phase.empty()) {
    fail("--g and --phase say the same thing twice; give one or the other");
  }
  if (const double* const g = value_for(volume, volumes, options.g, "--g")) {
    optics.phase = read_option(
        "--g", [&] { return PhaseFunction::henyey_greenstein(static_cast<float>(*g)); });
  }
  if (const std::string* const text = value_for(volume, volumes, options.phase, "--phase")) {
    optics.phase = read_option("--phase", [&] { return parse_phase_function(*text); });
  }
  spectrum(options.albedo, "--albedo", optics.albedo);
  spectrum(options.sigma_a, "--sigma-a", optics.sigma_a);
  spectrum(options.sigma_s, "--sigma-s", optics.sigma_s);
  spectrum(options.radiance, "--le", optics.emission);
  const auto kelvins = [&](const std::vector<double>& values, const char* option, double& target) {
    if (const double* const value = value_for(volume, volumes, values, option)) target = *value;
  };
  kelvins(options.temperature_scale, "--temperature-scale", optics.temperature_scale);
  kelvins(options.temperature_offset, "--temperature-offset", optics.temperature_offset);
  return optics;
}

/// "density", or three names for R, G and B.
std::vector<LoadOptions> read_grids(const std::string& text, NegativePolicy negative,
                                    InvalidPolicy invalid) {
  std::vector<LoadOptions> grids;
  std::string_view rest = text;
  for (bool last = false; !last;) {
    const std::size_t comma = rest.find(',');
    last = comma == std::string_view::npos;
    grids.push_back({.selection = parse_grid_selection(rest.substr(0, comma)),
                     .negative = negative,
                     .invalid = invalid});
    if (!last) rest.remove_prefix(comma + 1);
  }
  if (grids.size() == 1) return grids;
  for (LoadOptions& grid : grids) {
    grid.scalar_only = true;
    const bool named = grid.selection.name || grid.selection.index;
    if (grids.size() == kChannels && named) continue;
    fail("--grid: '{}' is neither one grid nor three for the densities of R,G,B", text);
  }
  return grids;
}

void print_volume_warnings(const LoadedField& loaded) {
  for (const std::string& warning : loaded.warnings) {
    warn("{}", warning);
  }
}

/// Kelvins as densities make a picture as slow as it is wrong.
void warn_of_temperatures(const VolumePlan& plan, const LoadedField& loaded) {
  const std::string& name = loaded.field.name;
  if (!name.starts_with("temperature") && name != "heat" && name != "flame") return;
  warn("{}: grid '{}', up to {:.4g}, is rendered as a density; temperatures are --temperature {}",
       plan.file, name, loaded.maximum, name);
}

}  // namespace

InvalidPolicy read_invalid(const VolumeOptions& options) {
  return parse_choice(options.invalid, "--invalid", kInvalids);
}

std::vector<VolumePlan> plan_volumes(const VolumeOptions& options) {
  const NegativePolicy negative = parse_choice(options.negative, "--negative", kNegatives);
  std::vector<VolumePlan> plans;
  for (std::size_t volume = 0; volume < options.files.size(); ++volume) {
    const std::string* const grid =
        value_for(volume, options.files.size(), options.grids, "--grid");
    plans.push_back(
        {options.files[volume],
         read_grids(grid != nullptr ? *grid : std::string(), negative, read_invalid(options)),
         read_optics(options, volume),
         {}});
    const std::string* const temperature =
        value_for(volume, options.files.size(), options.temperature, "--temperature");
    if (temperature != nullptr && *temperature != "none") {
      plans.back().temperature = LoadOptions{.selection = parse_grid_selection(*temperature),
                                             .invalid = read_invalid(options),
                                             .scalar_only = true};
    }
  }
  if (options.temperature.empty() &&
      !(options.temperature_scale.empty() && options.temperature_offset.empty())) {
    fail(
        "--temperature-scale and --temperature-offset are of a grid of temperatures; name it by "
        "--temperature");
  }
  return plans;
}

std::vector<Volume> load_volumes(const std::vector<VolumePlan>& plans,
                                 std::vector<VolumeReport>& report) {
  std::vector<Volume> volumes, empty;
  for (const VolumePlan& plan : plans) {
    Volume volume{.densities = {}, .optics = plan.optics};
    bool holds_something = false;
    report.push_back({plan.file, {}});
    for (const LoadOptions& grid : plan.grids) {
      for (LoadedField& loaded : load_fields(plan.file, grid)) {
        print_volume_warnings(loaded);
        holds_something |= !loaded.empty();
        report.back().grids.push_back(loaded.field.name);
        warn_of_temperatures(plan, loaded);
        volume.densities.push_back(std::move(loaded.field));
      }
    }
    if (plan.temperature) {
      LoadedField loaded = load_field(plan.file, *plan.temperature);
      print_volume_warnings(loaded);
      report.back().grids.push_back(loaded.field.name);
      volume.temperature = std::make_shared<const Field>(std::move(loaded.field));
    }
    (holds_something ? volumes : empty).push_back(std::move(volume));
  }
  return volumes.empty() ? std::move(empty) : std::move(volumes);
}

void add_volume_options(CLI::App& command, VolumeOptions& o) {
  const auto add = [&](const char* name, auto& values, const char* text) {
    return command.add_option(name, values, text)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group("Medium (once for all volumes, or once for each)");
  };
  add("--grid", o.grids,
      "Grid to render, by name or number [density]; three, separated by commas, are the densities "
      "of R, G and B, as are the channels of a grid of vectors");
  add("--density-scale", o.density_scale, "Multiplies the densities [1]")->check(kFiniteNumber);
  add("--albedo", o.albedo, "Single-scattering albedo, V or R,G,B [0.999]");
  add("--sigma-a", o.sigma_a, "Absorption per unit of density, V or R,G,B [1/unit]");
  add("--sigma-s", o.sigma_s, "Scattering per unit of density, V or R,G,B [1/unit]");
  add("--g", o.g, "Mean cosine of the Henyey-Greenstein phase function [0]")->check(kFiniteNumber);
  add("--phase", o.phase,
      "Phase function: isotropic, henyey-greenstein:g=0.8, rayleigh, draine:g=0.5,alpha=1 (with "
      "that alpha Cornette and Shanks'), "
      "droplets:diameter=20 [um], tabulated:FILE of angles and values, or a mixture, "
      "0.7*droplets:diameter=10+0.3*rayleigh [isotropic]");
  add("--le", o.radiance,
      "Emitted radiance L_e, V or R,G,B; the source is sigma_a L_e [0]; with --temperature what "
      "multiplies the black body's [1]");
  add("--temperature", o.temperature,
      "Grid of temperatures, by name or number: the volume glows as black bodies of them, as far "
      "as "
      "it absorbs; none for a volume without");
  add("--temperature-scale", o.temperature_scale, "Kelvins in a unit of that grid [1]")
      ->check(kFiniteNumber);
  add("--temperature-offset", o.temperature_offset, "Value of that grid at 0 K [0]")
      ->check(kFiniteNumber);
  command.add_option("--negative", o.negative, "Negative densities: error or clamp")
      ->capture_default_str()
      ->group("Medium");
  command
      .add_option("--invalid", o.invalid,
                  "Voxels and pixels that are NaN or infinite, of scenes too: error or zero")
      ->capture_default_str()
      ->group("Medium");
}

}  // namespace freepath::program
