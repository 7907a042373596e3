#pragma once
/// @file Where the ticks of an axis are, and what they are called.

#include <string>
#include <vector>

namespace freepath {

/// The map from a value to its position along an axis.
class AxisScale {
 public:
  /// @param minimum, maximum finite and apart, above 0 where it is logarithmic
  AxisScale(double minimum, double maximum, bool logarithmic);

  /// 0 at the minimum, 1 at the maximum, beyond them outside. On a logarithmic scale, what is not
  /// above 0 has no place: NaN.
  double position(double value) const;

  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }
  bool logarithmic() const { return logarithmic_; }

 private:
  double minimum_, maximum_;
  bool logarithmic_;
};

/// "10" with the exponent "−3", or "0.25" without one. Numbers are typeset: a minus, not a hyphen.
struct TickLabel {
  std::string text;
  std::string exponent = {};
};

/// A value that an axis marks.
struct AxisTick {
  double value = 0;
  TickLabel label = {};
  bool is_minor = false;  ///< Whether it has no label.
};

/// A step of 1, 2 or 5 times a power of ten, for which about `wanted` fit into a length.
double nice_step(double length, double wanted);

/// The ticks of an axis, ascending: multiples of a nice step; on a logarithmic axis the powers of
/// ten with 2 to 9 times them as minor ones, or 1, 2 and 5 times them where there are too few, and
/// multiples of a step where the axis is much shorter than a decade.
/// @param wanted how many labels there is about room for
std::vector<AxisTick> axis_ticks(const AxisScale& scale, double wanted);

/// A value for people, with so many significant digits at most: "0.0123", "1.5×10⁷", "–" where it
/// is not finite.
std::string readable_number(double value, int digits);

}  // namespace freepath
