#pragma once
/// @file Which boundaries of media need not be traced.

#include "freepath/geometry/shape_geometry.h"
#include "freepath/paths/path_scene.h"

namespace freepath {

/// Makes PathScene::surfaces of its shapes, and PathScene::is_clear, and completes camera_media.
///
/// A medium of voxels ends where its voxels do. Where its boundary lies wholly outside of them,
/// with vacuum beyond and no other boundary within, the boundary is of no use: it is left out, and
/// the medium fills the vacuum too. So it is with a homogeneous medium whose boundary is a box,
/// which it then fills by itself. This is done for one medium of a scene, the first that allows it.
/// @param stood where the camera stands of which camera_media tells [world]; from there it goes to
/// its place
void simplify_regions(SurfaceScene surfaces, PathScene& scene, const Vec3d& stood);

}  // namespace freepath
