// freepath lab: the trackers in one dimension, against exact curves.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/method_list.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/progress_bar.h"
#include "apps/freepath/report_folder.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/base/nearest_name.h"
#include "freepath/study/lab.h"
#include "freepath/study/lab_numbers.h"
#include "freepath/study/lab_report.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"

namespace freepath::program {
namespace {

constexpr const char* kLabFooter =
    R"(Media that vary along one axis, whose free paths are known exactly: what trackers sample, their
weights, what they cost, and how throughput evolves where channels differ. -o names a folder, which is
made if it is missing; it gets report.html, lab.json, lab.csv and every plot as .svg. Only times depend
on --threads. docs/lab.md explains the figures. Ctrl-C ends without writing anything.

A tracker that walks all channels with one path is followed through its scatterings too. Methods take
options after their name: spectral:collision-probability=max,rate-scale=2

Examples:
  freepath lab -o lab
  freepath lab --list
  freepath lab chromatic-ramp -o ramp --trackers spectral:collision-probability=max,spectral
  freepath lab fixture-a two-boxes -o boxes --paths 1e7 --absorption analog)";

/// The options as they were typed.
struct LabCommandOptions {
  std::vector<std::string> settings;
  std::string folder, trackers, paths = "4e5", absorption = "weighted";
  uint64_t seed = 0;
  int threads = 0;
  bool list = false;
};

void print_list() {
  for (const LabSettingInfo& info : lab_setting_infos()) {
    print("{:<16}  {}\n", info.name, info.summary);
  }
}

void check_setting(const std::string& setting) {
  std::vector<std::string_view> names;
  for (const LabSettingInfo& info : lab_setting_infos()) names.push_back(info.name);
  if (std::find(names.begin(), names.end(), setting) != names.end()) return;
  const std::string_view nearest = nearest_name(setting, names);
  if (!nearest.empty()) fail("there is no setting '{}'; did you mean '{}'?", setting, nearest);
  fail("there is no setting '{}'; there are {}", setting, fmt::join(names, ", "));
}

std::vector<std::string> read_trackers(const std::string& text) {
  if (text.empty()) return {};
  return read_option("--trackers", [&] {
    std::vector<std::string> trackers = split_methods(text);
    for (const std::string& tracker : trackers) {
      parse_method(tracker, tracker_choices());
    }
    return trackers;
  });
}

LabOptions read_options(const LabCommandOptions& options) {
  LabOptions lab;
  for (const std::string& setting : options.settings) {
    check_setting(setting);
    const auto found = std::find(lab.settings.begin(), lab.settings.end(), setting);
    if (found != lab.settings.end()) fail("the setting '{}' is named twice", setting);
    lab.settings.push_back(setting);
  }
  lab.trackers = read_trackers(options.trackers);
  lab.paths = parse_count(options.paths, "--paths", 1000, 1e12);
  lab.seed = options.seed;
  lab.threads = settle_threads(options.threads);
  lab.absorption = parse_absorption(options.absorption);
  return lab;
}

/// How far the laboratory is, on a terminal alone.
class ProgressLine {
 public:
  void show(double share, std::string_view doing) {
    constexpr auto kBetween = std::chrono::milliseconds(100);
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ < kBetween) return;
    shown_ = now;
    show_status(fmt::format("{:3.0f} %  {}", 100 * share, doing));
  }

 private:
  std::chrono::steady_clock::time_point shown_;
};

/// The comparison of a kind that is farthest off, of those that count.
const LabCheck* worst(const LabMeasurement& measurement, LabCheck LabChannel::*member) {
  const LabCheck* found = nullptr;
  for (const LabChannel& channel : measurement.channels) {
    const LabCheck& check = channel.*member;
    if (check.standing != LabStanding::kTested) continue;
    if (found == nullptr || check.p < found->p) found = &check;
  }
  return found;
}

void print_row(const LabFindings& findings, const LabMeasurement& measurement, double level) {
  std::string verdict(to_string(verdict_of(measurement, level)));
  if (measurement.biased) verdict += " (biased)";
  if (!measurement.refusal.empty()) {
    print("{:<16} {:<48} {:>8} {:>9} {:>9} {:>10}  {}\n", findings.setting.name,
          measurement.tracker, "-", "-", "-", "-", verdict);
    return;
  }
  const LabCheck* const transmittance = worst(measurement, &LabChannel::transmittance);
  const LabCheck* const free_path = worst(measurement, &LabChannel::free_path);
  print("{:<16} {:<48} {:>8} {:>9} {:>9.3f} {:>10.4g}  {}\n", findings.setting.name,
        measurement.tracker,
        transmittance == nullptr ? "-" : fmt::format("{:+.2f}", transmittance->z),
        free_path == nullptr ? "-" : fmt::format("{:.3g}", free_path->p), measurement.lookups,
        measurement.variance, verdict);
}

void print_table(const LabResult& result) {
  print("{:<16} {:<48} {:>8} {:>9} {:>9} {:>10}  {}\n", "setting", "tracker", "z of T", "p of path",
        "look-ups", "variance", "verdict");
  for (const LabFindings& findings : result.settings) {
    for (const LabMeasurement& measurement : findings.trackers) {
      print_row(findings, measurement, result.level);
    }
  }
}

void run(const LabCommandOptions& options) {
  if (options.list) {
    print_list();
    return;
  }
  const LabOptions lab = read_options(options);
  if (options.folder.empty()) fail("-o is missing: name a folder for the report, or take --list");
  ReportFolder folder(options.folder);  // before the time is spent
  const StopOnInterrupt stop;
  ProgressLine line;
  LabResult result;
  try {
    result = run_lab(lab, [&](double share, std::string_view doing) {
      line.show(share, doing);
      return !stop.requested();
    });
  } catch (const Error&) {
    clear_status();
    if (stop.requested()) fail("interrupted; nothing was written");
    throw;
  }
  clear_status();
  const std::vector<LabFile> files = lab_files(result, command_line());
  for (const LabFile& file : files) folder.write(file.name, file.content);
  print_table(result);
  folder.finish();
  print("{} in {}: open {}\n", counted(files.size(), "file"), options.folder,
        folder.file("report.html"));
}

}  // namespace

void add_lab_command(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "lab", "Trackers in one dimension, against exact free paths: an HTML report");
  const auto options = std::make_shared<LabCommandOptions>();
  LabCommandOptions& o = *options;
  command->add_option("settings", o.settings, "Settings to measure [all]; --list names them")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("-o,--output", o.folder, "Folder for the report");
  command->add_option("--trackers", o.trackers,
                      "Trackers, NAME:OPTION=VALUE,... [all, and what the paper compares]");
  command->add_option("--paths", o.paths, "Paths of each tracker")->capture_default_str();
  command->add_option("--absorption", o.absorption, "analog or weighted")->capture_default_str();
  command->add_option("--seed", o.seed, "Seed of the random numbers")
      ->capture_default_str()
      ->check(kWholeNumber);
  command->add_option("--threads", o.threads, "Threads [all]")->check(CLI::Range(1, 1024));
  command->add_flag("--list", o.list, "List the settings");
  command->footer(kLabFooter);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
