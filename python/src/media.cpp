// Media, and densities that Python computes.

#include "python/src/media.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/media/density_function.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/interruptible.h"

namespace freepath::python {

MediumChannels PythonMedium::selected(const std::vector<int>& numbers) const {
  if (numbers.empty()) return channels;
  MediumChannels some{static_cast<int>(numbers.size()), channels.components};
  for (std::size_t k = 0; k < some.components.size(); ++k) {
    const ComponentChannels& from = channels.components[k];
    ComponentChannels& to = some.components[k];
    to = {};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      to.sigma_a[i] = from.sigma_a[numbers[i]];
      to.sigma_s[i] = from.sigma_s[numbers[i]];
      to.emission[i] = from.emission[numbers[i]];
      to.radiance[i] = from.radiance[numbers[i]];
    }
  }
  return some;
}

Vec3d PythonMedium::origin() const {
  const Vec3d middle = medium->world_bounds().center();
  return std::isfinite(middle.length2()) ? middle : Vec3d(0);
}

namespace {

/// The medium, repeated: copies of its voxels.
VolumeMedium repeated(const PythonMedium& given, const PeriodicSides& sides) {
  std::vector<Volume> volumes;
  for (std::size_t k = 0; k < given.medium->components().size(); ++k) {
    const Component& component = given.medium->components()[k];
    if (component.density->function) {
      fail("'{}' is computed, and can't be repeated: bake it first", component.density->name);
    }
    OpticalProperties optics;
    optics.sigma_a = component.sigma_a;
    optics.sigma_s = component.sigma_s;
    optics.phase = component.phase;
    optics.emission = component.emission;
    Volume& volume = volumes.emplace_back();
    volume.densities = {*component.density};
    volume.optics = std::move(optics);
    if (const auto& temperature = given.temperatures[k]) {
      volume.temperature = temperature->field;
      volume.optics.temperature_scale = temperature->scale;
      volume.optics.temperature_offset = temperature->offset;
    }
  }
  return make_medium(std::move(volumes), given.super_voxel, sides);
}

}  // namespace

VolumeMedium PythonMedium::as_volumes(const PeriodicSides& sides) const {
  if (!is_renderable()) {
    fail("the medium has {} channels; scenes take one, or three for R, G and B", channels.count);
  }
  if (sides.any()) return repeated(*this, sides);
  check_optical_depth(*medium);
  return {.medium = medium, .temperatures = temperatures, .sides = {}};
}

std::vector<VolumeMedium> PythonMedium::as_grey_volumes(const PeriodicSides& sides) const {
  return grey_media(repeated(*this, sides), channels, super_voxel);
}

namespace {

/// Values of a coefficient, one for each channel.
using Values = std::vector<float>;
/// Field, with what its values are multiplied by to be kelvins, and the value at 0 K.
using Temperature = std::tuple<std::shared_ptr<const Field>, double, double>;
/// Field, sigma_a, sigma_s, emission, phase function, temperature.
using ComponentParts = std::tuple<std::shared_ptr<const Field>, Values, Values, Values,
                                  const PhaseFunction*, std::optional<Temperature>>;

/// What stands for the values of any number of channels where R, G and B are wanted: bounds of
/// super-voxels are chosen by the largest.
Rgb spectrum_of(const Values& values) {
  if (values.size() == kChannels) return {values[0], values[1], values[2]};
  return Rgb(*std::max_element(values.begin(), values.end()));
}

PythonMedium make_python_medium(const std::vector<ComponentParts>& parts, int super_voxel) {
  PythonMedium result;
  result.super_voxel = super_voxel;
  std::vector<Component> components;
  for (const auto& [field, sigma_a, sigma_s, emission, phase, temperature] : parts) {
    Component& component = components.emplace_back();
    component.density = field;
    component.sigma_a = spectrum_of(sigma_a);
    component.sigma_s = spectrum_of(sigma_s);
    component.phase = *phase;
    component.emission = spectrum_of(emission);
    ComponentChannels& channels = result.channels.components.emplace_back();
    std::copy(sigma_a.begin(), sigma_a.end(), channels.sigma_a.begin());
    std::copy(sigma_s.begin(), sigma_s.end(), channels.sigma_s.begin());
    std::copy(emission.begin(), emission.end(), channels.emission.begin());
    std::optional<TemperatureEmission>& thermal = result.temperatures.emplace_back();
    if (temperature) {
      const auto& [temperatures, scale, offset] = *temperature;
      if (temperatures->function) {
        fail("'{}' is computed, and can't be a temperature: bake it first", temperatures->name);
      }
      if (sigma_a.size() != kChannels) fail("black bodies glow in R, G and B: give three channels");
      thermal = {temperatures, scale, offset};
      set_thermal_emission(*thermal, component.emission, component);
      std::copy(component.radiance.begin(), component.radiance.end(), channels.radiance.begin());
      for (int c = 0; c < kChannels; ++c) channels.emission[c] = component.emission[c];
    }
    result.channels.count = static_cast<int>(sigma_a.size());
  }
  result.medium = result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    return std::make_shared<const Medium>(std::move(components), super_voxel);
  });
  return result;
}

