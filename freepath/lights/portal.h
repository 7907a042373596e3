#pragma once
/// @file A rectangle through which light from outside of the scene enters.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/lights/light_descriptions.h"

namespace freepath {

/// Draws directions to a light from outside of the scene that pass through a portal [Bitterli15].
///
/// In coordinates where both angles to the portal's normal are the axes, the part of the sky seen
/// through the portal is a rectangle for every point. Over these coordinates lies a grid with the
/// brightness of each cell, sampled within the rectangle by its summed-area table. A part of the
/// density is uniform, so that the grid may miss what is smaller than a cell and estimates are
/// still unbiased.
class Portal {
 public:
  /// @param brightness of the light from a direction (a unit vector to the light) [world]
  /// @param cells of the grid along an axis
  /// @throws Error that names the light, unless the corners are those of a rectangle
  Portal(const PortalCorners& corners, const Vec3d& origin,
         const std::function<double(const Vec3f&)>& brightness, int cells, const std::string& name);

  /// Density of `sample` [1/sr]; 0 for a direction that passes beside the portal.
  float pdf(const Vec3f& from, const Vec3f& direction) const;

  /// A direction through the portal; none on its outer side.
  std::optional<Vec3f> sample(const Vec3f& from, float u0, float u1) const;

 private:
  /// The part of the sky that is seen, in cells.
  struct Window {
    double u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  };

  Vec3f to_local(const Vec3f& v) const { return {x_.dot(v), y_.dot(v), z_.dot(v)}; }
  double angle_in_cells(float across, float ahead) const;
  std::optional<Window> window_from(const Vec3f& from) const;
  /// Integral of the grid over the rectangle from the origin.
  double integral(double u, double v) const;
  double integral(const Window& w) const {
    return integral(w.u1, w.v1) - integral(w.u0, w.v1) - integral(w.u1, w.v0) +
           integral(w.u0, w.v0);
  }
  double value(int column, int row) const {
    return values_[static_cast<std::size_t>(row) * cells_ + column];
  }
  int cell_of(double coordinate) const;

  Vec3f x_, y_, z_;         // axes; z points into the direction of the rays to the light
  Vec3f first_, opposite_;  // corners, relative to the origin
  int cells_;
  std::vector<double> values_;  // of each cell
  std::vector<double> sums_;    // of the cells left of and above a corner, (cells + 1)² values
};

}  // namespace freepath
