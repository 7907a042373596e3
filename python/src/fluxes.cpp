// Reflectance and transmittance: of plane-parallel layers, and of media that repeat sideways.

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/paths/slab.h"
#include "freepath/scene/flux_scene.h"
#include "freepath/transport/auto_tracker.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/media.h"
#include "python/src/scene_options.h"
#include "python/src/walk_options.h"

namespace freepath::python {
namespace {

/// Mean, standard error, and upper limit where there is one.
using PythonEstimate = std::tuple<double, double, std::optional<double>>;

PythonEstimate to_python(const Estimate& estimate) {
  return {estimate.mean, estimate.error, estimate.upper};
}

/// Neither reflected nor transmitted.
Estimate absorptance_of(const SlabResult& result) {
  return {1 - result.total.mean, result.total.error, {}};
}

/// Optical thickness, albedo, phase function.
using Layer = std::tuple<double, double, const PhaseFunction*>;

nb::dict slab(const std::vector<Layer>& layers, double mu0, bool diffuse, uint64_t paths,
              const WalkOptions& walk, int threads) {
  std::vector<SlabLayer> described;
  for (const auto& [tau, albedo, phase] : layers) {
    SlabLayer& layer = described.emplace_back(SlabLayer{tau, albedo, 0, nullptr});
    if (phase->as_henyey_greenstein() != nullptr) {
      layer.g = double{phase->mean_cosine()};
    } else {
      layer.phase = std::make_shared<const PhaseFunction>(*phase);
    }
  }
  SlabSettings settings;
  settings.mu0 = mu0;
  settings.diffuse = diffuse;
  settings.paths = paths;
  settings.threads = threads;
  settings.walk = walk_settings(walk);
  const SlabResult result = result_interruptibly([&](const std::atomic<bool>& stop) {
    return trace_slab(described, settings, [&](uint64_t, uint64_t) { return !stop; });
  });
  nb::dict fluxes;
  fluxes["reflectance"] = to_python(result.reflectance);
  fluxes["transmittance"] = to_python(result.transmittance);
  fluxes["unscattered"] = to_python(result.unscattered);
  fluxes["absorptance"] = to_python(absorptance_of(result));
  fluxes["largest_weight"] = result.largest_weight;
  fluxes["paths"] = result.paths;
  fluxes["tracker"] = result.tracker;
  return fluxes;
}

/// What may be said of fluxes.
struct FluxOptions {
  WalkOptions walk;
  std::string up = "z";
  std::optional<DomainCorners> domain;
  std::optional<std::array<uint32_t, 2>> columns;
  std::optional<float> ground_albedo;
  std::optional<double> ground_height;
  std::optional<std::array<double, 2>> sun;  ///< Zenith and azimuth [degrees]; none: all the sky.
  std::vector<std::array<double, 2>> views;  ///< The same.
  uint64_t paths = FluxSettings{}.paths;
  int threads = 0;
};

Vec3f direction_of(const std::array<double, 2>& angles, UpAxis up) {
  return sky_direction(90 - angles[0], angles[1], up);
}

/// The whole, and means and errors of the columns, along the second level axis first.
nb::tuple map_to_python(const FluxMap& map, const std::array<uint32_t, 2>& counts) {
  std::vector<double> means, errors;
  for (const Estimate& column : map.columns) {
    means.push_back(column.mean);
    errors.push_back(column.error);
  }
  if (map.columns.empty()) {  // one column: the whole
    means = {map.all.mean};
    errors = {map.all.error};
  }
  const std::size_t rows = counts[1], row = counts[0];
  return nb::make_tuple(to_python(map.all), to_numpy(std::move(means), {rows, row}),
                        to_numpy(std::move(errors), {rows, row}));
}

/// Fluxes of a grey medium by name.
nb::dict to_python(const FluxResult& result, const std::array<uint32_t, 2>& counts) {
  nb::dict fluxes;
  fluxes["reflectance"] = map_to_python(result.reflectance, counts);
  fluxes["transmittance"] = map_to_python(result.transmittance, counts);
  fluxes["unscattered"] = map_to_python(result.unscattered, counts);
  fluxes["absorptance"] = map_to_python(result.absorptance, counts);
  nb::list radiances;
  for (const FluxMap& map : result.radiances) radiances.append(map_to_python(map, counts));
  fluxes["radiances"] = radiances;
  fluxes["largest_weight"] = result.largest_weight;
  fluxes["paths"] = result.paths;
  return fluxes;
}

/// @return the fluxes of each channel, or of one for all where they are the same, and the tracker
nb::tuple flux(const PythonMedium& medium, const FluxOptions& options) {
  if (medium.channels.emits()) {
    fail("what a medium emits is no part of these fluxes: leave out emission and temperature");
  }
  const UpAxis up = parse_up_axis(options.up);
  FluxSettings settings;
  settings.paths = options.paths;
  settings.threads = options.threads;
  settings.walk = walk_settings(options.walk);
  std::array<uint32_t, 2> counts{};
  const auto results = result_interruptibly([&](const std::atomic<bool>& stop) {
    const std::vector<VolumeMedium> media =
        medium.as_grey_volumes(periodic_sides(up == UpAxis::kY ? "xz" : "xy", options.domain));
    settings.walk.tracker = settle_tracker(settings.walk.tracker, *media[0].medium).tracker;
    std::optional<Ground> ground;
    if (options.ground_albedo) {
      ground = Ground{Rgb(*options.ground_albedo), options.ground_height, up};
    }
    std::vector<FluxResult> channels;
    for (const VolumeMedium& grey : media) {
      FluxScene scene = make_flux_scene(grey, up, ground, settings.walk.interpolation);
      if (options.columns) scene.meter.counts = *options.columns;
      counts = scene.meter.counts;
      for (const auto& view : options.views) scene.meter.views.push_back(direction_of(view, up));
      if (options.sun) scene.meter.beam = -direction_of(*options.sun, up);
      channels.push_back(trace_flux(scene.scene, scene.meter, settings,
                                    [&](uint64_t, uint64_t) { return !stop; }));
    }
    return channels;
  });
  nb::list channels;
  for (const FluxResult& result : results) channels.append(to_python(result, counts));
  return nb::make_tuple(channels, settings.walk.tracker);
}

}  // namespace

void bind_fluxes(nb::module_& module) {
  module.def("slab", &slab, nb::arg("layers"), nb::arg("mu0"), nb::arg("diffuse"), nb::arg("paths"),
             nb::arg("options"), nb::arg("threads"));
  nb::class_<FluxOptions>(module, "FluxOptions")
      .def(nb::init<>())
      .def_rw("walk", &FluxOptions::walk)
      .def_rw("up", &FluxOptions::up)
      .def_rw("domain", &FluxOptions::domain, nb::for_setter(nb::arg("domain").none()))
      .def_rw("columns", &FluxOptions::columns, nb::for_setter(nb::arg("columns").none()))
      .def_rw("ground_albedo", &FluxOptions::ground_albedo,
              nb::for_setter(nb::arg("ground_albedo").none()))
      .def_rw("ground_height", &FluxOptions::ground_height,
              nb::for_setter(nb::arg("ground_height").none()))
      .def_rw("sun", &FluxOptions::sun, nb::for_setter(nb::arg("sun").none()))
      .def_rw("views", &FluxOptions::views)
      .def_rw("paths", &FluxOptions::paths)
      .def_rw("threads", &FluxOptions::threads);
  module.def("flux", &flux, nb::arg("medium"), nb::arg("options"));
}

}  // namespace freepath::python
