#include "freepath/scene/assembly/build_shapes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/geometry/loop_subdivision.h"
#include "freepath/geometry/ply_file.h"
#include "freepath/geometry/surfaces.h"
#include "freepath/scene/assembly/build_inputs.h"
#include "freepath/scene/assembly/build_lights.h"
#include "freepath/scene/assembly/build_media.h"
#include "freepath/scene/assembly/entity_kinds.h"
#include "freepath/scene/assembly/shape_emitter.h"

namespace freepath {
namespace {

std::vector<int> indices_of(const ParameterList& list, std::size_t positions, int corners) {
  const std::span<const int> given = list.get_integers("indices");
  if (!given.empty()) return {given.begin(), given.end()};
  // One face needs no indices.
  if (positions != static_cast<std::size_t>(corners)) {
    fail_at(list.location(), "'indices' is missing: there are {} positions, and one face has {}",
            positions, corners);
  }
  std::vector<int> indices(corners);
  for (int i = 0; i < corners; ++i) indices[i] = i;
  return indices;
}

template <class Mesh>
Mesh read_mesh(const ParameterList& list, int corners) {
  Mesh mesh;
  mesh.positions = list.get_points("P");
  for (const Vec3d& normal : list.get_normals("N")) mesh.normals.emplace_back(normal);
  const std::vector<Vec2d> uvs = list.get_point2s("uv");
  for (const Vec2d& uv : uvs) mesh.uvs.emplace_back(uv);
  mesh.indices = indices_of(list, mesh.positions.size(), corners);
  return mesh;
}

using Geometries = std::vector<ShapeGeometry>;

Geometries read_sphere(BuildContext& /*context*/, const ParameterList& list) {
  const double radius = list.get_float("radius", 1);
  return {Sphere{radius, list.get_float("zmin", -radius), list.get_float("zmax", radius),
                 list.get_float("phimax", 360)}};
}

Geometries read_disk(BuildContext& /*context*/, const ParameterList& list) {
  return {Disk{list.get_float("height", 0), list.get_float("radius", 1),
               list.get_float("innerradius", 0), list.get_float("phimax", 360)}};
}

Geometries read_cylinder(BuildContext& /*context*/, const ParameterList& list) {
  return {Cylinder{list.get_float("radius", 1), list.get_float("zmin", -1),
                   list.get_float("zmax", 1), list.get_float("phimax", 360)}};
}

template <class Mesh, int kCorners>
Geometries read_faces(BuildContext& /*context*/, const ParameterList& list) {
  return {read_mesh<Mesh>(list, kCorners)};
}

Geometries read_ply_mesh(BuildContext& context, const ParameterList& list) {
  const std::string file = file_of(context, list, "filename").string();
  return at_location(list.location_of("filename"), [&] { return read_ply(file).shapes(); });
}

Geometries read_loop_subdivision(BuildContext& /*context*/, const ParameterList& list) {
  const std::vector<Vec3d> positions = list.get_points("P");
  const std::vector<int> indices = indices_of(list, positions.size(), 3);
  return {subdivide_loop(positions, indices, list.get_integer("levels", 3))};
}

constexpr EntityKind<Geometries (*)(BuildContext&, const ParameterList&)> kShapes[] = {
    {"bilinearmesh", read_faces<BilinearMesh, 4>},
    {"cylinder", read_cylinder},
    {"disk", read_disk},
    {"loopsubdiv", read_loop_subdivision},
    {"plymesh", read_ply_mesh},
    {"sphere", read_sphere},
    {"trianglemesh", read_faces<TriangleMesh, 3>}};

/// Builds shapes one after the other.
class ShapeBuilder {
 public:
  explicit ShapeBuilder(BuildContext& context) : context_(context) {}

  BuiltShapes build() {
    built_.surfaces.groups.resize(context_.pbrt.objects.size());
    for (const PbrtAreaLight& light : context_.pbrt.area_lights) {
      built_.emissions.push_back(build_emission(context_, light));
    }
    for (const PbrtShape& shape : context_.pbrt.shapes) {
      at_location(shape.location, [&] { add(shape); });
      shape.parameters.report_unused(context_.diagnostics);
    }
    for (const PbrtInstance& instance : context_.pbrt.instances) {
      if (instance.world_from_instance.is_animated()) {
        context_.diagnostics.warn(instance.location, kMoves);
      }
      if (built_.surfaces.groups[instance.object].empty()) continue;
      built_.surfaces.instances.push_back(
          {static_cast<uint32_t>(instance.object), instance.world_from_instance.start});
    }
    return std::move(built_);
  }

