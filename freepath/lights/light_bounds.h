#pragma once
/// @file How much light may arrive somewhere from lights that are bounded in space and direction.

#include "freepath/base/vector.h"

namespace freepath {

/// Directions within an angle of an axis.
struct DirectionCone {
  Vec3f axis{0, 0, 1};  ///< Unit.
  float cosine = 1;     ///< Cosine of the largest angle from the axis; -1 for all directions.
};

/// The smallest cone around two that contains both, or a larger one.
DirectionCone unite(const DirectionCone& a, const DirectionCone& b);

/// One light or several [Conty18].
struct LightBounds {
  Box3f box;
  DirectionCone normals;   ///< Normals of the surfaces, or the axis of a point's cone.
  float cosine_reach = 0;  ///< Cosine of the angle from a normal within which it shines.
  bool two_sided = false;  ///< It also shines to the other side.
  double power = 0;        ///< Power in any unit.
};

LightBounds unite(const LightBounds& a, const LightBounds& b);

/// What the lights may contribute at a point, for choosing among them: power over squared distance,
/// times the cosine of the smallest angle from a normal [Conty18], without that of the receiver.
/// It is 0 only where none of the lights shines.
float importance(const LightBounds& bounds, const Vec3f& position);

/// What is minimised when lights are parted in two groups: the solid angle into which they shine,
/// weighted by cosine [Conty18].
double orientation_cost(const LightBounds& bounds);

}  // namespace freepath
