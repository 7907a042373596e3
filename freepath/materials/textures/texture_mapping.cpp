#include "freepath/materials/textures/texture_mapping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freepath {

TextureCoordinates UvMapping::operator()(const TexturePoint& point) const {
  return {uscale * point.surface.u + udelta, vscale * point.surface.v + vdelta};
}

TextureCoordinates PlanarTextureMapping::operator()(const TexturePoint& point) const {
  const Vec3d p = point.position * texture_from_world;
  return {static_cast<float>(p.dot(v1) + udelta), static_cast<float>(p.dot(v2) + vdelta)};
}

TextureCoordinates SphericalTextureMapping::operator()(const TexturePoint& point) const {
  const Vec3d p = point.position * texture_from_world;
  const double theta = std::atan2(std::hypot(p.x, p.y), p.z);
  double turns = std::atan2(p.y, p.x) * (0.5 * std::numbers::inv_pi);
  if (turns < 0) turns += 1;
  return {static_cast<float>(theta * std::numbers::inv_pi), static_cast<float>(turns)};
}

TextureCoordinates CylindricalTextureMapping::operator()(const TexturePoint& point) const {
  const Vec3d p = point.position * texture_from_world;
  return {static_cast<float>(0.5 + std::atan2(p.y, p.x) * (0.5 * std::numbers::inv_pi)),
          static_cast<float>(p.z)};
}

}  // namespace freepath
