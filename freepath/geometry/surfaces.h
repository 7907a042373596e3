#pragma once
/// @file The surfaces of a scene, to be met by rays.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/boundary_crossings.h"
#include "freepath/geometry/ray_position.h"
#include "freepath/geometry/shape_geometry.h"
#include "freepath/geometry/surface_point.h"

namespace freepath {

/// Where a ray meets a surface.
struct SurfaceHit {
  float t = 0;  ///< position = origin + t direction
  SurfacePoint point;
  bool from_inside = false;         ///< The ray leaves the shape: direction · normal > 0.
  uint32_t instance = kNoInstance;  ///< Index in SurfaceScene::instances.
  RayPosition position;
  bool is_tied = false;  ///< Another surface is at the same position; see Surfaces::find_ties.
};

/// A surface at the position of another.
struct TiedSurface {
  RayPosition position;
  uint32_t shape = 0;
  bool enters = false;  ///< direction · normal < 0
  float u = 0, v = 0;   ///< Parameters on the primitive; for Surfaces::describe.
};

/// Where a shadow ray ends.
struct ShadowEnd {
  float distance = 0;  ///< [t]
  /// The point on a shape that it ends at, which is not in its own shadow, nor in that of a surface
  /// at the same position; SurfacePoint::shape and primitive.
  struct Target {
    uint32_t shape = 0, primitive = 0;
  };
  std::optional<Target> target = {};
};

/// A sphere that is neither cut nor distorted, nor in an instance, whose outside is outside.
struct WholeSphere {
  uint32_t shape = 0, primitive = 0;  ///< Of SurfacePoint.
  Vec3d center;                       ///< [world, relative to the origin of the rays]
  double radius = 0;                  ///< [world]
};

/// What surfaces cost, counted, so that tests see how it grows.
struct SurfaceCosts {
  uint64_t positions = 0;  ///< Positions of meshes that were looked at for bounds.
  uint64_t bytes = 0;      ///< Held by Embree.
};

/// All surfaces of a scene. Positions are floats relative to `origin` of the constructor [world];
/// directions need not be unit vectors, and t counts in their length. What is const may be called
/// by any number of threads, and allocates nothing.
///
/// Triangles are found in floats, quadrics and patches in doubles; where on the ray they are, and
/// which is the nearest, is decided in doubles, for the surfaces as they were rounded to floats.
/// Surfaces at one position are all met: find_ties() tells which are there.
class Surfaces {
 public:
  /// @param origin that positions are relative to [world]: near what is seen
  /// @throws Error for bad geometry, beginning with the number of the shape
  Surfaces(const SurfaceScene& scene, const Vec3d& origin);
  ~Surfaces();
  Surfaces(Surfaces&&) noexcept;
  Surfaces& operator=(Surfaces&&) noexcept;

  const Vec3d& origin() const;
  /// The box around all surfaces [world, relative to the origin]; empty if nothing is.
  Box3f bounds() const;

  SurfaceCosts costs() const;
  /// All spheres of that kind.
  std::vector<WholeSphere> whole_spheres() const;

  /// The nearest surface at t in (t_min, t_max), boundaries included.
  /// @param looked_at counts the surfaces that were tried; may be null
  std::optional<SurfaceHit> intersect(const Vec3f& origin, const Vec3f& direction, float t_min,
                                      float t_max, uint64_t* looked_at = nullptr) const;
  /// All other surfaces at the position where a ray meets one, in the order of their positions,
  /// each once even on the common edge of two triangles. `ties` is overwritten.
  /// @param hit of this ray
  void find_ties(const Vec3f& origin, const Vec3f& direction, const SurfaceHit& hit,
                 std::vector<TiedSurface>& ties) const;
  /// A tied surface as if the ray had met it alone.
  SurfaceHit describe(const Vec3f& origin, const Vec3f& direction, const TiedSurface& tied) const;
  /// Whether a ray from a point near the position, in the direction of the ray that met it there,
  /// starts beyond the surface, so that it won't meet it (again).
  bool is_beyond(const RayPosition& position, const Vec3f& origin, const Vec3f& direction) const;

  /// Whether any shape but boundaries is met at t in (0, end). If none is, `crossings` are those
  /// of the boundaries; otherwise they are of no use.
  /// @param after crossings up to this one are left out: the last of those that overflowed
  bool occluded(const Vec3f& origin, const Vec3f& direction, const ShadowEnd& end,
                BoundaryCrossings& crossings, const RayPosition* after = nullptr) const;

  /// Whether a position on a shadow ray is the point that it ends at, and not another one of the
  /// same primitive, which may lie in its own shadow.
  /// @param end its distance from this origin
  bool is_end(const Vec3f& origin, const Vec3f& direction, const RayPosition& position,
              const ShadowEnd& end) const;

  /// All surfaces on a ray in the order of their positions, whatever they are made of, each once
  /// even on the common edge of two triangles. Allocates: for the time of loading.
  std::vector<BoundaryCrossing> all_crossings(const Vec3f& origin, const Vec3f& direction) const;

  /// The origin of a ray that leaves a point of these surfaces, so that it does not meet the same
  /// position again: off the surface along its normal, to the side of the direction, by a few
  /// roundings of the position.
  Vec3f offset_ray_origin(const SurfacePoint& point, const Vec3f& direction) const;

  /// Whether any of these shapes, in any instance, may have a point in the box; false only if none
  /// has. Looks at every triangle: for the time of loading.
  /// @param shapes SurfaceShape::shape
  /// @param box [world, not relative to the origin]
  bool intersects_box(std::span<const uint32_t> shapes, const OrientedBox& box) const;

  /// Directions along no edge of anything that is built along axes or diagonals, of rays that vote
  /// on what is around a point.
  static inline const std::array<Vec3f, 3> kProbes = {Vec3f(0.5377F, 0.6211F, 0.5703F),
                                                      Vec3f(-0.7321F, 0.3187F, -0.6021F),
                                                      Vec3f(0.2239F, -0.8623F, -0.4541F)};

  /// Whether these shapes together enclose the point, whichever way their normals point: by the
  /// parity of crossings, three rays voting. Of use for closed shapes alone.
  bool is_inside(const Vec3f& point, std::span<const uint32_t> shapes) const;

 private:
  class Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace freepath
