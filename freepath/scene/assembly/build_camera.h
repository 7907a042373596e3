#pragma once
/// @file From camera, film, filter, sampler and integrator of a description to what renders it.

#include <cstdint>
#include <optional>
#include <string>

#include "freepath/scene/assembly/build_context.h"
#include "freepath/sensors/pixel_window.h"
#include "freepath/sensors/wavelength_buckets.h"

namespace freepath {

/// What a scene wants of its picture, where whoever renders it says nothing else.
struct PictureSettings {
  uint32_t samples = 16;  ///< Samples of each pixel.
  uint64_t seed = 0;
  /// Scatterings of a path; 5 in pbrt, where an integrator says nothing.
  uint32_t max_scatterings = 5;
  std::string file_name;      ///< Name of the film's file; may be empty.
  float exposure_scale = 1;   ///< What the film's sensor multiplies radiance by.
  Matrix3d white_balance;     ///< Map from R, G, B to R, G, B; that of the film's sensor.
  bool all_layers = false;    ///< A film of type 'gbuffer'.
  WavelengthBuckets buckets;  ///< Buckets of a film of type 'spectral'.
  std::optional<Crop> crop;   ///< Crop in fractions, which any size of the film has.
  // Of our own parameters of the integrator; empty where they are not given.
  std::string tracker, transmittance;
  std::optional<Interpolation> interpolation;
};

/// @throws Error with file:line:column
PictureSettings build_picture(BuildContext& context, FilmSize& size);

/// Fills PathScene::camera, camera_media and filter. Media have to be named already.
/// @throws Error with file:line:column
void build_camera(BuildContext& context, const FilmSize& size);

}  // namespace freepath
