#pragma once
/// @file Scenes that repeat sideways.

#include "freepath/geometry/shape_geometry.h"
#include "freepath/lights/light_descriptions.h"
#include "freepath/paths/path_scene.h"
#include "freepath/scene/periodic_sides.h"

namespace freepath {

/// Makes a scene repeat that is complete but for that. It is what stands in the domain: of surfaces
/// that reach beyond its sides nothing is seen there.
/// @param sides without extents: those of the voxels of all media, or, where there are none, of
///   `standing`
/// @param standing all that stands in the scene [world]
/// @param surfaces of the scene, before any boundary was left out
/// @param super_voxel edge of the super-voxels [voxels], 0 for automatic
/// @throws Error where nothing has extents, for boundaries of media at the sides or beyond, a
/// camera beside the domain where
///   there are boundaries, and as repeat_sides and PeriodicDomain
void make_periodic(PathScene& scene, PeriodicSides sides, const Box3d& standing,
                   const SurfaceScene& surfaces, int super_voxel);

/// Refuses lights that are not far away: in a domain that repeats there would be one in each
/// period.
/// @throws Error that names it
void check_lights_of_domain(const SceneLightsDescription& lights);

}  // namespace freepath
