#pragma once
/// @file Scenes of bodies that touch, overlap and hold one another, with what is seen through them.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/random.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {

inline std::string absorber(const std::string& name, double sigma_a, const std::string& more = "") {
  return fmt::format(
      R"(MakeNamedMedium "{}" "string type" "homogeneous" "rgb sigma_a" [ {} {} {} ])"
      R"( "rgb sigma_s" [ 0 0 0 ] {})"
      "\n",
      name, sigma_a, sigma_a, sigma_a, more);
}

inline std::string grey_fog(const std::string& name, double sigma_a, double sigma_s, double g = 0) {
  return fmt::format(R"(MakeNamedMedium "{0}" "string type" "homogeneous" "rgb sigma_a" )"
                     R"([ {1} {1} {1} ] "rgb sigma_s" [ {2} {2} {2} ] "float g" {3})"
                     "\n",
                     name, sigma_a, sigma_s, g);
}

/// A ball of a medium, or with `mesh` the box around it.
struct Body {
  int medium = 0;
  bool is_ball = false;
  Vec3d low, high;  // a ball touches its box

  Vec3d center() const { return (low + high) * 0.5; }
  double radius() const { return 0.5 * (high.x - low.x); }

  std::string text() const {
    const std::string name = fmt::format("m{}", medium);
    if (!is_ball) return medium_box(name, low, high);
    return fmt::format(R"(AttributeBegin Material "interface" MediumInterface "{}" "" )"
                       R"(Translate {} {} {} Shape "sphere" "float radius" {} AttributeEnd)"
                       "\n",
                       name, center().x, center().y, center().z, radius());
  }

  /// The range of t where a line is inside; none if it is empty.
  std::pair<double, double> within(const Vec3d& origin, const Vec3d& direction) const {
    if (is_ball) {
      const Vec3d from = origin - center();
      const double middle = -from.dot(direction);
      const double half2 = radius() * radius() - (from + direction * middle).length2();
      if (half2 <= 0) return {0, 0};
      return {middle - std::sqrt(half2), middle + std::sqrt(half2)};
    }
    double first = -1e9;
    double last = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - origin[axis]) / direction[axis];
      const double b = (high[axis] - origin[axis]) / direction[axis];
      first = std::max(first, std::min(a, b));
      last = std::min(last, std::max(a, b));
    }
    return {first, std::max(first, last)};
  }
};

/// Bodies whose faces lie on a coarse lattice, so that many coincide, touch or overlap.
class Arrangement {
 public:
  static constexpr int kMedia = 3;
  static constexpr double kSigma[kMedia] = {0.15, 0.3, 0.22};

  explicit Arrangement(uint32_t seed) : random_(seed, 77, 0, 0) {
    for (int i = 0; i < 9; ++i) {
      Body body;
      body.medium = number(kMedia);
      body.is_ball = number(4) == 0;
      const double edge = 1 + number(2);
      for (int axis = 0; axis < 3; ++axis) {
        body.low[axis] = number(3) - 1.5;
        body.high[axis] = body.low[axis] + (body.is_ball ? edge : 1 + number(2));
      }
      bodies_.push_back(body);
    }
    // The same shape again, of another medium.
    Body twin = bodies_[number(9)];
    twin.medium = (twin.medium + 1) % kMedia;
    bodies_.push_back(twin);
  }

  int number(int below) {
    return std::min(static_cast<int>(random_.uniform() * static_cast<float>(below)), below - 1);
  }
  Vec3d in_box(double half) {
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = half * (2.0 * random_.uniform() - 1.0);
    return point;
  }
  void shuffle() {
    for (std::size_t i = bodies_.size(); i > 1; --i) {
      std::swap(bodies_[i - 1], bodies_[number(static_cast<int>(i))]);
    }
  }

  std::string media() const {
    std::string text;
    for (int i = 0; i < kMedia; ++i) text += absorber(fmt::format("m{}", i), kSigma[i]);
    return text;
  }
  std::string bodies() const {
    std::string text;
    for (const Body& body : bodies_) text += body.text();
    return text;
  }

  /// The optical depth between two distances: each medium counts where any of its bodies is.
  double depth(const Vec3d& origin, const Vec3d& direction, double begin, double end) const {
    double sum = 0;
    for (int medium = 0; medium < kMedia; ++medium) {
      std::vector<std::pair<double, double>> ranges;
      for (const Body& body : bodies_) {
        if (body.medium == medium) ranges.push_back(body.within(origin, direction));
      }
      std::sort(ranges.begin(), ranges.end());
      double reached = begin;
      for (const auto& [first, last] : ranges) {
        const double to = std::min(last, end);
        if (to > std::max(first, reached)) {
          sum += kSigma[medium] * (to - std::max(first, reached));
          reached = to;
        }
      }
    }
    return sum;
  }

 private:
  RandomStream random_;
  std::vector<Body> bodies_;
};

inline std::string look(const Vec3d& from, const Vec3d& to) {
  return fmt::format("LookAt {:.17g} {:.17g} {:.17g}  {:.17g} {:.17g} {:.17g}  0.3 1 0.2\n", from.x,
                     from.y, from.z, to.x, to.y, to.z);
}

const std::string kRay =
    "Camera \"orthographic\" \"float screenwindow\" [ -1e-4 1e-4 -1e-4 1e-4 ]\nWorldBegin\n";
const std::string kSurround = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";

/// Turns all that follows, or the camera before it the same way.
inline std::string turned(double degrees) {
  return degrees == 0 ? "" : fmt::format("Rotate {} 1 2 3\n", degrees);
}

/// A scene of one piece after the other.
inline std::string joined(std::initializer_list<std::string> pieces) {
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

}  // namespace freepath::testing
