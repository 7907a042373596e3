#pragma once
/// @file Simple shapes that shine, for tests of lights; rays meet them in closed form.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "freepath/base/tangent_frame.h"
#include "freepath/lights/emitter_geometry.h"

namespace freepath::testing {

/// A point with all its members set.
inline SurfacePoint surface_point(const Vec3f& position, const Vec3f& normal) {
  const TangentFrame frame(normal);
  return {.position = position, .normal = normal, .shading_normal = normal, .dpdu = frame.tangent};
}

/// An emitter that rays can meet.
class TestEmitter : public EmitterGeometry {
 public:
  virtual std::optional<SurfacePoint> intersect(const Vec3f& from,
                                                const Vec3f& direction) const = 0;
};

/// Sampled uniformly in the cone of directions in which it is seen from outside.
class TestSphere final : public TestEmitter {
 public:
  TestSphere(const Vec3f& centre, float radius) : centre_(centre), radius_(radius) {}

  uint32_t part_count() const override { return 1; }
  EmitterBounds bounds(uint32_t /*part*/) const override {
    const Vec3f half(radius_);
    return {Box3f(centre_ - half, centre_ + half),
            {0, 0, 1},
            -1,
            4 * std::numbers::pi * radius_ * radius_};
  }
  EmitterPoint sample(uint32_t /*part*/, const Vec3f& reference, float u0,
                      float u1) const override {
    const double cosine = cone_cosine(reference);
    const double drop = u0 * (1 - cosine);
    const double sine = std::sqrt(drop * (2 - drop));
    const double azimuth = 2 * std::numbers::pi * u1;
    const TangentFrame frame((centre_ - reference).normalized());
    const Vec3f direction =
        frame.to_world(static_cast<float>(sine * std::cos(azimuth)),
                       static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(1 - drop));
    // The nearer point of the ray and the sphere; the edge of the cone touches it.
    const double along = Vec3d(direction).dot(Vec3d(centre_ - reference));
    const double distance2 = Vec3d(centre_ - reference).length2();
    const double inside = std::max(0.0, radius_ * radius_ - distance2 + along * along);
    const Vec3f position = reference + direction * static_cast<float>(along - std::sqrt(inside));
    return {position, (position - centre_).normalized(), 0, 0, cone_pdf(reference)};
  }
  float pdf(const Vec3f& reference, const SurfacePoint& /*point*/) const override {
    return cone_pdf(reference);
  }
  std::optional<SurfacePoint> intersect(const Vec3f& from, const Vec3f& direction) const override {
    const double along = Vec3d(direction).dot(Vec3d(centre_ - from));
    const double inside = radius_ * radius_ - Vec3d(centre_ - from).length2() + along * along;
    if (inside < 0 || along < 0) return {};
    const Vec3f position = from + direction * static_cast<float>(along - std::sqrt(inside));
    return surface_point(position, (position - centre_).normalized());
  }
  double solid_angle(const Vec3f& from) const {
    return 2 * std::numbers::pi * (1 - cone_cosine(from));
  }

 private:
  double cone_cosine(const Vec3f& from) const {
    return std::sqrt(1 - radius_ * radius_ / Vec3d(centre_ - from).length2());
  }
  float cone_pdf(const Vec3f& from) const { return static_cast<float>(1 / solid_angle(from)); }

  Vec3f centre_;
  float radius_;
};

/// Sampled uniformly over its area; u and v are coordinates of the square around it.
class TestDisk final : public TestEmitter {
 public:
  TestDisk(const Vec3f& centre, const Vec3f& normal, float radius)
      : centre_(centre), frame_(normal.normalized()), radius_(radius) {}

  uint32_t part_count() const override { return 1; }
  EmitterBounds bounds(uint32_t /*part*/) const override {
    const Vec3f half(radius_);
    return {Box3f(centre_ - half, centre_ + half), frame_.normal, 1, area()};
  }
  EmitterPoint sample(uint32_t /*part*/, const Vec3f& reference, float u0,
                      float u1) const override {
    const float r = radius_ * std::sqrt(u0);
    const float azimuth = 2 * std::numbers::pi_v<float> * u1;
    const float x = r * std::cos(azimuth);
    const float y = r * std::sin(azimuth);
    const Vec3f position = centre_ + frame_.to_world(x, y, 0);
    return {position, frame_.normal, 0.5F + 0.5F * x / radius_, 0.5F + 0.5F * y / radius_,
            density(reference, position)};
  }
  float pdf(const Vec3f& reference, const SurfacePoint& point) const override {
    return density(reference, point.position);
  }
  std::optional<SurfacePoint> intersect(const Vec3f& from, const Vec3f& direction) const override {
    const float t = (centre_ - from).dot(frame_.normal) / direction.dot(frame_.normal);
    if (!(t > 0)) return {};
    SurfacePoint point = surface_point(from + direction * t, frame_.normal);
    const Vec3f local = frame_.to_local(point.position - centre_);
    if (local.x * local.x + local.y * local.y > radius_ * radius_) return {};
    point.u = 0.5F + 0.5F * local.x / radius_;
    point.v = 0.5F + 0.5F * local.y / radius_;
    return point;
  }
  double area() const { return std::numbers::pi * radius_ * radius_; }

