#pragma once
/// @file Bare volumes as a scene: their medium, a camera that sees all of it, sun and sky.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "freepath/io/volume.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/sun.h"
#include "freepath/lights/thermal_radiance.h"
#include "freepath/media/medium.h"
#include "freepath/paths/path_scene.h"
#include "freepath/sensors/camera.h"

namespace freepath {

/// How a density becomes collision coefficients: an extinction and an albedo, or both coefficients.
struct OpticalProperties {
  float density_scale = 1;          ///< Multiplies the densities.
  Spectrum albedo{0.999F};          ///< sigma_s/sigma_t, where sigma_t is 1 per unit of density.
  std::optional<Spectrum> sigma_a;  ///< [1/m per unit of density] with sigma_s replaces the albedo;
  std::optional<Spectrum> sigma_s;  ///< of the two the one that is not given is 0.
  PhaseFunction phase = {};
  /// L_e; with temperatures, what multiplies their black bodies' radiance, 1 if it is not given.
  std::optional<Spectrum> emission;
  double temperature_scale = 1;   ///< [K per unit of the field]
  double temperature_offset = 0;  ///< Value of the field at 0 K.
};

/// Densities with one set of optical properties.
struct Volume {
  /// One, which acts on all channels, or those of R, G and B, each of which acts on its channel
  /// alone.
  std::vector<Field> densities;
  OpticalProperties optics;
  /// Temperatures, where it glows as black bodies of them (TemperatureEmission).
  std::shared_ptr<const Field> temperature = nullptr;
};

/// The daylight sky.
struct SkyEnvironment {};

/// What shines on the volume.
struct LightOptions {
  /// The sky, one radiance, or the name of a latitude-longitude image.
  std::variant<SkyEnvironment, Spectrum, std::string> environment = SkyEnvironment{};
  InvalidPolicy invalid = InvalidPolicy::kZero;  ///< For pixels of the image.
  bool sun = true;  ///< Whether its disc shines; it shapes the sky in any case.
  SunParameters sun_parameters{.elevation = 38, .azimuth = 255};
};

/// Where the camera stands; frames the whole volume where nothing is said.
struct CameraOptions {
  int width = 640;
  int height = 360;
  double fov = 40;            ///< Vertical [degrees].
  std::optional<Vec3d> from;  ///< [world]
  std::optional<Vec3d> at;    ///< [world]
};

/// Volumes as one medium.
struct VolumeMedium {
  std::shared_ptr<const Medium> medium;  ///< With coefficients in R, G and B (linear sRGB).
  /// Of its components, in their order, those that glow as black bodies; what the components emit
  /// multiplies that. May be shorter.
  std::vector<std::optional<TemperatureEmission>> temperatures = {};
};

/// The volumes' densities as components of one medium, in their order; they may overlap anyhow.
/// @param super_voxel edge of a super-voxel [voxels], 0 for automatic
/// @throws Error for coefficients out of range, another number of densities in a volume than one or
///   three, and as Medium
VolumeMedium make_medium(std::vector<Volume> volumes, int super_voxel);

/// @param medium what to frame where the options name no position
/// @throws Error as Camera and frame_points
Camera make_camera(const Medium& medium, const CameraOptions& options, UpAxis up);

/// What shines on a bare volume from everywhere around.
struct Surroundings {
  /// The same radiance from everywhere, in linear sRGB, or an image.
  std::variant<Spectrum, ImageEnvironment> environment = Spectrum(0.0F);
  std::optional<Sun> sun = {};
};

/// @param warnings gets what there is to say about the image, if not null
/// @throws Error as the environments and the image reader
Surroundings make_surroundings(const LightOptions& options, UpAxis up,
                               std::vector<std::string>* warnings = nullptr);

/// A scene of a medium that fills its own bounds, and nothing else. Colours become spectra as those
/// of scenes do, and are as given where R, G and B are rendered.
/// @throws Error for a radiance that is negative or not finite
PathScene make_volume_scene(const VolumeMedium& medium, const Camera& camera,
                            const Surroundings& surroundings);

/// Whether there is nothing in a medium: its densities are 0 everywhere.
bool is_empty(const Medium& medium);

}  // namespace freepath
