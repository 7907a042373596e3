#pragma once
/// @file Filters that make pixels of samples: box, gaussian, Mitchell's, windowed sinc, triangle.
///
/// All of them are products f(x) f(y), even in x and in y, and normalised: their integral is 1.

#include <cstdint>
#include <variant>
#include <vector>

namespace freepath {

// The parameters of the filters, with the scene language's defaults. A filter is 0 further from the
// pixel's centre than its radii [pixels].

struct BoxFilter {
  double x_radius = 0.5, y_radius = 0.5;
};

/// A Gaussian less its value at the radius, so that it ends without a step.
struct GaussianFilter {
  double x_radius = 1.5, y_radius = 1.5;
  double sigma = 0.5;  ///< Standard deviation [pixels].
};

/// The cubic of [Mitchell88], stretched to the radius. It has negative lobes.
struct MitchellFilter {
  double x_radius = 2, y_radius = 2;
  double b = 1.0 / 3, c = 1.0 / 3;
};

/// sinc(x) in Lanczos' window, sinc(x / tau) [Duchon79]. It has negative lobes.
struct SincFilter {
  double x_radius = 4, y_radius = 4;
  double tau = 3;  ///< First zero of the window [pixels].
};

struct TriangleFilter {
  double x_radius = 2, y_radius = 2;
};

using FilterModel =
    std::variant<BoxFilter, GaussianFilter, MitchellFilter, SincFilter, TriangleFilter>;

/// Where to take a sample of a pixel, and what it counts.
struct FilterSample {
  float x, y;    ///< Offset from the pixel's centre [pixels].
  float weight;  ///< f / density; 1 on average.
};

/// A filter as a distribution of samples.
class PixelFilter {
 public:
  /// @throws Error if a radius, sigma or tau is not positive, a number is not finite, the filter
  ///   has too much detail for a table (thousands of sigmas or zeros) or its integral is not
  ///   positive
  explicit PixelFilter(const FilterModel& model = GaussianFilter{});

  /// Draws a place with a density next to proportional to |f|: a linear interpolant of it, which is
  /// |f| itself for the box and the triangle. Monotone in both numbers, hence stratified numbers
  /// give stratified places. Unbiased: the weight is f over the density that was used.
  /// @param u0,u1 uniform in [0, 1)
  FilterSample sample(float u0, float u1) const;

  /// The filter's value; its integral is 1 [1/pixel²].
  /// @param x,y from the pixel's centre [pixels]
  double evaluate(double x, double y) const { return x_.evaluate(x) * y_.evaluate(y); }

  double x_radius() const { return x_.radius; }
  double y_radius() const { return y_.radius; }

 private:
  struct AxisSample {
    float x;
    float weight;
  };
  /// One factor of the filter. Tables run over [0, radius] in equal steps.
  struct Axis {
    Axis(const FilterModel& filter, double reach);
    double evaluate(double x) const;
    AxisSample sample(float u) const;

    FilterModel model;
    double radius;
    bool is_box;
    double scale = 1;             // makes the integral over [-radius, radius] 1
    std::vector<double> density;  // at the nodes, of integral 1/2
    std::vector<double> cdf;      // up to the nodes, from 0 to 1
  };
  Axis x_, y_;
};

}  // namespace freepath
