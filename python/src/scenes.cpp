// Scenes: of pbrt files, and around media.

#include "python/src/scenes.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/scene/pbrt/parser.h"
#include "freepath/scene/volume_camera.h"
#include "freepath/scene/volume_scene.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"
#include "python/src/media.h"
#include "python/src/scene_options.h"

namespace nb = nanobind;

namespace freepath::python {
namespace {

using Triple = std::array<double, 3>;
using ScenePointer = std::shared_ptr<PythonScene>;
using SceneWithWarnings = std::pair<ScenePointer, std::vector<std::string>>;

Rgb spectrum_of(const Triple& rgb) {
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}
Vec3d vector_of(const Triple& point) { return {point[0], point[1], point[2]}; }

CameraKind camera_kind(const std::string& name) {
  if (name == "perspective") return CameraKind::kPerspective;
  if (name == "orthographic") return CameraKind::kOrthographic;
  if (name == "spherical") return CameraKind::kSpherical;
  fail("camera '{}' is unknown; there are: perspective, orthographic, spherical", name);
}

/// What may be said of a scene: whatever is not stays as it is.
struct SceneOptions {
  std::string up = "y";
  // Picture and camera
  std::optional<std::array<int, 2>> size;
  std::optional<std::string> camera;
  std::optional<double> fov;
  std::optional<Triple> from, at;
  // Light
  std::optional<std::variant<Triple, std::string>> environment;
  bool has_sun = false;
  double sun_elevation = LightOptions{}.sun_parameters.elevation;
  double sun_azimuth = LightOptions{}.sun_parameters.azimuth;
  std::optional<Triple> sun_irradiance;
  double turbidity = SunParameters{}.turbidity;
  // What lies below and beside
  std::optional<Triple> ground_albedo;
  std::optional<double> ground_height;
  std::string periodic;  ///< Axes: "", "x", "xy", ...
  std::optional<std::pair<Triple, Triple>> domain;

  UpAxis up_axis() const { return parse_up_axis(up); }
  PeriodicSides sides() const { return periodic_sides(periodic, domain); }
  std::optional<Ground> ground() const {
    if (!ground_albedo) return std::nullopt;
    return Ground{spectrum_of(*ground_albedo), ground_height, up_axis()};
  }
  LightOptions lights() const {
    LightOptions lights;
    lights.sun = has_sun;
    lights.sun_parameters = {
        .elevation = sun_elevation, .azimuth = sun_azimuth, .turbidity = turbidity};
    if (sun_irradiance) lights.sun_parameters.irradiance = spectrum_of(*sun_irradiance);
    if (!environment) return lights;
    if (const auto* const radiance = std::get_if<Triple>(&*environment)) {
      lights.environment = spectrum_of(*radiance);
    } else if (std::get<std::string>(*environment) != "sky") {
      lights.environment = std::get<std::string>(*environment);
    }
    return lights;
  }
  CameraOptions camera_options() const {
    CameraOptions options;
    options.kind = camera_kind(camera.value_or("perspective"));
    if (size) {
      options.width = (*size)[0];
      options.height = (*size)[1];
    }
    options.fov = fov.value_or(options.fov);
    // From below one would see the ground's underside.
    if (ground_albedo) options.elevation = -kFramingElevation;
    if (from) options.from = vector_of(*from);
    if (at) options.at = vector_of(*at);
    return options;
  }
};

SceneWithWarnings scene_around(const PythonMedium& medium, const SceneOptions& options) {
  std::vector<std::string> warnings;
  auto scene = result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    const UpAxis up = options.up_axis();
    const VolumeMedium volumes = medium.as_volumes(options.sides());
    const Camera camera = make_camera(*volumes.medium, options.camera_options(), up);
    auto made = std::make_shared<PythonScene>();
    made->built.scene = make_volume_scene(
        volumes, camera, make_surroundings(options.lights(), up, &warnings), options.ground());
    return made;
  });
  return {std::move(scene), std::move(warnings)};
}

BuildOptions build_options(const SceneOptions& options, std::vector<std::string>& warnings) {
  BuildOptions build;
  if (options.size) build.size = FilmSize{(*options.size)[0], (*options.size)[1]};
  build.ground = options.ground();
  build.sides = options.sides();
  if (options.camera || options.fov || options.from || options.at) {
    CameraChange& change = build.camera.emplace();
    change.kind = camera_kind(options.camera.value_or("perspective"));
    change.fov = options.fov;
    if (options.from) change.from = vector_of(*options.from);
    if (options.at) change.at = vector_of(*options.at);
    change.up = options.up_axis();
  }
  if (options.environment || options.has_sun) {
    LightOptions lights = options.lights();
    if (!options.environment) lights.environment = Rgb(0.0F);  // no sky is made in vain
    build.surroundings = make_surroundings(lights, options.up_axis(), &warnings);
    if (!options.environment) build.surroundings.environment.reset();
  }
  return build;
}