 private:
  static constexpr const char* kMoves =
      "moving shapes are not supported: this one stands as at the start";

  void add(const PbrtShape& shape) {
    if (shape.world_from_object.is_animated()) context_.diagnostics.warn(shape.location, kMoves);
    PathShape path_shape;
    path_shape.material = context_.materials[shape.material];
    path_shape.inside = medium_of(context_, shape.inside_medium);
    path_shape.outside = medium_of(context_, shape.outside_medium);
    path_shape.alpha = read_alpha(shape);
    const bool is_there = path_shape.alpha != FloatInput(0.0F);
    const bool boundary = !path_shape.material;
    const bool shines = shape.area_light && !boundary && !shape.object;
    if (shape.area_light && !shines) {
      context_.diagnostics.warn(shape.location,
                                boundary ? "an 'interface' is no light: this one stays dark"
                                         : "shapes of objects are no lights: this one stays dark");
    }
    for (ShapeGeometry& geometry : maker_of(shape, "shape", kShapes)(context_, shape.parameters)) {
      // Each part of a file is a shape of its own, for it is a light of its own.
      const auto number = static_cast<uint32_t>(built_.shapes.size());
      SurfaceShape surface{std::move(geometry), shape.world_from_object.start,
                           shape.reverse_orientation, boundary, number};
      check(surface);
      if (shines) {
        path_shape.light = static_cast<uint32_t>(built_.emitters.size());
        built_.emitters.push_back(
            {is_there ? built_.surfaces.shapes.size() : built_.invisible.size(),
             static_cast<uint32_t>(*shape.area_light), number, !is_there});
      }
      if (!is_there) {
        if (shines) built_.invisible.push_back(std::move(surface));
        continue;
      }
      built_.shapes.push_back(path_shape);
      auto& shapes = shape.object ? built_.surfaces.groups[*shape.object] : built_.surfaces.shapes;
      shapes.push_back(std::move(surface));
    }
  }

  /// The share of a shape that rays meet; none: all of it. One of alpha 0 everywhere is no surface
  /// and no boundary of media, but its light shines, as in pbrt.
  std::optional<FloatInput> read_alpha(const PbrtShape& shape) {
    const FloatInput alpha = float_input(context_, shape.parameters, "alpha", 1);
    const std::optional<float> constant = context_.scene.textures.constant(alpha);
    if (!constant) return alpha;
    if (*constant >= 1) return std::nullopt;
    return std::max(0.0F, *constant);
  }

  BuildContext& context_;
  BuiltShapes built_;
};

}  // namespace

BuiltShapes build_shapes(BuildContext& context) { return ShapeBuilder(context).build(); }

std::vector<AreaLight> build_area_lights(const BuiltShapes& shapes, const Vec3d& origin) {
  std::vector<AreaLight> lights;
  for (const BuiltShapes::Emitter& emitter : shapes.emitters) {
    const auto& list = emitter.is_invisible ? shapes.invisible : shapes.surfaces.shapes;
    lights.push_back({std::make_shared<const ShapeEmitter>(list[emitter.surface], origin),
                      emitter.emission, false, emitter.is_invisible});
  }
  return lights;
}

Box3d extent_of(const SurfaceScene& surfaces) {
  if (surfaces.shapes.empty() && surfaces.instances.empty()) return {};
  const auto around = [&](const Vec3d& origin) {
    const Box3f bounds = Surfaces(surfaces, origin).bounds();
    if (bounds.isEmpty()) return Box3d();
    return Box3d(Vec3d(bounds.min) + origin, Vec3d(bounds.max) + origin);
  };
  const Box3d extent = around(Vec3d(0));
  if (extent.isEmpty()) return {};
  // Far from the origin floats are coarse.
  constexpr double kFar = 16;  // sizes
  const Vec3d center = extent.center();
  return center.length() > kFar * extent.size().length() ? around(center) : extent;
}

}  // namespace freepath
