#pragma once
/// @file From the shapes of a description to surfaces, and to the lights that they are.

#include "freepath/geometry/shape_geometry.h"
#include "freepath/lights/light_descriptions.h"
#include "freepath/scene/assembly/build_context.h"

namespace freepath {

/// The shapes of a scene before they are traced.
struct BuiltShapes {
  SurfaceScene surfaces;
  std::vector<PathShape> shapes;
  std::vector<AreaEmission> emissions;
  /// Shapes with an area light that let all rays through (alpha 0), so that none meets them.
  std::vector<SurfaceShape> invisible;
  /// A shape with an area light: its index (in surfaces.shapes or invisible) and its emission.
  struct Emitter {
    std::size_t surface = 0;
    uint32_t emission = 0;
    uint32_t shape = 0;
    bool is_invisible = false;
  };
  std::vector<Emitter> emitters;
};

/// Reads all shapes. Media have to be named, materials to be built.
/// @throws Error with file:line:column
BuiltShapes build_shapes(BuildContext& context);

/// The area lights of shapes.
/// @param origin of the rays [world]
std::vector<AreaLight> build_area_lights(const BuiltShapes& shapes, const Vec3d& origin);

/// Bounds of all shapes [world]; empty without any.
/// @throws Error as Surfaces
Box3d extent_of(const SurfaceScene& surfaces);

}  // namespace freepath
