// Comparisons as JSON and CSV.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "freepath/base/json_text.h"
#include "freepath/base/version.h"
#include "freepath/study/comparison_figures.h"
#include "freepath/study/comparison_report.h"

namespace freepath {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Interval& interval) {
  Json json = {{"value", interval.value}, {"low", nullptr}, {"high", nullptr}};
  if (interval.low) json["low"] = *interval.low;
  if (interval.high) json["high"] = *interval.high;
  return json;
}

Json to_json(const ComparisonRun& run) {
  Json json;
  for (const ComparisonFigure& figure : comparison_figures()) {
    json[std::string(figure.key)] = figure.of_run(run);
  }
  json["channel_mse"] = run.error.channel_mse;
  json["camera_samples"] = run.camera_samples;
  json["overflows"] = run.overflows;
  json["convergence"] = Json::array();
  for (const ConvergencePoint& point : run.convergence) {
    json["convergence"].push_back(
        {{"samples", point.samples}, {"seconds", point.seconds}, {"mse", point.mse}});
  }
  return json;
}

Json to_json(const Comparison& comparison, std::size_t which) {
  const ConfigurationResult& result = comparison.configurations[which];
  Json json = {{"name", result.name},
               {"tracker", result.configuration.tracker},
               {"transmittance", result.configuration.transmittance},
               {"interpolation", to_string(result.configuration.interpolation)},
               {"biased_by_design", result.is_biased},
               {"efficiency", result.efficiency ? to_json(*result.efficiency) : Json()}};
  for (const ComparisonFigure& figure : comparison_figures()) {
    json[std::string(figure.key)] = to_json(result.over_runs(figure.of_run));
  }
  json["bias_test"] = {{"verdict", to_string(result.verdict)},
                       {"passes", result.verdict == BiasVerdict::kPasses},
                       {"z", result.bias.z},
                       {"worst_block_z", result.bias.worst_block()},
                       {"block_z", result.bias.block_z},
                       {"blocks_across", result.bias.blocks_across},
                       {"blocks_down", result.bias.blocks_down}};
  json["reference"] = comparison.reference_of[which];
  json["runs"] = Json::array();
  for (const ComparisonRun& run : result.runs) json["runs"].push_back(to_json(run));
  return json;
}

/// A field of CSV: in quotes where it has a comma.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string csv_of(const Interval& interval) {
  const auto end = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? fmt::format("{:.8g}", *value) : std::string();
  };
  return fmt::format(",{},{},{}", end(interval.value), end(interval.low), end(interval.high));
}

}  // namespace

std::string json_of(const Comparison& comparison, const ReportContext& context) {
  Json json = {{"target", context.target},
               {"command", context.command},
               {"version", version()},
               {"machine", context.machine},
               {"date", context.date},
               {"seconds", comparison.seconds},
               {"confidence", kConfidence},
               {"baseline", comparison.configurations[comparison.baseline].name},
               {"bias_tests", comparison.tests},
               {"bias_threshold", comparison.threshold},
               {"references", Json::array()},
               {"findings", findings_of(comparison)},
               {"configurations", Json::array()}};
  for (const Reference& reference : comparison.references) {
    json["references"].push_back(
        {{"origin", reference.origin}, {"variance_known", reference.variance_known}});
  }
  for (std::size_t i = 0; i < comparison.configurations.size(); ++i) {
    json["configurations"].push_back(to_json(comparison, i));
  }
  return json_text(json, 1) + "\n";
}

std::string csv_of(const Comparison& comparison) {
  std::string text =
      "method,tracker,transmittance,interpolation,efficiency,efficiency_low,efficiency_high";
  for (const ComparisonFigure& figure : comparison_figures()) {
    text += fmt::format(",{0},{0}_low,{0}_high", figure.key);
  }
  text += ",z_r,z_g,z_b,worst_block_z,bias_test\n";
  for (const ConfigurationResult& result : comparison.configurations) {
    text += quoted(result.name) + "," + quoted(result.configuration.tracker) + "," +
            quoted(result.configuration.transmittance) + "," +
            std::string(to_string(result.configuration.interpolation));
    text += result.efficiency ? csv_of(*result.efficiency) : ",,,";
    for (const ComparisonFigure& figure : comparison_figures()) {
      text += csv_of(result.over_runs(figure.of_run));
    }
    text += fmt::format(",{:.4g},{:.4g},{:.4g},{:.4g},{}\n", result.bias.z[0], result.bias.z[1],
                        result.bias.z[2], result.bias.worst_block(), to_string(result.verdict));
  }
  return text;
}

}  // namespace freepath
