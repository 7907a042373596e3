#pragma once
/// @file Volumes that repeat sideways, as light from above meets them.

#include <optional>

#include "freepath/base/up_axis.h"
#include "freepath/paths/flux.h"
#include "freepath/scene/ground.h"
#include "freepath/scene/volume_medium.h"

namespace freepath {

/// A scene without lights and a camera, and what measures fluxes through it.
struct FluxScene {
  PathScene scene;
  FluxMeter meter;
  Box3d domain;  ///< What is measured [world].
};

/// The domain of a medium from its top to its bottom, or to a ground that lies lower, in columns of
/// one voxel each of its first component.
/// @param medium whose sides repeat along both level axes
/// @param interpolation with which it will be walked: filters reach beyond the faces of voxels
/// @throws Error as make_volume_scene, and where a side does not repeat
FluxScene make_flux_scene(const VolumeMedium& medium, UpAxis up,
                          const std::optional<Ground>& ground, Interpolation interpolation);

}  // namespace freepath
