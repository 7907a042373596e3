#include "freepath/geometry/area_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "freepath/base/error.h"
#include "freepath/base/tangent_frame.h"
#include "freepath/geometry/spherical_triangle.h"
#include "freepath/geometry/traced_shapes.h"

namespace freepath {

namespace {

AreaSample to_sample(const LocalPoint& point, double pdf) {
  return {Vec3f(point.position), Vec3f(point.normal.normalized()), point.uv.x, point.uv.y,
          std::isfinite(pdf) ? static_cast<float>(pdf) : 0};
}

/// From a density per area to one per solid angle; 0 for a surface seen edge on.
double per_solid_angle(double per_area, const Vec3d& from, const Vec3d& position,
                       const Vec3d& unit_normal) {
  const Vec3d towards = position - from;
  const double distance2 = towards.length2();
  const double across = std::abs(towards.dot(unit_normal));
  return across > 0 ? per_area * distance2 * std::sqrt(distance2) / across : 0;
}

}  // namespace

/// What the kinds of primitive differ in. Numbers of primitives begin with 0 here.
class AreaShape::Kind {
 public:
  Kind() = default;
  Kind(const Kind&) = delete;
  Kind& operator=(const Kind&) = delete;
  virtual ~Kind() = default;

  virtual uint32_t count() const = 0;
  virtual double area(uint32_t primitive) const = 0;
  virtual AreaSample sample(uint32_t primitive, float u0, float u1) const = 0;
  virtual double pdf(uint32_t primitive, const SurfacePoint& point) const = 0;

  virtual AreaSample sample_from(const Vec3f& from, uint32_t primitive, float u0, float u1) const {
    AreaSample drawn = sample(primitive, u0, u1);
    const double converted =
        per_solid_angle(drawn.pdf, Vec3d(from), Vec3d(drawn.position), Vec3d(drawn.normal));
    drawn.pdf = static_cast<float>(converted);
    return drawn;
  }
  virtual double pdf_from(const Vec3f& from, uint32_t primitive, const SurfacePoint& point) const {
    return per_solid_angle(pdf(primitive, point), Vec3d(from), Vec3d(point.position),
                           Vec3d(point.normal));
  }

  uint32_t first = 0;
};

class AreaShape::TriangleKind : public Kind {
 public:
  TriangleKind(const SurfaceShape& shape, const Vec3d& origin)
      : mesh_(trace_triangles(shape, origin)) {}

  uint32_t count() const override { return mesh_.count(); }
  double area(uint32_t triangle) const override {
    return 0.5 * mesh_.plane_normal(triangle).length();
  }
  AreaSample sample(uint32_t triangle, float u0, float u1) const override {
    const float root = std::sqrt(u0);
    return to_sample(mesh_.describe(triangle, root * (1 - u1), root * u1), 1 / area(triangle));
  }
  double pdf(uint32_t triangle, const SurfacePoint& /*point*/) const override {
    const double whole = area(triangle);
    return whole > 0 ? 1 / whole : 0;
  }

  AreaSample sample_from(const Vec3f& from, uint32_t triangle, float u0, float u1) const override {
    const SphericalTriangle seen = seen_from(from, triangle);
    if (!is_well_conditioned(seen)) return Kind::sample_from(from, triangle, u0, u1);
    const LocalRay ray{Vec3d(from), seen.sample(u0, u1)};
    const Vec3d normal = mesh_.plane_normal(triangle);
    const Vec3d p = ray.origin + ray.direction * mesh_.meet_plane(triangle, ray).t;
    const std::size_t corner = std::size_t{3} * triangle;
    const Vec3d p0 = mesh_.position(corner);
    const Vec3d edge1 = mesh_.position(corner + 1) - p0;
    const Vec3d edge2 = mesh_.position(corner + 2) - p0;
    const double u = (p - p0).cross(edge2).dot(normal) / normal.length2();
    const double v = edge1.cross(p - p0).dot(normal) / normal.length2();
    if (!std::isfinite(u) || !std::isfinite(v)) return {};
    const double inside_u = std::clamp(u, 0.0, 1.0);
    const double inside_v = std::clamp(v, 0.0, 1 - inside_u);
    return to_sample(
        mesh_.describe(triangle, static_cast<float>(inside_u), static_cast<float>(inside_v)),
        1 / seen.solid_angle());
  }
  double pdf_from(const Vec3f& from, uint32_t triangle, const SurfacePoint& point) const override {
    const SphericalTriangle seen = seen_from(from, triangle);
    if (!is_well_conditioned(seen)) return Kind::pdf_from(from, triangle, point);
    return 1 / seen.solid_angle();
  }

