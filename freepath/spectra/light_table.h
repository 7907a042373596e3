#pragma once
/// @file Spectra of images that emit light, fast enough for a lookup at every light sample.

#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath {

/// What RgbSpectrum::illuminant is of a colour, from cells that hold all they need: the slice of
/// the ReflectanceTable halfway between black and white, in which all lights are.
///
/// A cell is made when its first colour is asked for, in 0.2 ms at most, and no lookup ever waits
/// for another: where two threads miss the same cell, both make it. An image needs a few hundred of
/// the 11 907 cells. Results depend on the colour alone.
class LightTable {
 public:
  /// @param space must outlive this
  explicit LightTable(const RgbColorSpace& space);
  ~LightTable();
  LightTable(const LightTable&) = delete;
  LightTable& operator=(const LightTable&) = delete;

  /// scale · S(c0 u² + c1 u + c2), to be multiplied by the illuminant of the space.
  struct Light {
    float scale = 0;
    std::array<float, 3> c = {};

    /// @param u of the wavelength: SigmoidPolynomial::coordinate
    float operator()(float u) const {
      const float x = (c[0] * u + c[1]) * u + c[2];
      return scale * (0.5F + 0.5F * x / std::sqrt(1 + x * x));
    }
  };

  /// Below 1e-30 it is black.
  /// @param rgb finite and not negative
  Light light(const Vec3f& rgb) const;

  /// The colour that the observer sees of `light`, in R, G, B of the space: the given one but for
  /// the interpolation of the table. Greys come back exactly, and what is below 1e-30 is black.
  /// @param rgb finite and not negative
  Vec3f seen(const Vec3f& rgb) const;

 private:
  struct Cell;
  /// Where a colour is: in a cell, at x and y in [0, 1].
  struct CellPoint {
    const Cell* cell;
    float x, y;
  };

  CellPoint point_of(const Vec3f& rgb, float size) const;
  const Cell* make_cell(int largest, int column, int row) const;
  void set_colours(Cell& cell) const;

  /// What the observer sees of a wavelength under the illuminant of the space.
  struct SeenWavelength {
    float u;
    Vec3f rgb;
  };

  const RgbColorSpace& space_;
  std::vector<SeenWavelength> wavelengths_;
  std::unique_ptr<std::atomic<const Cell*>[]> cells_;  // null where nobody asked yet
};

}  // namespace freepath