/// @param is_text whether `source` is the text of a scene, and not the name of its file
/// @param name of the text: errors begin with it, and files beside it are found
SceneWithWarnings scene_of_pbrt(const std::string& source, bool is_text, const std::string& name,
                                const SceneOptions& options) {
  std::vector<std::string> warnings;
  auto scene = result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    const BuildOptions build = build_options(options, warnings);
    Diagnostics diagnostics;
    auto made = std::make_shared<PythonScene>();
    made->is_of_file = true;
    made->built = is_text
                      ? build_scene(parse_pbrt_text(source, name, diagnostics), diagnostics, build)
                      : load_scene(source, diagnostics, build);
    for (std::string& warning : diagnostics.warnings()) warnings.push_back(std::move(warning));
    return made;
  });
  return {std::move(scene), std::move(warnings)};
}

}  // namespace

UpAxis parse_up_axis(const std::string& up) {
  if (up == "y") return UpAxis::kY;
  if (up == "z") return UpAxis::kZ;
  fail("up '{}' is unknown; there are: y, z", up);
}

PeriodicSides periodic_sides(const std::string& axes, const std::optional<DomainCorners>& domain) {
  PeriodicSides sides;
  for (const char axis : axes) {
    if (axis < 'x' || axis > 'z') fail("periodic '{}': axes are x, y and z", axes);
    sides.axes[axis - 'x'] = true;
  }
  if (domain && !sides.any()) fail("domain is that of periodic sides: say which axes repeat");
  if (domain) sides.extents = Box3d(vector_of(domain->first), vector_of(domain->second));
  return sides;
}

void bind_scenes(nb::module_& module) {
  nb::class_<SceneOptions>(module, "SceneOptions")
      .def(nb::init<>())
      .def_rw("up", &SceneOptions::up)
      .def_rw("size", &SceneOptions::size, nb::for_setter(nb::arg("size").none()))
      .def_rw("camera", &SceneOptions::camera, nb::for_setter(nb::arg("camera").none()))
      .def_rw("fov", &SceneOptions::fov, nb::for_setter(nb::arg("fov").none()))
      .def_rw("look_from", &SceneOptions::from, nb::for_setter(nb::arg("look_from").none()))
      .def_rw("look_at", &SceneOptions::at, nb::for_setter(nb::arg("look_at").none()))
      .def_rw("environment", &SceneOptions::environment,
              nb::for_setter(nb::arg("environment").none()))
      .def_rw("has_sun", &SceneOptions::has_sun)
      .def_rw("sun_elevation", &SceneOptions::sun_elevation)
      .def_rw("sun_azimuth", &SceneOptions::sun_azimuth)
      .def_rw("sun_irradiance", &SceneOptions::sun_irradiance,
              nb::for_setter(nb::arg("sun_irradiance").none()))
      .def_rw("turbidity", &SceneOptions::turbidity)
      .def_rw("ground_albedo", &SceneOptions::ground_albedo,
              nb::for_setter(nb::arg("ground_albedo").none()))
      .def_rw("ground_height", &SceneOptions::ground_height,
              nb::for_setter(nb::arg("ground_height").none()))
      .def_rw("periodic", &SceneOptions::periodic)
      .def_rw("domain", &SceneOptions::domain, nb::for_setter(nb::arg("domain").none()));
  nb::class_<PythonScene>(module, "Scene")
      .def_ro("is_of_file", &PythonScene::is_of_file)
      .def_prop_ro("size",
                   [](const PythonScene& self) {
                     const Camera& camera = *self.built.scene.camera;
                     return std::pair{camera.width(), camera.height()};
                   })
      .def_prop_ro("files", [](const PythonScene& self) {
        std::vector<std::string> files;
        for (const auto& file : self.built.files) files.push_back(file.string());
        return files;
      });
  module.def("scene_around", &scene_around, nb::arg("medium"), nb::arg("options"));
  module.def("scene_of_pbrt", &scene_of_pbrt, nb::arg("source"), nb::arg("is_text"),
             nb::arg("name"), nb::arg("options"));
}

}  // namespace freepath::python
