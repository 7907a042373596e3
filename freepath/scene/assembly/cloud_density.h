#pragma once
/// @file The density of pbrt's procedural cloud.

#include <memory>
#include <string>

#include "freepath/base/vector.h"
#include "freepath/media/field.h"

namespace freepath {

/// Gradient noise on the lattice of whole numbers, in about [-1, 1] [Perlin02].
double lattice_noise(const Vec3d& point);

/// Parameters of a medium of type "cloud".
struct CloudDensity {
  double density = 1;
  double wispiness = 1;  ///< How far noise displaces the places where the cloud is looked up.
  double frequency = 5;  ///< Frequency of the coarsest noise.
  Vec3d p0{0}, p1{1};    ///< Corners of its box [medium].

  /// Five octaves of noise at a place that two more displace; thicker towards y = 0 and clear at
  /// y = 1 [Pharr23, Sec. 11.4]. In [0, 1]; the box is not looked at.
  /// @param point [medium]
  double at(const Vec3d& point) const;
};

/// The cloud as a field whose densities are computed.
/// @param medium_to_world affine
/// @throws Error for a transform without an inverse or an empty box
std::shared_ptr<const Field> make_cloud_field(const std::string& name, const CloudDensity& cloud,
                                              const Matrix4d& medium_to_world);

}  // namespace freepath
