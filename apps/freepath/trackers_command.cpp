// freepath trackers: the methods there are.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "apps/freepath/picture_options.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"
#include "freepath/transport/weight_growth.h"

namespace freepath::program {
namespace {

constexpr const char* kTrackersFooter =
    R"(A method's options follow its name, wherever methods are named: NAME:OPTION=VALUE,OPTION=VALUE.

Examples:
  freepath trackers
  freepath trackers --json
  freepath render cloud.vdb -o cloud.exr --tracker weighted-decomposition:control=0.5
  freepath render haze.vdb -o haze.exr --sigma-s 1,2,4 --tracker spectral --transmittance ratio)";

std::string values_of(const MethodOption& option) {
  if (!option.choices.empty()) return fmt::format("{}", fmt::join(option.choices, "|"));
  return fmt::format("{:g} to {:g}", option.minimum, option.maximum);
}

std::string standard_of(const MethodOption& option) {
  if (!option.choices.empty()) {
    return std::string(option.choices[static_cast<std::size_t>(option.default_value)]);
  }
  return fmt::format("{:g}", option.default_value);
}

std::string channels_of(const MethodInfo& info) {
  if (info.chromatic) return "all in one path";
  return info.one_channel ? "a path each" : "one path where the extinction is the same in all";
}

void print_methods(const char* title, const std::vector<MethodInfo>& infos) {
  print("{}\n", title);
  for (const MethodInfo& info : infos) {
    print("\n  {}{}\n      {}\n", info.name, info.biased ? "  (BIASED)" : "", info.summary);
    if (!info.needs.empty()) print("      needs:     {}\n", info.needs);
    print("      unbiased:  {}\n", info.biased ? "no" : info.unbiased);
    if (const std::string paths = weights_in_paths(info); !paths.empty()) {
      print("      paths:     {}\n", paths);
    }
    if (!is_automatic(info.name)) print("      channels:  {}\n", channels_of(info));
    if (!info.source.empty()) print("      source:    {}\n", info.source);
    for (const MethodOption& option : info.options) {
      print("      {}={}  [{}]\n          {}\n", option.name, values_of(option),
            standard_of(option), option.meaning);
    }
  }
  print("\n");
}

nlohmann::json to_json(const std::vector<MethodInfo>& infos) {
  nlohmann::json list = nlohmann::json::array();
  for (const MethodInfo& info : infos) {
    nlohmann::json options = nlohmann::json::array();
    for (const MethodOption& option : info.options) {
      nlohmann::json entry = {
          {"name", option.name}, {"default", standard_of(option)}, {"meaning", option.meaning}};
      if (option.choices.empty()) {
        entry["default"] = option.default_value;
        entry["minimum"] = option.minimum;
        entry["maximum"] = option.maximum;
      } else {
        entry["choices"] = std::vector<std::string>(option.choices.begin(), option.choices.end());
      }
      options.push_back(entry);
    }
    list.push_back({{"name", info.name},
                    {"summary", info.summary},
                    {"needs", info.needs},
                    {"biased", info.biased},
                    {"unbiased", info.unbiased},
                    {"paths", weights_in_paths(info)},
                    {"chromatic", info.chromatic},
                    {"source", info.source},
                    {"options", options}});
  }
  return list;
}

void run(bool json) {
  const std::vector<MethodInfo> trackers(tracker_choices().begin(), tracker_choices().end());
  const std::vector<MethodInfo> estimators(transmittance_infos().begin(),
                                           transmittance_infos().end());
  if (json) {
    const nlohmann::json all = {{"trackers", to_json(trackers)},
                                {"transmittance", to_json(estimators)}};
    print_json_text(all, 2);
    return;
  }
  print_methods("Trackers (--tracker)", trackers);
  print_methods("Transmittance estimators (--transmittance)", estimators);
}

}  // namespace

void add_trackers_command(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("trackers", "List the trackers and transmittance estimators");
  command->footer(kTrackersFooter);
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print one JSON object");
  command->callback([json] { run(*json); });
}

}  // namespace freepath::program
