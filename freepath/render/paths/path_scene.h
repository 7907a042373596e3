#pragma once
/// @file A scene as paths see it.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/render/cameras/pixel_filter.h"
#include "freepath/render/cameras/sample_sequence.h"
#include "freepath/render/cameras/scene_camera.h"
#include "freepath/render/lights/scene_lights.h"
#include "freepath/render/materials/material.h"
#include "freepath/render/paths/scene_medium.h"
#include "freepath/render/surfaces/surfaces.h"
#include "freepath/render/textures/texture_table.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// A medium of PathScene::media, or none.
using MediumId = int32_t;
inline constexpr MediumId kVacuum = -1;

/// What a shape of PathScene::surfaces is made of.
struct PathShape {
  std::optional<uint32_t> material;  ///< None: a boundary, where the medium alone changes.
  std::optional<uint32_t> light;     ///< Of SceneLightsDescription::area_lights.
  /// The media on both sides. Where they are the same, a path keeps the one that it is in.
  MediumId inside = kVacuum, outside = kVacuum;
};

/// How channels are made.
enum class ColorMode {
  kRgb,       ///< R, G, B.
  kSpectral,  ///< Four wavelengths of each sample.
};

/// A scene as paths see it. Positions in floats are relative to `origin`. Immutable while it is
/// rendered.
struct PathScene {
  Vec3d origin{0};
  std::unique_ptr<SpectrumTable> spectra;
  TextureTable textures;
  std::vector<SceneMedium> media;
  std::vector<Material> materials;
  std::vector<PathShape> shapes;
  std::optional<Surfaces> surfaces;  ///< None where there are no shapes.
  std::optional<SceneLights> lights;
  std::optional<SceneCamera> camera;
  MediumId camera_medium = kVacuum;
  float exposure_scale = 1;  ///< What the film multiplies radiance by.
  PixelFilter filter;
  SampleKind samples = SampleKind::kSobol;
  /// Of each medium: whether no surface passes through its bounds and all of them are filled with
  /// it, so that flights that begin in them need not look for surfaces before they leave.
  std::vector<bool> is_clear;
};

}  // namespace freepath
