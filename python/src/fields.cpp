// Fields: from arrays and files, to arrays and files.

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"
#include "freepath/io/volume.h"
#include "freepath/io/volume_array.h"
#include "freepath/io/volume_write.h"
#include "freepath/media/density_function.h"
#include "python/src/arrays.h"
#include "python/src/bindings.h"
#include "python/src/fields.h"
#include "python/src/interruptible.h"

namespace freepath::python {
namespace {

using Values = nb::ndarray<nb::ro, nb::ndim<3>, nb::device::cpu>;
using FieldPointer = std::shared_ptr<Field>;
using FieldWithWarnings = std::pair<FieldPointer, std::vector<std::string>>;

LoadOptions load_options(const std::string& grid, bool clamps_negative, bool zeroes_invalid) {
  return {.selection = parse_grid_selection(grid),
          .negative = clamps_negative ? NegativePolicy::kClamp : NegativePolicy::kError,
          .invalid = zeroes_invalid ? InvalidPolicy::kZero : InvalidPolicy::kError,
          .scalar_only = true};
}

FieldWithWarnings to_python(LoadedField loaded) {
  return {std::make_shared<Field>(std::move(loaded.field)), std::move(loaded.warnings)};
}

template <class Real>
VoxelArray<Real> voxels_of(const Values& values) {
  VoxelArray<Real> array;
  array.values = static_cast<const Real*>(values.data());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    array.counts[axis] = values.shape(axis);
    array.strides[axis] = values.stride(axis);
  }
  return array;
}

FieldWithWarnings field_of(const Values& values, const std::string& name, const Matrix& transform,
                           bool clamps_negative, bool zeroes_invalid) {
  const LoadOptions options = load_options({}, clamps_negative, zeroes_invalid);
  const Matrix4d index_to_world = matrix_of(transform);
  const bool is_double = values.dtype() == nb::dtype<double>();
  if (!is_double && values.dtype() != nb::dtype<float>()) fail("{}: not of floats", name);
  return to_python(result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    return is_double ? field_from_array(voxels_of<double>(values), name, index_to_world, options)
                     : field_from_array(voxels_of<float>(values), name, index_to_world, options);
  }));
}

FieldWithWarnings open_field(const std::string& path, const std::string& grid, bool clamps_negative,
                             bool zeroes_invalid) {
  return to_python(result_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    return load_field(path, load_options(grid, clamps_negative, zeroes_invalid));
  }));
}

void save_field(const Field& field, const std::string& path, bool half) {
  if (field.function)
    fail("'{}' is computed and has no voxels to write: bake it first", field.name);
  run_interruptibly([&](const std::atomic<bool>& /*stop*/) {
    const Field* const fields[] = {&field};
    write_vdb(path, fields, {.half = half});
  });
}

nb::object voxels_to_numpy(const Field& field) {
  if (field.function) fail("'{}' is computed and has no voxels: bake it first", field.name);
  const BrickMap& map = field.voxels;
  const Vec3i first = map.active_min();
  const Vec3i size = map.active_max() - first + Vec3i(1);
  const std::size_t counts[3] = {std::size_t(size.x), std::size_t(size.y), std::size_t(size.z)};
  check_memory_present(field.name,
                       fmt::format("an array of {} x {} x {} voxels", size.x, size.y, size.z),
                       double(size.x) * double(size.y) * double(size.z) * sizeof(float));
  ArrayMemory<float> values(counts[0] * counts[1] * counts[2]);
  run_interruptibly([&](const std::atomic<bool>& /*stop*/) { copy_voxels(map, values.data()); });
  return std::move(values).to_numpy({counts[0], counts[1], counts[2]});
}

Matrix matrix_to_python(const Matrix4d& matrix) {
  Matrix rows;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) rows[row][column] = matrix[row][column];
  }
  return rows;
}

}  // namespace

Matrix4d matrix_of(const Matrix& rows) {
  Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix[row][column] = rows[row][column];
  }
  return matrix;
}

void bind_fields(nb::module_& module) {
  nb::class_<Field>(module, "Field")
      .def_ro("name", &Field::name)
      .def_prop_ro("is_computed", [](const Field& field) { return field.function != nullptr; })
      .def_prop_ro("transform",
                   [](const Field& field) { return matrix_to_python(field.index_to_world); })
      .def_prop_ro("first_voxel",
                   [](const Field& field) {
                     const Vec3i& first = field.voxels.active_min();
                     return std::array<int, 3>{first.x, first.y, first.z};
                   })
      .def_prop_ro("last_voxel",
                   [](const Field& field) {
                     const Vec3i& last = field.voxels.active_max();
                     return std::array<int, 3>{last.x, last.y, last.z};
                   })
      .def_prop_ro("memory_bytes", [](const Field& field) { return field.voxels.memory_bytes(); })
      .def("save", &save_field, nb::arg("path"), nb::arg("half"))
      .def("to_array", &voxels_to_numpy);
  module.def("field_from_array", &field_of, nb::arg("values"), nb::arg("name"),
             nb::arg("transform"), nb::arg("clamps_negative"), nb::arg("zeroes_invalid"));
  module.def("open_field", &open_field, nb::arg("path"), nb::arg("grid"),
             nb::arg("clamps_negative"), nb::arg("zeroes_invalid"));
  module.def("list_grids", [](const std::string& path) {
    const auto grids = result_interruptibly(
        [&](const std::atomic<bool>& /*stop*/) { return list_grid_heads(path); });
    std::vector<std::string> names;
    for (const GridInfo& grid : grids) names.push_back(grid.name);
    return names;
  });
}

}  // namespace freepath::python
