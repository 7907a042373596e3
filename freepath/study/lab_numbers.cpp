#include "freepath/study/lab_numbers.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "freepath/base/json_text.h"
#include "freepath/study/lab_figures.h"

namespace freepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kUnit = "1/m";

Json to_json(const LabCheck& check) {
  return {{"estimate", check.estimate},
          {"standard_error", check.standard_error},
          {"exact", check.exact},
          {"z", check.z},
          {"p", check.p},
          {"standing", to_string(check.standing)}};
}

Json to_json(const LabMeasurement& measurement, double level) {
  Json object = {{"tracker", measurement.tracker},
                 {"biased", measurement.biased},
                 {"verdict", to_string(verdict_of(measurement, level))}};
  if (!measurement.stands_for.empty()) object["stands_for"] = measurement.stands_for;
  if (!measurement.refusal.empty()) {
    object["refusal"] = measurement.refusal;
    return object;
  }
  object["one_path_for_all_channels"] = measurement.shared;
  object["paths"] = measurement.paths;
  object["lookups"] = measurement.lookups;
  object["null_collisions"] = measurement.null_collisions;
  object["control_collisions"] = measurement.control_collisions;
  object["largest_weight"] = measurement.statistics.largest_weight;
  object["bound_violations"] = measurement.statistics.bound_violations;
  object["variance"] = measurement.variance;
  object["seconds"] = measurement.seconds;
  for (const LabChannel& channel : measurement.channels) {
    object["channels"].push_back({{"transmittance", to_json(channel.transmittance)},
                                  {"free_path", to_json(channel.free_path)},
                                  {"radiance", to_json(channel.radiance)},
                                  {"variance", channel.variance},
                                  {"negative_weights", channel.negative},
                                  {"collision_density", channel.ended},
                                  {"scattered", channel.scattered},
                                  {"scattered_error", channel.error},
                                  {"scattered_exact", channel.exact},
                                  {"weights", channel.weights}});
  }
  return object;
}

Json to_json(const LabThroughput& throughput) {
  Json object = {{"tracker", throughput.tracker}, {"paths", throughput.paths}};
  for (const LabStage& stage : throughput.stages) {
    Json channels = Json::array();
    for (const LabWeights& weights : stage.channels) {
      channels.push_back({{"mean", weights.mean},
                          {"standard_error", weights.standard_error},
                          {"exact", weights.exact},
                          {"p05", weights.low},
                          {"median", weights.median},
                          {"p95", weights.high},
                          {"largest", weights.largest}});
    }
    object["stages"].push_back(
        {{"at", stage.at}, {"alive", stage.alive}, {"channels", std::move(channels)}});
  }
  return object;
}

Json to_json(const LabSweep& sweep) {
  Json object = {{"tracker", sweep.tracker}, {"option", sweep.option}};
  for (const LabSweepPoint& point : sweep.points) {
    object["points"].push_back({{"value", point.value},
                                {"lookups", point.lookups},
                                {"variance", point.variance},
                                {"seconds", point.seconds},
                                {"variance_is_a_guess", point.heavy}});
  }
  return object;
}

template <class Values>
Json list_of(const Values& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back(to_json(value));
  return list;
}

Json to_json(const LabFindings& findings, double level) {
  Json object = {{"name", findings.setting.name}, {"summary", findings.setting.summary}};
  for (int channel = 0; channel < findings.setting.channels; ++channel) {
    Json sigma_a = Json::array();
    Json sigma_s = Json::array();
    for (int voxel = 0; voxel < kLabVoxels; ++voxel) {
      sigma_a.push_back(findings.curves.sigma_a((voxel + 0.5) / kLabVoxels, channel));
      sigma_s.push_back(findings.curves.sigma_s((voxel + 0.5) / kLabVoxels, channel));
    }
    object["channels"].push_back({{"optical_thickness", findings.curves.depth(1, channel)},
                                  {"radiance", findings.curves.radiance(channel)},
                                  {"sigma_a", std::move(sigma_a)},
                                  {"sigma_s", std::move(sigma_s)}});
  }
  object["trackers"] = Json::array();
  for (const LabMeasurement& measurement : findings.trackers) {
    object["trackers"].push_back(to_json(measurement, level));
  }
  object["throughput_along_ray"] = list_of(findings.along_ray);
  object["throughput_of_scatterings"] = list_of(findings.scatterings);
  object["sweeps"] = list_of(findings.sweeps);
  return object;
}