 private:
  static bool is_well_conditioned(const SphericalTriangle& triangle) {
    return triangle.solid_angle() >= 2e-4 && triangle.solid_angle() <= 6.22;
  }
  SphericalTriangle seen_from(const Vec3f& from, uint32_t triangle) const {
    const std::size_t corner = std::size_t{3} * triangle;
    const Vec3d eye(from);
    return {mesh_.position(corner) - eye, mesh_.position(corner + 1) - eye,
            mesh_.position(corner + 2) - eye};
  }

  TracedTriangles mesh_;
};

namespace {

/// A number in [0, 1] with a density that goes linearly from a to b.
double sample_linear(double u, double a, double b) {
  if (!(u > 0 && a + b > 0)) return 0;
  return std::min(1.0, u * (a + b) / (a + std::sqrt((1 - u) * a * a + u * b * b)));
}

}  // namespace

/// Drawn by u and v with a bilinear density: that of the area at the corners. Uniform in the area
/// of a flat patch, whose area is bilinear.
class AreaShape::PatchKind : public Kind {
 public:
  PatchKind(const SurfaceShape& shape, const Vec3d& origin) : mesh_(trace_patches(shape, origin)) {}

  uint32_t count() const override { return mesh_.count(); }

  double area(uint32_t index) const override {
    // Gauss's rule of three points in each of 4 x 4 cells.
    constexpr int kCells = 4;
    static constexpr std::array<double, 3> kNodes = {0.1127016653792583, 0.5, 0.8872983346207417};
    constexpr std::array<double, 3> kWeights = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const BilinearPatch patch = mesh_.patch(index);
    const auto node = [](int i) {
      const int cell = i / 3;
      return (cell + kNodes[i % 3]) / kCells;
    };
    double sum = 0;
    for (int i = 0; i < 3 * kCells; ++i) {
      for (int j = 0; j < 3 * kCells; ++j) {
        const double weight = kWeights[i % 3] * kWeights[j % 3];
        sum += weight * patch.normal(node(i), node(j)).length();
      }
    }
    return sum / (kCells * kCells);
  }

  AreaSample sample(uint32_t index, float u0, float u1) const override {
    const BilinearPatch patch = mesh_.patch(index);
    const std::array<double, 4> w = weights(patch);
    const double v = sample_linear(u1, w[0] + w[1], w[2] + w[3]);
    const double u = sample_linear(u0, w[0] + (w[2] - w[0]) * v, w[1] + (w[3] - w[1]) * v);
    return to_sample(mesh_.describe(index, u, v), density(patch, w, u, v));
  }

  double pdf(uint32_t index, const SurfacePoint& point) const override {
    // The coordinates of the patch, which are not those of its texture.
    const BilinearPatch patch = mesh_.patch(index);
    const Vec3d position(point.position);
    const PatchRoots roots = patch.intersect(position, Vec3d(point.normal));
    const PatchRoot* nearest = nullptr;
    for (int i = 0; i < roots.count; ++i) {
      const PatchRoot& root = roots.root[i];
      if (nearest == nullptr || std::abs(root.t) < std::abs(nearest->t)) nearest = &root;
    }
    // A point of the rim may have been rounded off the patch.
    const PatchRoot at = nearest != nullptr ? *nearest : nearest_corner(patch, position);
    return density(patch, weights(patch), at.u, at.v);
  }

