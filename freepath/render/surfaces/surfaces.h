#pragma once
/// @file The surfaces of a scene, to be met by rays.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "freepath/base/vector.h"
#include "freepath/render/surfaces/shape_geometry.h"
#include "freepath/render/surfaces/surface_point.h"

namespace freepath {

/// SurfaceHit::instance of shapes that are in no group.
inline constexpr uint32_t kNoInstance = 0xFFFFFFFF;

/// Where a ray meets a surface.
struct SurfaceHit {
  float t = 0;  ///< position = origin + t direction
  SurfacePoint point;
  bool from_inside = false;         ///< The ray leaves the shape: direction · normal > 0.
  uint32_t instance = kNoInstance;  ///< Of SurfaceScene::instances.
};

/// Where a ray goes through a shape that is a mere boundary.
struct BoundaryCrossing {
  float t = 0;
  uint32_t shape = 0;
  uint32_t instance = kNoInstance;
  bool enters = false;  ///< direction · normal < 0
};

/// The nearest crossings of a ray in ascending order of t, each once even where the ray goes
/// through the common edge of two triangles.
class BoundaryCrossings {
 public:
  static constexpr uint32_t kCapacity = 32;

  std::span<const BoundaryCrossing> all() const { return {crossings_.data(), count_}; }
  bool empty() const { return count_ == 0; }
  /// There are more, all of them beyond the last of these: go on with a ray from there.
  bool overflowed() const { return overflowed_; }

  void clear();
  void add(const BoundaryCrossing& crossing);

 private:
  std::array<BoundaryCrossing, kCapacity> crossings_;
  uint32_t count_ = 0;
  bool overflowed_ = false;
};

/// All surfaces of a scene. Positions are floats relative to `origin` of the constructor [world];
/// directions need not be unit vectors, and t counts in their length. What is const may be called
/// by any number of threads, and allocates nothing.
///
/// Triangles are traced in floats and quadrics and patches in doubles; whether a hit lies beyond
/// t_min is decided in doubles, for the surface as it was rounded to floats.
class Surfaces {
 public:
  /// @param origin that positions are relative to [world]: near what is seen
  /// @throws Error for bad geometry, beginning with the number of the shape
  Surfaces(const SurfaceScene& scene, const Vec3d& origin);
  ~Surfaces();
  Surfaces(Surfaces&&) noexcept;
  Surfaces& operator=(Surfaces&&) noexcept;

  const Vec3d& origin() const;
  /// Around all that is there [world, relative to the origin]; empty if nothing is.
  Box3f bounds() const;

  /// The nearest surface at t in (t_min, t_max), boundaries included.
  std::optional<SurfaceHit> intersect(const Vec3f& origin, const Vec3f& direction, float t_min,
                                      float t_max) const;
  /// Whether any shape but boundaries is met at t in (0, t_max). If none is, `crossings` are those
  /// of the boundaries; otherwise they are of no use.
  bool occluded(const Vec3f& origin, const Vec3f& direction, float t_max,
                BoundaryCrossings& crossings) const;

  /// Where a ray starts that leaves a point of these surfaces, so that it does not meet the same
  /// place again: off the surface along its normal, to the side of the direction, by a few
  /// roundings of the position.
  Vec3f offset_ray_origin(const SurfacePoint& point, const Vec3f& direction) const;

  /// Whether any of these shapes, in any instance, may have a point in the box; false only if none
  /// has. Looks at every triangle: for the time of loading.
  /// @param shapes SurfaceShape::shape
  /// @param box [world, not relative to the origin]
  bool intersects_box(std::span<const uint32_t> shapes, const Box3d& box) const;

  /// Whether these shapes together enclose the point, whichever way their normals point: by the
  /// parity of crossings, three rays voting. Of use for closed shapes alone.
  bool is_inside(const Vec3f& point, std::span<const uint32_t> shapes) const;

 private:
  class Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace freepath
