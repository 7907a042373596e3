#include "freepath/media/density_function.h"

#include <cmath>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr int kMaxCells = 1024;

void check_densities(const std::string& name, std::span<const Vec3f> positions,
                     std::span<const float> densities) {
  for (std::size_t i = 0; i < densities.size(); ++i) {
    if (densities[i] >= 0 && std::isfinite(densities[i])) continue;
    fail("density function '{}' is {} at ({}, {}, {}); densities are finite and not negative", name,
         densities[i], positions[i].x, positions[i].y, positions[i].z);
  }
}

}  // namespace

std::shared_ptr<const Field> make_function_field(std::string name, DensityFunction function) {
  if (!function.evaluate || !function.bounds) {
    fail("density function '{}' lacks {}", name, function.evaluate ? "bounds" : "evaluate");
  }
  const Vec3f size = function.box.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0) || !std::isfinite(size[axis])) {
      fail("density function '{}': its box is empty or not finite along axis {}", name, axis);
    }
    if (function.cells[axis] < 1 || function.cells[axis] > kMaxCells) {
      fail("density function '{}' wants {} cells along axis {}; there may be 1 to {}", name,
           function.cells[axis], axis, kMaxCells);
    }
  }
  auto field = std::make_shared<Field>();
  // Index points are the centres of cells.
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = double{size[axis]} / function.cells[axis];
    field->index_to_world[axis][axis] = edge;
    field->index_to_world[3][axis] = function.box.min[axis] + 0.5 * edge;
  }
  function.evaluate = [evaluate = std::move(function.evaluate), name](
                          std::span<const Vec3f> positions, std::span<float> densities) {
    evaluate(positions, densities);
    check_densities(name, positions, densities);
  };
  field->name = std::move(name);
  field->function = std::make_shared<const DensityFunction>(std::move(function));
  return field;
}

}  // namespace freepath
