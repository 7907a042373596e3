// freepath compare: estimators measured against each other.

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/method_list.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/picture_options.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/render_targets.h"
#include "apps/freepath/report_folder.h"
#include "freepath/base/error.h"
#include "freepath/study/comparison_charts.h"
#include "freepath/study/comparison_figures.h"
#include "freepath/study/comparison_report.h"

namespace freepath::program {
namespace {

constexpr const char* kCompareFooter =
    R"(Renders a volume or a scene with every method given, in rounds, so that what slows the machine
down meets all alike, and reports errors against a reference, their efficiency 1/(MSE · CPU time)
relative to delta, the work they do, and whether they are biased. All combinations of --trackers,
--transmittance and --interpolation are run.

The folder of -o gets report.html, compare.json, compare.csv, the figures as .svg, the reference and
the pictures as .exr. The reference is made once, for --reference-time, and found again while
volumes, camera, lights and medium stay the same.

Exit status: 0; with --check, 1 if a method fails the bias test that does not say it is biased.

Examples:
  freepath compare cloud.vdb -o report
  freepath compare cloud.vdb -o report --trackers delta,decomposition,ray-marching:step=4 --time 10
  freepath compare haze.vdb -o report --sigma-s 1,2,4 --trackers delta,spectral,hero-wavelength
  freepath compare cloud.vdb -o report --trackers delta --transmittance delta,ratio,residual-ratio
  freepath compare scene.pbrt -o report --spp 64 --repeats 8 --reference reference.exr

Scenes are compared in rgb where --color says nothing else.)";

struct CompareOptions {
  PictureOptions picture;
  std::string folder;
  std::string trackers = kComparedTrackers;
  std::string transmittance = "ratio", interpolation = "stochastic";
  double time = ComparisonSettings{}.time;
  uint32_t samples = 0;
  int repeats = ComparisonSettings{}.repeats;
  ReferencePlan reference{.file = {}, .cache = standard_reference_cache()};
  uint32_t reference_samples = 0;
  double exposure = 0;
  bool check = false;
};

std::string date_text() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M UTC", &utc);
  return text;
}

/// All combinations of the methods and interpolations.
/// @param automatic what `auto` stands for
std::vector<Configuration> read_configurations(const CompareOptions& options,
                                               const std::string& automatic) {
  const auto list_of = [](std::string_view option, const std::string& text) {
    return read_option(option, [&] { return split_methods(text); });
  };
  std::vector<std::string> trackers = list_of("--trackers", options.trackers);
  for (std::string& tracker : trackers) tracker = read_tracker(tracker, "--trackers");
  std::vector<std::string> transmittances = list_of("--transmittance", options.transmittance);
  for (std::string& transmittance : transmittances) {
    transmittance = read_method(transmittance, "--transmittance", transmittance_infos());
  }
  std::vector<Interpolation> interpolations;
  for (const std::string& interpolation : list_of("--interpolation", options.interpolation)) {
    interpolations.push_back(read_interpolation(interpolation));
  }
  return all_configurations(trackers, transmittances, interpolations, automatic);
}

/// A line of a name, a bar and the time left, on a terminal.
class ComparisonBar {
 public:
  ComparisonBar() = default;
  ComparisonBar(const ComparisonBar&) = delete;
  ComparisonBar& operator=(const ComparisonBar&) = delete;
  /// Clears the line.
  ~ComparisonBar() { clear_status(); }
  void show(const ComparisonProgress& progress) {
    constexpr double kSecondsBetween = 0.1;
    if (progress.seconds < next_) return;
    next_ = progress.seconds + kSecondsBetween;
    const double left =
        progress.fraction > 0 ? progress.seconds * (1 - progress.fraction) / progress.fraction : 0;
    show_status(fmt::format("{:3.0f} %  {} left  {}", 100 * progress.fraction, clock_text(left),
                            progress.step));
  }

 private:
  double next_ = 0;
};

std::string_view verdict_text(BiasVerdict verdict) {
  return verdict == BiasVerdict::kFails ? "BIASED" : to_string(verdict);
}

void print_table(const Comparison& comparison) {
  constexpr const char* kRow = "{:<34}{:>11}{:>18}{:>11}{:>9}{:>9}{:>10}{:>10}  {}\n";
  print(kRow, "method", "efficiency", "95 % of it", "MSE", "FLIP", "wall [s]", "look-ups",
        "worst |z|", "bias test");
  for (const ConfigurationResult& result : comparison.configurations) {
    const auto figure = [&](std::string_view key) {
      for (const ComparisonFigure& candidate : comparison_figures()) {
        if (candidate.key == key) return number_text(result.over_runs(candidate.of_run).value, 3);
      }
      return std::string("-");
    };
    const auto& efficiency = result.efficiency;
    std::string range = "-";
    if (efficiency && efficiency->low) {
      range = number_text(*efficiency->low, 3) + " to " + number_text(*efficiency->high, 3);
    }
    print(kRow, result.name, efficiency ? number_text(efficiency->value, 3) : "-", range,
          figure("mse"), figure("flip"), figure("seconds"), figure("lookups_per_path"),
          number_text(result.bias.worst(), 3), verdict_text(result.verdict));
  }
  for (const std::string& finding : findings_of(comparison)) print("{}\n", finding);
}

/// File names have neither colons nor blanks.
std::string file_name_of(const std::string& method) {
  std::string name;
  for (const char c : method) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-';
    if (plain) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name;
}

