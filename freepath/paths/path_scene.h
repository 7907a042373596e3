#pragma once
/// @file A scene as paths see it.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/geometry/surfaces.h"
#include "freepath/lights/scene_lights.h"
#include "freepath/materials/material.h"
#include "freepath/materials/textures/texture_table.h"
#include "freepath/paths/media_set.h"
#include "freepath/paths/periodic_domain.h"
#include "freepath/paths/scene_medium.h"
#include "freepath/sensors/camera.h"
#include "freepath/sensors/pixel_filter.h"
#include "freepath/sensors/sample_sequence.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// What a shape of PathScene::surfaces is made of.
struct PathShape {
  std::optional<uint32_t> material;  ///< None: a boundary, where the medium alone changes.
  std::optional<uint32_t> light;     ///< Index in SceneLightsDescription::area_lights.
  /// The media on both sides, as MediaSet::cross takes them. Where they are the same, nothing
  /// changes.
  MediumId inside = kVacuum, outside = kVacuum;
  /// The share of it that is there, the same for all points or a texture; none: all of it. Where it
  /// is not, it is neither a surface nor a light nor a boundary.
  std::optional<FloatInput> alpha = {};

  /// Crosses its boundary.
  void cross(MediaSet& media, bool enters) const {
    if (alpha) {
      media.cross_porous(inside, outside, enters);
    } else {
      media.cross(inside, outside, enters);
    }
  }
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
  std::optional<Camera> camera;
  MediaSet camera_media;
  /// The domain that repeats, if any does. Along the axes that do not repeat all that is in the
  /// scene is in it; of surfaces that reach beyond its sides nothing is seen there.
  std::optional<PeriodicDomain> domain;
  float exposure_scale = 1;  ///< What the film multiplies radiance by.
  /// Balance of white: from R, G, B of the light to those of the film, before they are scaled.
  Imath::M33f white_balance;
  PixelFilter filter;
  SampleKind samples = SampleKind::kSobol;
  /// Tells of each medium whether no surface passes through its bounds and all of them are filled
  /// with it, so that flights that begin in them need not look for surfaces before they leave.
  std::vector<bool> is_clear;

  /// The share of a shape that is there at a point of it, [0, 1].
  float alpha_at(const SurfacePoint& point) const {
    const std::optional<FloatInput>& alpha = shapes[point.shape].alpha;
    if (!alpha) return 1;
    const float value = textures.evaluate(*alpha, point);
    return value > 0 ? std::min(value, 1.0F) : 0.0F;
  }

  /// Whether a surface bounds a medium.
  bool has_boundary(MediumId medium) const {
    return std::any_of(shapes.begin(), shapes.end(), [&](const PathShape& shape) {
      return shape.inside != shape.outside && (shape.inside == medium || shape.outside == medium);
    });
  }

  /// Whether a flight in a medium from this place need not look for surfaces.
  bool is_clear_at(MediumId medium, const Vec3f& position) const {
    const auto number = static_cast<std::size_t>(medium);
    return number < media.size() && is_clear[number] &&
           media[number].bounds().intersects(Vec3d(position) + origin);
  }

  /// How far a ray in a medium goes before it meets a surface; infinite where the medium is clear,
  /// which ends before surfaces do.
  float way_to_surface(MediumId medium, const Vec3f& position, const Vec3f& direction) const {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    if (!surfaces || is_clear_at(medium, position)) return kFar;
    const auto hit = surfaces->intersect(position, direction, 0, kFar);
    return hit ? hit->t : kFar;
  }
};

}  // namespace freepath
