#pragma once
/// @file A point of a surface, as materials and lights see it.

#include <cstdint>

#include "freepath/base/vector.h"

namespace freepath {

/// A point of a surface. Positions are relative to the origin of the rays [world].
struct SurfacePoint {
  Vec3f position;
  Vec3f normal;            ///< Geometric, unit; to the outside of the shape, whatever side is hit.
  Vec3f shading_normal;    ///< Interpolated where the mesh has normals, unit, in its hemisphere.
  Vec3f dpdu;              ///< Direction of growing u, not 0; not normalised.
  float u = 0, v = 0;      ///< Texture coordinates.
  uint32_t shape = 0;      ///< Number among the scene's shapes.
  uint32_t primitive = 0;  ///< Triangle or patch of the shape.
};

}  // namespace freepath