 private:
  float density(const Vec3f& from, const Vec3f& position) const {
    const Vec3f towards = position - from;
    const double distance2 = towards.length2();
    const double cosine = std::abs(frame_.normal.dot(towards)) / std::sqrt(distance2);
    return static_cast<float>(distance2 / (cosine * area()));
  }

  Vec3f centre_;
  TangentFrame frame_;
  float radius_;
};

/// Triangles, each a part of its own, sampled uniformly over their areas.
class TestMesh final : public TestEmitter {
 public:
  using Corners = std::array<Vec3f, 3>;
  explicit TestMesh(std::vector<Corners> triangles) : triangles_(std::move(triangles)) {}

  uint32_t part_count() const override { return static_cast<uint32_t>(triangles_.size()); }
  EmitterBounds bounds(uint32_t part) const override {
    EmitterBounds bounds;
    for (const Vec3f& corner : triangles_[part]) bounds.box.extendBy(corner);
    bounds.axis = normal(part);
    bounds.area = area(part);
    return bounds;
  }
  EmitterPoint sample(uint32_t part, const Vec3f& reference, float u0, float u1) const override {
    const float root = std::sqrt(u0);
    const Corners& t = triangles_[part];
    const Vec3f position = t[0] * (1 - root) + t[1] * (root * (1 - u1)) + t[2] * (root * u1);
    return {position, normal(part), root * (1 - u1), root * u1, density(part, reference, position)};
  }
  float pdf(const Vec3f& reference, const SurfacePoint& point) const override {
    return density(point.primitive, reference, point.position);
  }
  std::optional<SurfacePoint> intersect(const Vec3f& from, const Vec3f& direction) const override {
    std::optional<SurfacePoint> nearest;
    double nearest_t = 1e30;
    for (uint32_t part = 0; part < part_count(); ++part) {
      const Vec3d a(triangles_[part][0]);
      const Vec3d e1 = Vec3d(triangles_[part][1]) - a;
      const Vec3d e2 = Vec3d(triangles_[part][2]) - a;
      const Vec3d p = Vec3d(direction).cross(e2);
      const double determinant = e1.dot(p);
      if (determinant == 0) continue;
      const Vec3d s = Vec3d(from) - a;
      const double u = s.dot(p) / determinant;
      const Vec3d q = s.cross(e1);
      const double v = Vec3d(direction).dot(q) / determinant;
      const double t = e2.dot(q) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || t <= 0 || t >= nearest_t) continue;
      nearest_t = t;
      nearest = surface_point(Vec3f(a + e1 * u + e2 * v), normal(part));
      nearest->u = static_cast<float>(u);
      nearest->v = static_cast<float>(v);
      nearest->primitive = part;
    }
    return nearest;
  }
  /// Of a triangle, by the formula of van Oosterom and Strackee.
  double solid_angle(uint32_t part, const Vec3f& from) const {
    const Vec3d a = Vec3d(triangles_[part][0] - from).normalized();
    const Vec3d b = Vec3d(triangles_[part][1] - from).normalized();
    const Vec3d c = Vec3d(triangles_[part][2] - from).normalized();
    return 2 * std::abs(std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a)));
  }
  double area(uint32_t part) const { return 0.5 * cross(part).length(); }

 private:
  Vec3f cross(uint32_t part) const {
    const Corners& t = triangles_[part];
    return (t[1] - t[0]).cross(t[2] - t[0]);
  }
  Vec3f normal(uint32_t part) const { return cross(part).normalized(); }
  float density(uint32_t part, const Vec3f& from, const Vec3f& position) const {
    const Vec3f towards = position - from;
    const double distance2 = towards.length2();
    const double cosine = std::abs(normal(part).dot(towards)) / std::sqrt(distance2);
    return static_cast<float>(distance2 / (cosine * area(part)));
  }

  std::vector<Corners> triangles_;
};

}  // namespace freepath::testing