 private:
  static std::array<double, 4> weights(const BilinearPatch& patch) {
    return {patch.normal(0, 0).length(), patch.normal(1, 0).length(), patch.normal(0, 1).length(),
            patch.normal(1, 1).length()};
  }
  static double density(const BilinearPatch& patch, const std::array<double, 4>& w, double u,
                        double v) {
    const double here = (w[0] * (1 - u) + w[1] * u) * (1 - v) + (w[2] * (1 - u) + w[3] * u) * v;
    const double stretch = patch.normal(u, v).length();
    const double sum = w[0] + w[1] + w[2] + w[3];
    return stretch > 0 && sum > 0 ? 4 * here / (sum * stretch) : 0;
  }
  static PatchRoot nearest_corner(const BilinearPatch& patch, const Vec3d& position) {
    PatchRoot best{0, 0, 0};
    double smallest = (patch.p00 - position).length2();
    for (const auto& [u, v] : {std::pair(1.0, 0.0), {0.0, 1.0}, {1.0, 1.0}}) {
      const double distance2 = (patch.at(u, v) - position).length2();
      if (distance2 < smallest) {
        smallest = distance2;
        best = {0, u, v};
      }
    }
    return best;
  }

  TracedPatches mesh_;
};

class AreaShape::QuadricKind : public Kind {
 public:
  QuadricKind(const SurfaceShape& shape, const Vec3d& origin)
      : traced_(trace_quadric(shape, origin)),
        volume_ratio_(std::abs(traced_.object_to_part.determinant())) {
    // The mean of the ratio of areas over points that are uniform in the object space; exact where
    // the ratio is constant.
    constexpr int kSteps = 64;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const Vec3d p = traced_.quadric.sample((i + 0.5) / kSteps, (j + 0.5) / kSteps);
        sum += area_ratio(traced_.quadric.describe(p, false).normal);
      }
    }
    area_ = traced_.quadric.area() * sum / (kSteps * kSteps);
    const AffineTransform& map = traced_.object_to_part;
    scale_ = map.x.length();
    const bool is_similarity = map.is_similarity();
    is_cone_ = traced_.quadric.is_whole_sphere() && is_similarity;
    is_uniform_ = is_similarity || traced_.quadric.kind() == freepath::QuadricKind::kDisk;
  }

  uint32_t count() const override { return 1; }
  double area(uint32_t /*primitive*/) const override { return area_; }

  AreaSample sample(uint32_t /*primitive*/, float u0, float u1) const override {
    const Vec3d object = traced_.quadric.sample(u0, u1);
    return to_sample(traced_.describe(object), density(object));
  }
  double pdf(uint32_t /*primitive*/, const SurfacePoint& point) const override {
    return density(traced_.part_to_object.point(Vec3d(point.position)));
  }

  AreaSample sample_from(const Vec3f& from, uint32_t primitive, float u0, float u1) const override {
    const Cone cone = seen_from(from);
    if (!cone.is_outside) return Kind::sample_from(from, primitive, u0, u1);
    const double one_minus_cosine = u0 * cone.one_minus_cosine;
    const double sine2 = one_minus_cosine * (2 - one_minus_cosine);
    const double angle = 2 * std::numbers::pi * u1;
    const double sine = std::sqrt(sine2);
    const TangentFrame frame{Vec3f(cone.axis)};
    const Vec3d direction =
        (Vec3d(frame.tangent) * (sine * std::cos(angle)) +
         Vec3d(frame.bitangent) * (sine * std::sin(angle)) + cone.axis * (1 - one_minus_cosine))
            .normalized();
    const double half =
        std::sqrt(std::max(0.0, cone.radius * cone.radius - cone.distance * cone.distance * sine2));
    const double t = cone.distance * (1 - one_minus_cosine) - half;
    const Vec3d position = Vec3d(from) + direction * t;
    return to_sample(traced_.describe(traced_.part_to_object.point(position)), cone.pdf());
  }
  double pdf_from(const Vec3f& from, uint32_t primitive, const SurfacePoint& point) const override {
    const Cone cone = seen_from(from);
    if (!cone.is_outside) return Kind::pdf_from(from, primitive, point);
    const Vec3d centre = traced_.object_to_part.translation;
    const Vec3d position(point.position);
    const bool is_near = (position - centre).dot(position - Vec3d(from)) <= 0;
    return is_near ? cone.pdf() : 0;
  }

 private:
  /// What a sphere fills of the directions from a point outside.
  struct Cone {
    bool is_outside = false;
    Vec3d axis;
    double distance = 0, radius = 0;
    double one_minus_cosine = 0;  // of the half angle, with all its digits for a small one
    double pdf() const { return 1 / (2 * std::numbers::pi * one_minus_cosine); }
  };
  Cone seen_from(const Vec3f& from) const {
    Cone cone;
    if (!is_cone_) return cone;
    const Vec3d towards = traced_.object_to_part.translation - Vec3d(from);
    cone.distance = towards.length();
    cone.radius = traced_.quadric.radius() * scale_;
    const double sine = cone.radius / cone.distance;
    cone.is_outside = sine < 1 - 1e-6;
    if (!cone.is_outside) return cone;
    cone.axis = towards / cone.distance;
    const double sine2 = sine * sine;
    cone.one_minus_cosine = sine2 / (1 + std::sqrt(1 - sine2));
    return cone;
  }
  /// World area for each object area where the surface has this normal.
  double area_ratio(const Vec3d& object_normal) const {
    return volume_ratio_ * traced_.part_to_object.normal_back(object_normal).length();
  }
  double density(const Vec3d& object) const {
    if (is_uniform_) return 1 / area_;
    const double ratio = area_ratio(traced_.quadric.describe(object, false).normal);
    return 1 / (traced_.quadric.area() * ratio);
  }

  TracedQuadric traced_;
  double volume_ratio_;
  double area_ = 0;
  double scale_ = 1;
  bool is_cone_ = false;
  bool is_uniform_ = false;  // whether areas of both spaces have the same ratio everywhere
};

