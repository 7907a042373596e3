#pragma once
/// @file The table through which colours become reflectances.

#include <tbb/concurrent_unordered_map.h>

#include <cstdint>

#include "freepath/base/vector.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/rgb_spectrum.h"

namespace freepath {

/// Smooth reflectances by colour, in the form in which they were published and in which pbrt-v4
/// reads them: a table for each component that may be the largest, of 64³ colours, between which
/// the coefficients of the polynomials are interpolated [Jakob19].
///
/// So a spectrum has not quite the colour it was made of. It is off by 0.03 % of the largest
/// component on average, 0.25 % at most, where that is between 0.2 and 0.9; in the dark, where
/// slices are a factor apart, by 0.3 % at 0.1, 1 % at 0.03 and 6 % at 0.002. In return two
/// renderers that use the table show the same.
///
/// Nodes are fitted when they are first needed: all of them would take seconds. A node depends on
/// nothing but its place, so that neither the order of requests nor threads change a spectrum.
class ReflectanceTable {
 public:
  static constexpr int kSize = 64;

  /// @param space must outlive this
  explicit ReflectanceTable(const RgbColorSpace& space) : space_(space) {}

  /// Equal components give a constant spectrum exactly; colours darker than the first slice of the
  /// table (2e-6) are fitted apart. All coefficients are finite unless the colour is black or
  /// white. Threads may ask at once.
  /// @throws Error unless all components are in [0, 1]
  SigmoidPolynomial operator()(const Vec3d& rgb) const;

  /// The largest component of the colours in a slice: 0 to 1, denser at both ends.
  static double level(int slice);

 private:
  struct Node {
    int largest;        ///< Which component is.
    int slice;          ///< Index as of level().
    int second, third;  ///< The components that follow, in 63rds of the largest.
  };

  SigmoidPolynomial at(const Node& node) const;

  const RgbColorSpace& space_;
  mutable tbb::concurrent_unordered_map<uint32_t, SigmoidPolynomial> nodes_;
};

}  // namespace freepath
