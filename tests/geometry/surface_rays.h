#pragma once
/// @file Random rays and transforms for tests of surfaces.

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/surfaces.h"

namespace freepath::testing {

inline constexpr float kFar = std::numeric_limits<float>::infinity();

/// Numbers and vectors in a fixed order.
class RandomSurfaces {
 public:
  explicit RandomSurfaces(uint64_t seed) : random_(seed, 0, 0, 0) {}

  double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
  float uniform() { return random_.uniform(); }
  Vec3d in_box(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d v = in_box(1);
      if (v.length2() <= 1 && v.length2() > 1e-4) return v.normalized();
    }
  }
  /// A rotation after a scale that differs by axis, then a translation.
  Matrix4d transform(double offset, bool mirrored) {
    Matrix4d scale, turn, move;
    scale.setScale(Vec3d(uniform(0.5, 2), uniform(0.5, 2), uniform(0.5, 2) * (mirrored ? -1 : 1)));
    turn.setEulerAngles(in_box(3));
    move.setTranslation(in_box(offset));
    return scale * turn * move;
  }

 private:
  RandomStream random_;
};

inline SurfaceShape shape_of(ShapeGeometry geometry, const Matrix4d& matrix = Matrix4d(),
                             uint32_t number = 0) {
  SurfaceShape shape;
  shape.geometry = std::move(geometry);
  shape.object_to_world = matrix;
  shape.shape = number;
  return shape;
}

inline Surfaces surfaces_of(SurfaceShape shape, const Vec3d& origin = Vec3d(0)) {
  SurfaceScene scene;
  scene.shapes.push_back(std::move(shape));
  return Surfaces(scene, origin);
}

/// A closed cube of 12 triangles around 0, with the normals out.
inline TriangleMesh cube(double half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half,
                                (i & 4) != 0 ? half : -half);
  }
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

/// A sphere of triangles around 0: `steps` in the polar angle and twice as many around.
inline TriangleMesh triangle_sphere(double radius, int steps, bool with_normals) {
  TriangleMesh mesh;
  const int around = 2 * steps;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j < around; ++j) {
      const double theta = std::numbers::pi * i / steps;
      const double phi = 2 * std::numbers::pi * j / around;
      const Vec3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta));
      mesh.positions.push_back(n * radius);
      if (with_normals) mesh.normals.emplace_back(n);
    }
  }
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j;
      const int b = i * around + (j + 1) % around;
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {a, a + around, b});
      if (i + 1 < steps) mesh.indices.insert(mesh.indices.end(), {b, a + around, b + around});
    }
  }
  return mesh;
}

}  // namespace freepath::testing
