#pragma once
/// @file The scene around a bare volume: its medium, a camera that sees all of it, sun and sky.

#include <optional>
#include <string>
#include <variant>

#include "freepath/io/volume.h"
#include "freepath/media/medium.h"
#include "freepath/render/camera.h"
#include "freepath/render/lights.h"

namespace freepath {

/// How a density becomes collision coefficients: an extinction and an albedo, or both coefficients.
struct OpticalProperties {
  float density_scale = 1;          ///< Multiplies the densities.
  Spectrum albedo{0.99F};           ///< sigma_s/sigma_t, where sigma_t is 1 per unit of density.
  std::optional<Spectrum> sigma_a;  ///< [1/m per unit of density] with sigma_s replaces the albedo;
  std::optional<Spectrum> sigma_s;  ///< of the two the one that is not given is 0.
  float g = 0;
  Spectrum emission{0.0F};  ///< L_e
};

/// The daylight sky.
struct SkyEnvironment {};

/// What shines on the volume.
struct LightOptions {
  /// The sky, one radiance, or the name of a latitude-longitude image.
  std::variant<SkyEnvironment, Spectrum, std::string> environment = SkyEnvironment{};
  bool sun = true;  ///< Whether its disc shines; it shapes the sky in any case.
  SunParameters sun_parameters{.elevation = 40, .azimuth = 250};
};

/// Where the camera stands; frames the whole volume where nothing is said.
struct CameraOptions {
  int width = 640;
  int height = 360;
  double fov = 40;            ///< Vertical [degrees].
  std::optional<Vec3d> from;  ///< [world]
  std::optional<Vec3d> at;    ///< [world]
};

/// @param super_voxel edge of a super-voxel [voxels], 0 for automatic
/// @throws Error for coefficients out of range, and for albedo and coefficients given together
Medium make_medium(Field field, const OpticalProperties& optics, int super_voxel);

/// @param field what to frame where the options name no position
/// @throws Error as Camera and frame_points
Camera make_camera(const Field& field, const CameraOptions& options, UpAxis up);

/// @throws Error as Lights, its environments and the image reader
Lights make_lights(const LightOptions& options, UpAxis up);

}  // namespace freepath
