#pragma once
/// @file From points of surfaces to the coordinates of textures. Names, parameters and meaning are
/// those of pbrt-v4.

#include <variant>

#include "freepath/base/vector.h"
#include "freepath/geometry/surface_point.h"

namespace freepath {

/// A point that a texture is looked up at.
struct TexturePoint {
  const SurfacePoint& surface;
  Vec3d position;  ///< [world]
};

/// Coordinates of a texture that is flat.
struct TextureCoordinates {
  float s, t;
};

/// `uv`: from the texture coordinates of a surface, s = uscale · u + udelta,
/// t = vscale · v + vdelta.
struct UvMapping {
  float uscale = 1, vscale = 1;
  float udelta = 0, vdelta = 0;

  TextureCoordinates operator()(const TexturePoint& point) const;
};

/// `planar`: s = p · v1 + udelta, t = p · v2 + vdelta of the point p in the texture's space.
struct PlanarTextureMapping {
  Matrix4d texture_from_world;
  Vec3d v1{1, 0, 0}, v2{0, 1, 0};
  double udelta = 0, vdelta = 0;

  TextureCoordinates operator()(const TexturePoint& point) const;
};

/// `spherical`: s = θ / π from the z axis of the texture's space, t = φ / 2π around it, in [0, 1).
struct SphericalTextureMapping {
  Matrix4d texture_from_world;

  TextureCoordinates operator()(const TexturePoint& point) const;
};

/// `cylindrical`: s = (π + φ) / 2π around the z axis of the texture's space, with φ in (-π, π];
/// t = z.
struct CylindricalTextureMapping {
  Matrix4d texture_from_world;

  TextureCoordinates operator()(const TexturePoint& point) const;
};

using TextureMapping = std::variant<UvMapping, PlanarTextureMapping, SphericalTextureMapping,
                                    CylindricalTextureMapping>;

inline TextureCoordinates mapped(const TextureMapping& mapping, const TexturePoint& point) {
  return std::visit([&](const auto& kind) { return kind(point); }, mapping);
}

/// The map to the space of a texture that fills it.
struct SolidMapping {
  Matrix4d texture_from_world;

  Vec3d operator()(const TexturePoint& point) const { return point.position * texture_from_world; }
};

}  // namespace freepath