AreaShape::AreaShape(const SurfaceShape& shape, const Vec3d& origin) {
  check(shape);
  std::unique_ptr<Kind> kind;
  if (std::holds_alternative<TriangleMesh>(shape.geometry)) {
    kind = std::make_unique<TriangleKind>(shape, origin);
  } else if (std::holds_alternative<BilinearMesh>(shape.geometry)) {
    kind = std::make_unique<PatchKind>(shape, origin);
  } else {
    kind = std::make_unique<QuadricKind>(shape, origin);
  }
  kind->first = shape.first_primitive;
  kind_ = std::move(kind);
}
AreaShape::~AreaShape() = default;
AreaShape::AreaShape(AreaShape&&) noexcept = default;
AreaShape& AreaShape::operator=(AreaShape&&) noexcept = default;

uint32_t AreaShape::first_primitive() const { return kind_->first; }
uint32_t AreaShape::primitive_count() const { return kind_->count(); }
double AreaShape::area(uint32_t primitive) const { return kind_->area(primitive - kind_->first); }

AreaSample AreaShape::sample(uint32_t primitive, float u0, float u1) const {
  return kind_->sample(primitive - kind_->first, u0, u1);
}
float AreaShape::pdf(const SurfacePoint& point) const {
  return static_cast<float>(kind_->pdf(point.primitive - kind_->first, point));
}
AreaSample AreaShape::sample_from(const Vec3f& from, uint32_t primitive, float u0, float u1) const {
  return kind_->sample_from(from, primitive - kind_->first, u0, u1);
}
float AreaShape::pdf_from(const Vec3f& from, const SurfacePoint& point) const {
  return static_cast<float>(kind_->pdf_from(from, point.primitive - kind_->first, point));
}

}  // namespace freepath