/// Lines of one table.
class Csv {
 public:
  struct Row {
    std::string_view tracker = {};
    int channel = -1;  ///< -1: all.
    std::string_view quantity = {};
    std::optional<double> at = {}, value = {}, error = {}, exact = {};
  };

  explicit Csv(std::string_view setting) : setting_(setting) {}

  void add(const Row& row) {
    // A tracker's options have commas.
    text_ += fmt::format("{},{},{},{},{},{},{},{}\n", setting_,
                         row.tracker.empty() ? "" : fmt::format("\"{}\"", row.tracker),
                         row.channel < 0 ? "" : fmt::format("{}", row.channel), row.quantity,
                         number(row.at), number(row.value), number(row.error), number(row.exact));
  }
  std::string take() { return std::move(text_); }

 private:
  static std::string number(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? fmt::format("{:.9g}", *value) : std::string{};
  }

  std::string setting_;
  std::string text_;
};

void add_extinction(const LabFindings& findings, Csv& csv) {
  const std::vector<LabBounds> bounds = lab_bounds(findings.setting);
  for (int channel = 0; channel < findings.setting.channels; ++channel) {
    for (int voxel = 0; voxel < kLabVoxels; ++voxel) {
      const double x = (voxel + 0.5) / kLabVoxels;
      const LabBounds& cell = bounds[voxel / kLabCell];
      csv.add({{}, channel, "sigma_a", x, findings.curves.sigma_a(x, channel), {}, {}});
      csv.add({{}, channel, "sigma_s", x, findings.curves.sigma_s(x, channel), {}, {}});
      csv.add({{}, channel, "majorant", x, cell.majorant[channel], {}, {}});
      csv.add({{}, channel, "minorant", x, cell.minorant[channel], {}, {}});
    }
  }
}

void add_channel(const std::string& tracker, int number, const LabChannel& channel, Csv& csv) {
  const auto check = [&](const char* name, const LabCheck& c) {
    csv.add({tracker, number, name, {}, c.estimate, c.standard_error, c.exact});
  };
  check("transmittance", channel.transmittance);
  check("radiance", channel.radiance);
  csv.add({tracker, number, "free_path_p", {}, channel.free_path.p, {}, {}});
  csv.add({tracker, number, "channel_variance", {}, channel.variance, {}, {}});
  csv.add({tracker, number, "negative_weights", {}, channel.negative, {}, {}});
  for (int bin = 0; bin < kLabBins; ++bin) {
    const double x = (bin + 0.5) / kLabBins;
    csv.add({tracker, number, "collision_density", x, channel.ended[bin], {}, {}});
    csv.add({tracker, number, "scattered", x, channel.scattered[bin], channel.error[bin],
             channel.exact[bin]});
  }
  for (int bin = 0; bin < kLabWeightBins; ++bin) {
    csv.add({tracker, number, "weights_from", lab_weight_edge(bin), channel.weights[bin], {}, {}});
  }
}

void add_measurement(const LabMeasurement& measurement, Csv& csv) {
  if (!measurement.refusal.empty()) return;
  const std::string& tracker = measurement.tracker;
  const auto add = [&](const char* name, double value) {
    csv.add({tracker, -1, name, {}, value, {}, {}});
  };
  add("paths", static_cast<double>(measurement.paths));
  add("lookups", measurement.lookups);
  add("null_collisions", measurement.null_collisions);
  add("control_collisions", measurement.control_collisions);
  add("largest_weight", measurement.statistics.largest_weight);
  add("variance", measurement.variance);
  add("seconds", measurement.seconds);
  for (std::size_t i = 0; i < measurement.channels.size(); ++i) {
    add_channel(tracker, static_cast<int>(i), measurement.channels[i], csv);
  }
}

