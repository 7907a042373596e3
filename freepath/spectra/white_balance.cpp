#include "freepath/spectra/white_balance.h"

#include "freepath/base/error.h"
#include "freepath/spectra/blackbody.h"
#include "freepath/spectra/illuminants.h"

namespace freepath {
namespace {

constexpr double kCoolestBalance = 1000, kCoolestDaylight = 4000, kHottestBalance = 25000;  // [K]

/// The chromaticity of the light that a film is balanced for, by the constant of radiation that
/// daylight is named by [Cie04].
Chromaticity balanced_white(double temperature) {
  const double kelvin = temperature * 1.4388 / 1.4380;
  if (kelvin < kCoolestDaylight) {
    return chromaticity_of(observe(BlackbodySpectrum(kelvin, BlackbodyScale::kPeak)));
  }
  return chromaticity_of(observe(daylight(daylight_chromaticity(kelvin))));
}

}  // namespace

Matrix3d white_balance(double temperature, const RgbColorSpace& space) {
  if (!(temperature >= kCoolestBalance && temperature <= kHottestBalance)) {
    fail("white is balanced for {} K to {} K, not {}", kCoolestBalance, kHottestBalance,
         temperature);
  }
  // Rows are what X, Y and Z add to the responses.
  const Matrix3d cones(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);
  const Vec3d from = xyz_of(balanced_white(temperature)) * cones;
  const Vec3d to = xyz_of(space.white()) * cones;
  Matrix3d scale;
  for (int i = 0; i < 3; ++i) scale[i][i] = to[i] / from[i];
  return space.rgb_to_xyz() * cones * scale * cones.inverse(true) * space.xyz_to_rgb();
}

}  // namespace freepath
