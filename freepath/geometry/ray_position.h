#pragma once
/// @file Positions on a ray where it meets surfaces.

#include <cstdint>
#include <tuple>

namespace freepath {

/// SurfaceHit::instance of shapes that are in no group.
inline constexpr uint32_t kNoInstance = 0xFFFFFFFF;

/// Name of an intersection of a ray with all surfaces: the same for the same ray, whatever else
/// there is.
struct SurfaceKey {
  uint32_t instance = kNoInstance;  ///< Index in SurfaceScene::instances.
  uint32_t geometry = 0;            ///< Number of the geometry among what traces the shapes.
  uint32_t primitive = 0;           ///< Number of the primitive in its geometry.
  uint32_t root = 0;                ///< Which of the points where a line meets the primitive.

  friend bool operator==(const SurfaceKey&, const SurfaceKey&) = default;
  friend bool operator<(const SurfaceKey& a, const SurfaceKey& b) {
    return std::tie(a.instance, a.geometry, a.primitive, a.root) <
           std::tie(b.instance, b.geometry, b.primitive, b.root);
  }
};

/// A position on a ray where a surface is met, in double precision.
struct RayPosition {
  double t = 0;  ///< position = origin + t direction
  /// Surfaces no farther than this along the ray are at the same position [t]: a new ray from here
  /// may start on either side of them, since positions in floats tell them apart no better.
  double reach = 0;
  SurfaceKey key;

  /// Whether a ray meets this before the other; a strict order.
  bool is_before(const RayPosition& other) const {
    return t < other.t || (t == other.t && key < other.key);
  }
  bool is_tied(const RayPosition& other) const {
    const double gap = t < other.t ? other.t - t : t - other.t;
    return gap <= reach || gap <= other.reach;
  }
};

}  // namespace freepath
