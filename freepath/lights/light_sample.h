#pragma once
/// @file What light sampling returns.

#include <cstdint>
#include <limits>
#include <optional>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"

namespace freepath {

/// A direction drawn towards a light. The estimate of what arrives is radiance / pdf, for every
/// kind of light.
struct LightSample {
  Vec3f direction{0, 0, 1};  ///< Unit vector from the point to the light [world].
  /// Distance to the light; infinite for one from outside of the scene.
  float distance = std::numeric_limits<float>::infinity();
  /// Radiance from this direction, of all lights outside of the scene together that are drawn; of a
  /// light without extent the irradiance of a surface that faces it.
  SampledSpectrum radiance;
  /// Density of the direction, times the probability of choosing the light [1/sr]; of a light
  /// without extent that probability alone. With 0 the draw is to be dropped.
  float pdf = 0;
  /// An area light, as an index in SceneLightsDescription::area_lights, and of the point
  /// SurfacePoint's.
  struct Area {
    uint32_t light = 0, primitive = 0;
    Vec3f normal{0, 0, 1};
    float u = 0, v = 0;
  };
  std::optional<Area> area = {};
  /// Number of SceneLights::within(), if it is of those.
  std::optional<uint32_t> within = {};
  /// No ray finds this light by chance, so that the draw has the whole weight.
  bool delta = false;
};

/// View of lights along a ray.
struct LightSeen {
  SampledSpectrum radiance;  ///< Of lights that are drawn: a draw finds it too.
  /// Density with which SceneLights::sample would have drawn the ray's direction at its start
  /// [1/sr].
  float pdf = 0;
  SampledSpectrum undrawn = {};  ///< Radiance of lights that are never drawn: rays alone find it.

  SampledSpectrum all() const { return radiance + undrawn; }
};

}  // namespace freepath
