#pragma once
/// @file The lights of a scene as plain data.
///
/// All have pbrt-v4's meaning [Pharr23]. Spectra are those of a SpectrumTable, of the role
/// kIlluminant; each is normalised (photometry.h) and then multiplied by `scale`. Images hold
/// linear sRGB, their first row is the top. `name` is what messages call the light.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "freepath/lights/emitter_geometry.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/sun.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// Pixels and what messages call them: the path of the file.
struct LightImage {
  std::string name;
  Image pixels;
};

/// Four corners of a rectangle in the world, in order. Light enters only through it, and arrives
/// only where (p3 - p0) × (p1 - p0) points to the rectangle: on its inner side.
using PortalCorners = std::array<Vec3d, 4>;

/// A light of the same radiance from everywhere.
struct ConstantInfiniteLight {
  std::string name = "infinite light";
  SpectrumId radiance = {};
  double scale = 1;
  /// Illuminance of a surface under one hemisphere of it; in place of what the radiance gives.
  std::optional<double> illuminance = {};
  std::optional<PortalCorners> portal = {};
};

/// How an image covers the sphere.
enum class SphereMapping {
  kOctahedral,  ///< A square of equal areas (octahedral.h), as pbrt-v4's.
  kLatLong,     ///< Latitude and longitude, as in environment.h, with y up.
};

/// An image around the scene.
struct ImageInfiniteLight {
  std::string name = "infinite light";
  LightImage image = {};
  SphereMapping mapping = SphereMapping::kOctahedral;
  double scale = 1;
  /// Illuminance of a surface whose normal is the light's z, which is up; in place of what the
  /// image gives.
  std::optional<double> illuminance = {};
  Matrix4d light_to_world = {};
  std::optional<PortalCorners> portal = {};
};

/// A sky or another lat-long image that was made elsewhere, in world coordinates.
struct EnvironmentLight {
  std::string name = "environment";
  ImageEnvironment environment;
  double scale = 1;
};

/// The sun's disc.
struct SunLight {
  std::string name = "sun";
  Sun sun;
  double scale = 1;
};

/// Parallel light.
struct DistantLight {
  std::string name = "distant light";
  SpectrumId radiance = {};  ///< Times scale: the irradiance of a surface that faces the light.
  double scale = 1;
  std::optional<double> illuminance = {};  ///< Takes the place of that irradiance.
  Vec3d from{0, 0, 0}, to{0, 0, 1};        ///< The light travels from here to there.
  Matrix4d light_to_world = {};
  /// Way from the light to whatever it shines on [world]: finite where fog fills all space, which
  /// would let nothing through.
  float distance = std::numeric_limits<float>::infinity();
};

/// A light of the same intensity in all directions.
struct PointLight {
  std::string name = "point light";
  SpectrumId intensity = {};
  double scale = 1;
  std::optional<double> power = {};  ///< Over all directions, in place of what the intensity gives.
  Vec3d from{0, 0, 0};
  Matrix4d light_to_world = {};
};

/// A cone of light with a soft edge.
struct SpotLight {
  std::string name = "spot light";
  SpectrumId intensity = {};  ///< Intensity on its axis.
  double scale = 1;
  std::optional<double> power = {};
  Vec3d from{0, 0, 0}, to{0, 0, 1};
  double cone_angle = 30;       ///< Half the opening, where there is no light any more [degrees].
  double cone_delta_angle = 5;  ///< Width of the edge [degrees].
  Matrix4d light_to_world = {};
};

/// A point with an image of its intensity in all directions.
struct GoniometricLight {
  std::string name = "goniometric light";
  SpectrumId intensity = {};             ///< Intensity where the image is 1.
  std::optional<LightImage> image = {};  ///< Octahedral, its y the z of the map; 1 without it.
  double scale = 1;
  std::optional<double> power = {};
  Matrix4d light_to_world = {};
};

/// A projector of slides at a point; the light's z is the direction, y is up.
struct ProjectionLight {
  std::string name = "projection light";
  LightImage image = {};  ///< Image of the intensity.
  double fov = 90;        ///< Opening angle of the shorter side of the image [degrees].
  double scale = 1;
  std::optional<double> power = {};
  Matrix4d light_to_world = {};
};

using LightDescription =
    std::variant<ConstantInfiniteLight, ImageInfiniteLight, EnvironmentLight, SunLight,
                 DistantLight, PointLight, SpotLight, GoniometricLight, ProjectionLight>;

/// The emission of surfaces: the same radiance in all directions.
struct AreaEmission {
  std::string name = "area light";
  SpectrumId radiance = {};
  /// Image of the radiance, in place of the spectrum; (u, v) = (0, 0) is its lower left corner.
  std::optional<LightImage> image = {};
  double scale = 1;
  std::optional<double> power = {};  ///< Power of each part (triangle) of the shape.
  bool two_sided = false;            ///< Else it shines only to the side of the normal.
};

/// A shape that shines.
struct AreaLight {
  std::shared_ptr<const EmitterGeometry> geometry;
  uint32_t emission = 0;   ///< Index in SceneLightsDescription::emissions.
  bool reversed = false;   ///< It shines to the side where its normal doesn't point.
  bool invisible = false;  ///< No ray hits it, though it shines (an alpha of 0).
};

/// All lights of a scene.
struct SceneLightsDescription {
  std::vector<LightDescription> lights;
  std::vector<AreaEmission> emissions;
  std::vector<AreaLight> area_lights;
  Vec3d origin{0};  ///< Origin of the rays [world]; what is drawn and asked is relative to it.
};

}  // namespace freepath
