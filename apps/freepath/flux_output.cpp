#include "apps/freepath/flux_output.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "apps/freepath/console.h"
#include "apps/freepath/estimates.h"
#include "freepath/base/counted.h"
#include "freepath/io/image.h"

namespace freepath::program {
namespace {

using Json = nlohmann::ordered_json;

/// Quantities of a result by name.
std::vector<std::pair<std::string, const FluxMap*>> maps_of(const FluxResult& result) {
  return {{"reflectance", &result.reflectance},
          {"transmittance", &result.transmittance},
          {"unscattered", &result.unscattered},
          {"absorptance", &result.absorptance}};
}

/// Rows of columns along the second level axis, from where it is least.
void put_rows(Json& json, const std::string& name, const std::vector<Estimate>& columns,
              uint32_t width) {
  Json means = Json::array();
  Json errors = Json::array();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i % width == 0) {
      means.push_back(Json::array());
      errors.push_back(Json::array());
    }
    means.back().push_back(columns[i].mean);
    // Where nothing came there is no error.
    errors.back().push_back(columns[i].upper ? Json(nullptr) : Json(columns[i].error));
  }
  json[name] = std::move(means);
  json[name + "_error"] = std::move(errors);
}

std::string channel_name(std::size_t channel) { return std::string(1, "RGB"[channel]); }

void put_result(Json& json, const FluxReport& report, const FluxResult& result) {
  for (const auto& [name, map] : maps_of(result)) put_estimate(json, name, map->all);
  if (!result.reflectance.columns.empty()) {
    Json& columns = json["columns"] = Json::object();
    for (const auto& [name, map] : maps_of(result)) {
      put_rows(columns, name, map->columns, report.counts[0]);
    }
  }
  if (!result.radiances.empty()) json["radiances"] = Json::array();
  for (std::size_t i = 0; i < result.radiances.size(); ++i) {
    Json& view = json["radiances"].emplace_back();
    view["view_zenith"] = report.views[i].zenith;
    view["view_azimuth"] = report.views[i].azimuth;
    put_estimate(view, "radiance", result.radiances[i].all);
    if (result.radiances[i].columns.empty()) continue;
    put_rows(view["columns"] = Json::object(), "radiance", result.radiances[i].columns,
             report.counts[0]);
  }
  json["paths"] = result.paths;
}

Json json_of(const FluxReport& report, const FluxLight& light,
             const std::vector<FluxResult>& results) {
  Json json;
  if (light.sun) {
    json["sun_zenith"] = light.sun->zenith;
    json["sun_azimuth"] = light.sun->azimuth;
  } else {
    json["diffuse"] = true;
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    put_result(report.is_grey ? json : json["channels"][channel_name(i)], report, results[i]);
  }
  return json;
}

void print_result(const FluxReport& report, const FluxResult& result) {
  for (const auto& [name, map] : maps_of(result)) {
    print_estimate(name == "unscattered" ? "  unscattered" : name, map->all, result.paths);
  }
  for (std::size_t i = 0; i < result.radiances.size(); ++i) {
    const FluxAngles& view = report.views[i];
    print_estimate(fmt::format("view {:g},{:g}", view.zenith, view.azimuth),
                   result.radiances[i].all, result.paths);
  }
  print("{}, tracker {}\n", counted(result.paths, "path"), report.settings.walk.tracker);
}

}  // namespace

Vec3f direction_of(const FluxAngles& angles, UpAxis up) {
  return sky_direction(90 - angles.zenith, angles.azimuth, up);
}

void print_table(const FluxReport& report) {
  for (const auto& [light, results] : report.results) {
    if (light.sun) {
      print("sun at zenith {:g}, azimuth {:g}\n", light.sun->zenith, light.sun->azimuth);
    } else {
      print("diffuse light\n");
    }
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!report.is_grey) print("channel {}\n", channel_name(i));
      print_result(report, results[i]);
    }
  }
  std::string domain;
  for (int axis = 0; axis < 3; ++axis) {
    domain += fmt::format("{}{} {:.6g} to {:.6g}", axis > 0 ? ", " : "", "xyz"[axis],
                          report.domain.min[axis], report.domain.max[axis]);
  }
  print("domain {}; {} x {} columns\n", domain, report.counts[0], report.counts[1]);
}

void print_json(const FluxReport& report) {
  Json json;
  if (report.results.size() == 1) {
    json = json_of(report, report.results[0].first, report.results[0].second);
  } else {
    for (const auto& [light, results] : report.results) {
      json["results"].push_back(json_of(report, light, results));
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    json["domain"].push_back({report.domain.min[axis], report.domain.max[axis]});
  }
  json["tracker"] = report.settings.walk.tracker;
  json["seed"] = report.settings.walk.seed;
  print_json_text(json);
}

void write_maps(const std::string& path, const FluxReport& report) {
  const std::vector<FluxResult>& results = report.results.front().second;
  Image image;
  image.width = static_cast<int>(report.counts[0]);
  image.height = static_cast<int>(report.counts[1]);
  std::vector<const FluxMap*> maps;
  for (std::size_t c = 0; c < results.size(); ++c) {
    const std::string ending = report.is_grey ? "" : "." + channel_name(c);
    const auto add = [&](const std::string& name, const FluxMap& map) {
      image.channels.push_back(name + ending);
      image.channels.push_back(fmt::format("{}.error{}", name, ending));
      maps.push_back(&map);
    };
    for (const auto& [name, map] : maps_of(results[c])) add(name, *map);
    for (std::size_t i = 0; i < results[c].radiances.size(); ++i) {
      add(fmt::format("radiance{}", i + 1), results[c].radiances[i]);
    }
    image.metadata.emplace_back("freepath:paths" + ending, static_cast<int64_t>(results[c].paths));
  }
  for (int row = image.height - 1; row >= 0; --row) {
    for (int column = 0; column < image.width; ++column) {
      for (const FluxMap* const map : maps) {
        const std::size_t number = static_cast<std::size_t>(row) * image.width + column;
        const Estimate& estimate = map->columns.empty() ? map->all : map->columns[number];
        image.values.push_back(static_cast<float>(estimate.mean));
        image.values.push_back(static_cast<float>(estimate.error));
      }
    }
  }
  image.metadata.emplace_back("freepath:seed", static_cast<int64_t>(report.settings.walk.seed));
  write_exr(path, image);
}

}  // namespace freepath::program
