#pragma once
/// @file Rays in arrays of any layout.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>

#include "freepath/base/vector.h"
#include "freepath/sensors/camera.h"
#include "freepath/tracking/streams.h"

namespace freepath::python {

namespace nb = nanobind;

/// Vectors, of shape (n, 3), or numbers, of shape (n), of float32 or float64; strides may be any,
/// 0 too.
using VectorArray = nb::ndarray<nb::ro, nb::shape<-1, 3>, nb::device::cpu>;
using NumberArray = nb::ndarray<nb::ro, nb::shape<-1>, nb::device::cpu>;

/// Rays of a caller's arrays, which have to outlive it.
class RayArrays {
 public:
  /// @throws Error where the arrays differ in length
  RayArrays(const VectorArray& origins, const VectorArray& directions, const NumberArray& t_max);

  std::size_t size() const { return count_; }

  /// A ray, its direction a unit vector.
  /// @throws Error as put()
  CameraRay ray(std::size_t ray) const;

  /// Writes a ray to a slot of a stream; its direction is made a unit vector.
  /// @param origin what positions of the stream are relative to [world]
  /// @param stream number of the ray's random stream (stream_number)
  /// @throws Error, naming the ray, for an origin or a direction that is not finite, a direction
  ///   of length 0, and an end that is NaN or negative
  void put(std::size_t number, const Vec3d& origin, std::size_t slot, RayStream& rays) const;

 private:
  /// One number of each ray.
  struct Column {
    const std::byte* data = nullptr;
    std::ptrdiff_t stride = 0;  // in bytes
    bool is_double = false;

    double operator[](std::size_t i) const {
      const std::byte* const item = data + static_cast<std::ptrdiff_t>(i) * stride;
      return is_double ? *reinterpret_cast<const double*>(item)
                       : double{*reinterpret_cast<const float*>(item)};
    }
  };
  template <class Array>
  static Column column(const Array& array, std::size_t number);

  std::size_t count_;
  Column origin_[3], direction_[3], t_max_;
};

}  // namespace freepath::python
