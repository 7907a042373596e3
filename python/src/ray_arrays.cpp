#include "python/src/ray_arrays.h"

#include <cmath>

#include "freepath/base/error.h"

namespace freepath::python {

template <class Array>
RayArrays::Column RayArrays::column(const Array& array, std::size_t number) {
  const bool is_double = array.dtype() == nb::dtype<double>();
  if (!is_double && array.dtype() != nb::dtype<float>()) {
    fail("rays are arrays of float32 or float64");
  }
  const auto size = static_cast<std::ptrdiff_t>(is_double ? sizeof(double) : sizeof(float));
  const auto* const data = static_cast<const std::byte*>(array.data());
  const std::ptrdiff_t offset =
      number == 0 ? 0 : static_cast<std::ptrdiff_t>(number) * array.stride(1);
  return {data + offset * size, array.stride(0) * size, is_double};
}

RayArrays::RayArrays(const VectorArray& origins, const VectorArray& directions,
                     const NumberArray& t_max)
    : count_(origins.shape(0)) {
  if (directions.shape(0) != count_ || t_max.shape(0) != count_) {
    fail("there are {} origins, {} directions and {} ends: give one of each for a ray", count_,
         directions.shape(0), t_max.shape(0));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin_[axis] = column(origins, axis);
    direction_[axis] = column(directions, axis);
  }
  t_max_ = column(t_max, 0);
}

CameraRay RayArrays::ray(std::size_t ray) const {
  const Vec3d from(origin_[0][ray], origin_[1][ray], origin_[2][ray]);
  Vec3d along(direction_[0][ray], direction_[1][ray], direction_[2][ray]);
  const double square = along.length2();
  if (!std::isfinite(from.length2())) {
    fail("ray {}: its origin ({}, {}, {}) is not finite, or too far away", ray, from.x, from.y,
         from.z);
  }
  if (!std::isfinite(square) || square == 0) {
    fail("ray {}: its direction ({}, {}, {}) must be finite and not 0", ray, along.x, along.y,
         along.z);
  }
  // Those that are unit vectors in single precision stay as they are, to the bit.
  constexpr double kRounding = 1e-6;
  if (std::abs(square - 1) > kRounding) along /= std::sqrt(square);
  return {from, Vec3f(along)};
}

void RayArrays::put(std::size_t number, const Vec3d& origin, std::size_t slot,
                    RayStream& rays) const {
  const CameraRay one = ray(number);
  const double end = t_max_[number];
  if (!(end >= 0)) fail("ray {}: its t_max is {}; it must be 0 or more", number, end);
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][slot] = static_cast<float>(one.origin[axis] - origin[axis]);
    rays.direction[axis][slot] = one.direction[axis];
  }
  rays.t_max[slot] = static_cast<float>(end);
}

}  // namespace freepath::python