void add_throughput(const LabThroughput& throughput, const std::string& along, Csv& csv) {
  for (const LabStage& stage : throughput.stages) {
    csv.add({throughput.tracker, -1, along + "_alive", stage.at, stage.alive, {}, {}});
    for (std::size_t i = 0; i < stage.channels.size(); ++i) {
      const LabWeights& weights = stage.channels[i];
      const auto add = [&](const char* name, double value) {
        csv.add({throughput.tracker, static_cast<int>(i), along + name, stage.at, value, {}, {}});
      };
      csv.add({throughput.tracker, static_cast<int>(i), along + "_mean", stage.at, weights.mean,
               weights.standard_error, weights.exact});
      add("_p05", weights.low);
      add("_median", weights.median);
      add("_p95", weights.high);
      add("_largest", weights.largest);
    }
  }
}

void add_sweep(const LabSweep& sweep, Csv& csv) {
  for (const LabSweepPoint& point : sweep.points) {
    csv.add({sweep.tracker, -1, sweep.option + "_lookups", point.value, point.lookups, {}, {}});
    csv.add({sweep.tracker, -1, sweep.option + "_variance", point.value, point.variance, {}, {}});
    csv.add({sweep.tracker, -1, sweep.option + "_seconds", point.value, point.seconds, {}, {}});
  }
}

}  // namespace

std::string_view to_string(LabVerdict verdict) {
  switch (verdict) {
    case LabVerdict::kRefuses:
      return "refuses";
    case LabVerdict::kAgrees:
      return "agrees";
    case LabVerdict::kDiffers:
      return "differs";
    case LabVerdict::kUndecided:
      break;
  }
  return "undecided";
}

std::string_view to_string(LabStanding standing) {
  switch (standing) {
    case LabStanding::kTested:
      return "tested";
    case LabStanding::kRare:
      return "too rare";
    case LabStanding::kHeavy:
      break;
  }
  return "weights spread too widely";
}

std::string lab_json(const LabResult& result) {
  Json weight_edges = Json::array();
  for (int bin = 0; bin <= kLabWeightBins; ++bin) weight_edges.push_back(lab_weight_edge(bin));
  Json object = {
      {"paths", result.options.paths},
      {"seed", result.options.seed},
      {"absorption", result.options.absorption == Absorption::kAnalog ? "analog" : "weighted"},
      {"tests", result.tests},
      {"family_wise_level", kLabLevel},
      {"level_of_each", result.level},
      {"unit_of_densities", kUnit},
      {"bins_along_ray", kLabBins},
      {"weight_bin_edges", std::move(weight_edges)},
      {"settings", Json::array()}};
  for (const LabFindings& findings : result.settings) {
    object["settings"].push_back(to_json(findings, result.level));
  }
  return json_text(object) + "\n";
}

std::string lab_csv(const LabResult& result) {
  std::string text = "setting,tracker,channel,quantity,at,value,standard_error,exact\n";
  for (const LabFindings& findings : result.settings) {
    Csv csv(findings.setting.name);
    add_extinction(findings, csv);
    for (const LabMeasurement& measurement : findings.trackers) add_measurement(measurement, csv);
    for (const LabThroughput& each : findings.along_ray) add_throughput(each, "ray", csv);
    for (const LabThroughput& each : findings.scatterings) {
      add_throughput(each, "scatterings", csv);
    }
    for (const LabSweep& sweep : findings.sweeps) add_sweep(sweep, csv);
    text += csv.take();
  }
  return text;
}

}  // namespace freepath
