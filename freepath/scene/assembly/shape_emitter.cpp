#include "freepath/scene/assembly/shape_emitter.h"

#include <variant>

#include "freepath/base/box.h"

namespace freepath {
namespace {

/// Boxes of the parts of a shape; flat ones face one way.
class BoundsOf {
 public:
  BoundsOf(const SurfaceShape& shape, const Vec3d& origin) : shape_(shape), origin_(origin) {}

  std::vector<EmitterBounds> operator()(const TriangleMesh& mesh) const {
    std::vector<EmitterBounds> bounds;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      EmitterBounds part;
      Vec3f corners[3];
      for (int corner = 0; corner < 3; ++corner) {
        corners[corner] = from_object(mesh.positions[mesh.indices[i + corner]]);
        part.box.extendBy(corners[corner]);
      }
      // Which of both sides it faces, a mesh with normals may decide otherwise.
      const Vec3f normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      part.axis = normal.length() > 0 ? normal.normalized() : Vec3f(0, 0, 1);
      part.cosine_spread = -1;
      bounds.push_back(part);
    }
    return bounds;
  }

  std::vector<EmitterBounds> operator()(const BilinearMesh& mesh) const {
    std::vector<EmitterBounds> bounds;
    for (std::size_t i = 0; i + 3 < mesh.indices.size(); i += 4) {
      EmitterBounds part = all_around();
      for (int corner = 0; corner < 4; ++corner) {
        part.box.extendBy(from_object(mesh.positions[mesh.indices[i + corner]]));
      }
      bounds.push_back(part);
    }
    return bounds;
  }

  std::vector<EmitterBounds> operator()(const Sphere& sphere) const {
    return box(Vec3d(-sphere.radius), Vec3d(sphere.radius));
  }
  std::vector<EmitterBounds> operator()(const Disk& disk) const {
    return box({-disk.radius, -disk.radius, disk.height}, {disk.radius, disk.radius, disk.height});
  }
  std::vector<EmitterBounds> operator()(const Cylinder& cylinder) const {
    return box({-cylinder.radius, -cylinder.radius, cylinder.z_min},
               {cylinder.radius, cylinder.radius, cylinder.z_max});
  }

 private:
  static EmitterBounds all_around() {
    EmitterBounds bounds;
    bounds.cosine_spread = -1;
    return bounds;
  }
  Vec3f from_object(const Vec3d& point) const {
    return Vec3f(point * shape_.object_to_world - origin_);
  }
  std::vector<EmitterBounds> box(const Vec3d& low, const Vec3d& high) const {
    EmitterBounds bounds = all_around();
    for (const Vec3d& corner : corners_of({low, high})) bounds.box.extendBy(from_object(corner));
    return {bounds};
  }

  const SurfaceShape& shape_;
  Vec3d origin_;
};

}  // namespace

ShapeEmitter::ShapeEmitter(const SurfaceShape& shape, const Vec3d& origin)
    : shape_(shape, origin), bounds_(std::visit(BoundsOf(shape, origin), shape.geometry)) {
  for (uint32_t part = 0; part < bounds_.size(); ++part) {
    bounds_[part].area = shape_.area(shape_.first_primitive() + part);
  }
}

EmitterPoint ShapeEmitter::sample(uint32_t part, const Vec3f& reference, float u0, float u1) const {
  const AreaSample drawn = shape_.sample_from(reference, shape_.first_primitive() + part, u0, u1);
  return {drawn.position, drawn.normal, drawn.u, drawn.v, drawn.pdf};
}

}  // namespace freepath