using Corner = std::array<double, 3>;

Corner corner_of(const Vec3d& point) { return {point.x, point.y, point.z}; }
Vec3f point_of(const Corner& corner) {
  return {static_cast<float>(corner[0]), static_cast<float>(corner[1]),
          static_cast<float>(corner[2])};
}

/// A Python object that threads without the GIL may hold and let go.
using SharedObject = std::shared_ptr<const nb::object>;

SharedObject share(nb::object object) {
  return {new nb::object(std::move(object)), [](const nb::object* held) {
            if (!nb::is_alive()) return;  // the interpreter ended first
            const nb::gil_scoped_acquire acquired;
            delete held;
          }};
}

using Evaluate = std::function<void(std::span<const Vec3f>, std::span<float>)>;
using Densities = nb::ndarray<const float, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

/// Calls Python with positions of shape (n, 3) for n densities.
Evaluate call_python(nb::object function) {
  return [shared = share(std::move(function))](std::span<const Vec3f> positions,
                                               std::span<float> densities) {
    const nb::gil_scoped_acquire acquired;
    ArrayMemory<float> points(3 * positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) points.data()[3 * i + axis] = positions[i][axis];
    }
    const auto values =
        nb::cast<Densities>((*shared)(std::move(points).to_numpy({positions.size(), 3})));
    std::copy_n(values.data(), densities.size(), densities.begin());
  };
}

/// Positions (x, y, z one after the other), densities, and how many there are.
using CompiledFunction = void (*)(const float*, float*, std::intptr_t);

/// Calls a compiled function, without Python.
/// @param owner keeps it alive
Evaluate call_compiled(std::uintptr_t address, nb::object owner) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  const auto function = reinterpret_cast<CompiledFunction>(address);
  return [function, shared = share(std::move(owner))](std::span<const Vec3f> positions,
                                                      std::span<float> densities) {
    function(&positions.data()->x, densities.data(), static_cast<std::intptr_t>(positions.size()));
  };
}

/// @param bounds called with the corners of a part of the box; returns the least and the largest
///   density there
auto bounds_from_python(nb::object bounds) {
  return [shared = share(std::move(bounds))](const Box3f& part) -> DensityFunction::Bounds {
    const nb::gil_scoped_acquire acquired;
    const auto [least, largest] = nb::cast<std::pair<float, float>>(
        (*shared)(corner_of(Vec3d(part.min)), corner_of(Vec3d(part.max))));
    return {least, largest};
  };
}

std::shared_ptr<const Field> computed_field(const std::string& name, std::uintptr_t address,
                                            nb::object function, nb::object bounds,
                                            const Corner& lower, const Corner& upper,
                                            const std::array<int, 3>& cells) {
  return make_function_field(name,
                             {.evaluate = address != 0 ? call_compiled(address, std::move(function))
                                                       : call_python(std::move(function)),
                              .bounds = bounds_from_python(std::move(bounds)),
                              .box = Box3f(point_of(lower), point_of(upper)),
                              .cells = Vec3i(cells[0], cells[1], cells[2])});
}

}  // namespace

void bind_media(nb::module_& module) {
  nb::class_<PythonMedium>(module, "Medium")
      .def_prop_ro("bounds",
                   [](const PythonMedium& self) {
                     const Box3d box = self.medium->world_bounds();
                     return std::pair{corner_of(box.min), corner_of(box.max)};
                   })
      .def_prop_ro("channel_count", [](const PythonMedium& self) { return self.channels.count; })
      .def_prop_ro("memory_bytes",
                   [](const PythonMedium& self) { return self.medium->memory_bytes(); })
      .def_prop_ro("super_voxel_count",
                   [](const PythonMedium& self) { return self.medium->super_voxel_count(); })
      .def_prop_ro("emits", [](const PythonMedium& self) { return self.channels.emits(); });
  module.def("make_medium", &make_python_medium, nb::arg("components"), nb::arg("super_voxel"));
  module.def("computed_field", &computed_field, nb::arg("name"), nb::arg("address"),
             nb::arg("function"), nb::arg("bounds"), nb::arg("lower"), nb::arg("upper"),
             nb::arg("cells"));
}

}  // namespace freepath::python
