#include "freepath/spectra/illuminants.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/spectra/illuminant_tables.h"

namespace freepath {
namespace {

/// How much of the two characteristic vectors there is in a daylight.
struct DaylightFactors {
  double first = 0, second = 0;
};

/// [Cie04]
DaylightFactors daylight_factors(const Chromaticity& chromaticity) {
  const auto [x, y] = chromaticity;
  const double denominator = 0.0241 + 0.2562 * x - 0.7341 * y;
  return {(-1.3515 - 1.7703 * x + 5.9114 * y) / denominator,
          (0.0300 - 31.4424 * x + 30.0717 * y) / denominator};
}

LinearSpectrum daylight_of(const DaylightFactors& factors) {
  constexpr double kFirst = 300;  // [nm]
  constexpr double kStep = 10;    // [nm]
  std::vector<double> wavelengths, values;
  for (std::size_t i = 0; i < kDaylightTable.size(); ++i) {
    const auto& [mean, vector1, vector2] = kDaylightTable[i];
    wavelengths.push_back(kFirst + kStep * static_cast<double>(i));
    values.push_back(mean + factors.first * vector1 + factors.second * vector2);
  }
  return normalized_to_luminance({std::move(wavelengths), std::move(values)});
}

/// A standard illuminant of the D series. Its temperature is named by a constant of radiation that
/// was in use when it was defined, and its factors are rounded [Cie04].
LinearSpectrum standard_daylight(double nominal_temperature) {
  const double temperature = nominal_temperature * 1.4388 / 1.4380;
  const auto [first, second] = daylight_factors(daylight_chromaticity(temperature));
  return daylight_of({std::round(first * 1000) / 1000, std::round(second * 1000) / 1000});
}

}  // namespace

LinearSpectrum normalized_to_luminance(const LinearSpectrum& spectrum) {
  const double luminance = luminance_of(spectrum);
  if (!(luminance > 0)) fail("a spectrum of luminance {} cannot be normalised", luminance);
  return spectrum.scaled(1 / luminance);
}

LinearSpectrum illuminant_a() {
  // A black body of 2848 K by the constant 1.435e-2 m K of its time [Cie04].
  const auto power = [](double wavelength) {
    constexpr double kExponent = 1.435e7 / 2848;  // [nm]
    return std::pow(560 / wavelength, 5) * std::expm1(kExponent / 560) /
           std::expm1(kExponent / wavelength);
  };
  return normalized_to_luminance(sample_spectrum(power, 300, 830, 1));
}

LinearSpectrum illuminant_e() { return {{560}, {1}}; }

LinearSpectrum illuminant_d50() { return standard_daylight(5000); }
LinearSpectrum illuminant_d65() { return standard_daylight(6500); }

LinearSpectrum daylight(const Chromaticity& chromaticity) {
  return daylight_of(daylight_factors(chromaticity));
}

Chromaticity daylight_chromaticity(double temperature) {
  if (!(temperature >= 4000 && temperature <= 25000)) {
    fail("daylight has a colour temperature from 4000 K to 25000 K, not {}", temperature);
  }
  const double kilo = 1000 / temperature;
  // [Cie04]
  const double x = temperature <= 7000
                       ? ((-4.6070 * kilo + 2.9678) * kilo + 0.09911) * kilo + 0.244063
                       : ((-2.0064 * kilo + 1.9018) * kilo + 0.24748) * kilo + 0.237040;
  return {x, (-3.000 * x + 2.870) * x - 0.275};
}

LinearSpectrum illuminant_f(int number) {
  if (number < 1 || number > static_cast<int>(kFluorescentTable.size())) {
    fail("there are fluorescent illuminants F1 to F{}, not F{}", kFluorescentTable.size(), number);
  }
  const auto& table = kFluorescentTable[static_cast<std::size_t>(number - 1)];
  std::vector<double> wavelengths;
  for (std::size_t i = 0; i < table.size(); ++i) {
    wavelengths.push_back(380 + 5 * static_cast<double>(i));
  }
  return normalized_to_luminance({std::move(wavelengths), {table.begin(), table.end()}});
}

}  // namespace freepath
