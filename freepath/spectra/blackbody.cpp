#include "freepath/spectra/blackbody.h"

#include <cmath>

#include "freepath/base/error.h"

namespace freepath {
namespace {

// Exact by the definition of the units since 2019.
constexpr double kPlanckConstant = 6.62607015e-34;    // [J s]
constexpr double kBoltzmannConstant = 1.380649e-23;   // [J/K]
constexpr double kSpeedOfLight = 299792458;           // [m/s]
constexpr double kWienDisplacement = 2.897771955e-3;  // [m K]
constexpr double kMetresPerNanometre = 1e-9;

}  // namespace

double planck_radiance(double wavelength, double temperature) {
  if (temperature <= 0) return 0;
  const double metres = wavelength * kMetresPerNanometre;
  const double first = 2 * kPlanckConstant * kSpeedOfLight * kSpeedOfLight;
  // Energy of a photon in units of kT. expm1 keeps all digits where it is small, and is infinite,
  // which makes the quotient 0, where it is large.
  const double exponent =
      kPlanckConstant * kSpeedOfLight / (metres * kBoltzmannConstant * temperature);
  const double metres_squared = metres * metres;
  return first / (metres_squared * metres_squared * metres) / std::expm1(exponent);
}

double planck_peak(double temperature) {
  return kWienDisplacement / temperature / kMetresPerNanometre;
}

BlackbodySpectrum::BlackbodySpectrum(double temperature, BlackbodyScale scale)
    : temperature_(temperature) {
  if (!(temperature > 0) || !std::isfinite(temperature)) {
    fail("a black body has a positive temperature in kelvin, not {}", temperature);
  }
  if (scale == BlackbodyScale::kPeak) {
    factor_ = 1 / planck_radiance(planck_peak(temperature), temperature);
  }
}

}  // namespace freepath