void write_report(const Comparison& comparison, const ReportContext& context,
                  ReportFolder& folder) {
  for (std::size_t i = 0; i < comparison.references.size(); ++i) {
    folder.write(i == 0 ? "reference.exr" : "reference_2.exr",
                 to_image(comparison.references[i].estimates));
  }
  for (const ConfigurationResult& result : comparison.configurations) {
    folder.write(file_name_of(result.name) + ".exr", to_image(result.together));
  }
  for (const NamedFigure& figure : figures_of(comparison)) {
    folder.write(figure.file_name, figure.svg);
  }
  folder.write("compare.json", json_of(comparison, context));
  folder.write("compare.csv", csv_of(comparison));
  folder.write("report.html", to_html(page_of(comparison, context)));
}

ComparisonSettings read_settings(const CLI::App& command, const CompareOptions& options,
                                 const LoadedTarget& loaded) {
  ComparisonSettings settings;
  settings.configurations = read_configurations(options, loaded.automatic_tracker);
  settings.time = command.count("--spp") > 0 && command.count("--time") == 0 ? 0 : options.time;
  settings.may_interpolate = command.count("--interpolation") == 0;
  settings.samples = options.samples;
  settings.repeats = options.repeats;
  settings.seed = options.picture.seed;
  settings.render = loaded.settings;
  settings.reference = options.reference;
  settings.reference.samples = options.reference_samples;
  const bool by_samples =
      command.count("--reference-spp") > 0 && command.count("--reference-time") == 0;
  if (by_samples) settings.reference.time = 0;
  return settings;
}

void run(const CLI::App& command, const CompareOptions& options) {
  if (!options.reference.file.empty()) {
    for (const char* idle : {"--reference-time", "--reference-spp", "--cache"}) {
      if (command.count(idle) > 0)
        fail("{} is for references that are made, not for one given", idle);
    }
  }
  // What is wrong with the names of methods is said before anything is loaded.
  read_configurations(options, "delta");
  ReportFolder folder(options.folder);
  const LoadedTarget loaded = load_target(command, options.picture);
  const ComparisonSettings settings = read_settings(command, options, loaded);
  const Comparison comparison = [&] {
    const StopOnInterrupt stop;
    ComparisonBar bar;
    return compare(loaded.target, settings, [&](const ComparisonProgress& progress) {
      bar.show(progress);
      return !stop.requested();
    });
  }();
  const ReportContext context{.target = loaded.target.name,
                              .command = command_line(),
                              .machine = machine_text(settings.render),
                              .date = date_text(),
                              .exposure = options.exposure};
  write_report(comparison, context, folder);
  print_table(comparison);
  folder.finish();
  print("wrote {}\n", folder.file("report.html"));
  if (!options.check) return;
  for (const ConfigurationResult& result : comparison.configurations) {
    if (!result.is_biased && result.verdict == BiasVerdict::kFails) throw CLI::RuntimeError(1);
  }
}

void add_comparison_options(CLI::App& command, CompareOptions& o) {
  command.add_option("-o,--output", o.folder, "Folder for the report, made if it is missing")
      ->required();
  command
      .add_option("--trackers", o.trackers,
                  "Trackers, separated by commas: " + method_names(tracker_infos()) + ", auto")
      ->capture_default_str();
  command
      .add_option("--transmittance", o.transmittance,
                  "Transmittance of shadow rays, the same: " + method_names(transmittance_infos()))
      ->capture_default_str();
  command
      .add_option("--interpolation", o.interpolation,
                  "nearest, trilinear, stochastic, separated by commas; where nothing is said, "
                  "trackers that refuse stochastic interpolation take trilinear")
      ->capture_default_str();
  command.add_option("--time", o.time, "Seconds of each method, shared evenly by its repeats")
      ->capture_default_str()
      ->check(kFiniteNumber & CLI::PositiveNumber);
  command
      .add_option("--spp", o.samples,
                  "Samples per pixel of each method in place of a time, shared evenly by its "
                  "repeats; with --time, whichever ends first")
      ->check(CLI::Range(1U, 1U << 30));
  command.add_option("--repeats", o.repeats, "Independent runs of each method")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command.add_option("--reference", o.reference.file,
                     "Picture to measure against; without it one is made");
  command.add_option("--reference-time", o.reference.time, "Seconds for one that is made")
      ->capture_default_str()
      ->check(kFiniteNumber & CLI::PositiveNumber);
  command
      .add_option("--reference-spp", o.reference_samples,
                  "Its samples per pixel, in place of a time")
      ->check(CLI::Range(2U, 1U << 30));
  command.add_option("--cache", o.reference.cache, "Folder where references are kept, or none")
      ->capture_default_str();
  command.add_option("--exposure", o.exposure, "Exposure of the report's pictures [stops]")
      ->capture_default_str()
      ->check(kFiniteNumber);
  command.add_flag("--check", o.check,
                   "Exit with 1 if a method fails the bias test that claims to be unbiased");
}

}  // namespace

void add_compare_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("compare", "Measure trackers and estimators against each other");
  command->footer(kCompareFooter);
  const auto options = std::make_shared<CompareOptions>();
  options->picture.size = "320x180";
  add_comparison_options(*command, *options);
  add_picture_options(*command, options->picture);
  command->callback([command, options] {
    if (options->reference.cache == "none") options->reference.cache.clear();
    run(*command, *options);
  });
}

}  // namespace freepath::program
