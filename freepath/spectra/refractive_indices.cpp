#include "freepath/spectra/refractive_indices.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace freepath {
namespace {

/// Energy of a photon times its wavelength, h c / e [eV nm].
constexpr double kPhotonEnergy = 1239.84198;

/// n and k of the noble metals at the energy of a photon [Johnson72].
struct NobleMetals {
  double energy = 0;  // [eV]
  std::array<double, 2> copper, silver, gold;
};

constexpr auto kNobleMetals = std::to_array<NobleMetals>({
    {1.39, {0.30, 5.768}, {0.04, 6.312}, {0.17, 5.663}},
    {1.51, {0.26, 5.180}, {0.04, 5.727}, {0.16, 5.083}},
    {1.64, {0.24, 4.665}, {0.03, 5.242}, {0.14, 4.542}},
    {1.76, {0.21, 4.205}, {0.04, 4.838}, {0.13, 4.103}},
    {1.88, {0.22, 3.747}, {0.05, 4.483}, {0.14, 3.697}},
    {2.01, {0.30, 3.205}, {0.06, 4.152}, {0.21, 3.272}},
    {2.13, {0.70, 2.704}, {0.05, 3.858}, {0.29, 2.863}},
    {2.26, {1.02, 2.577}, {0.06, 3.586}, {0.43, 2.455}},
    {2.38, {1.18, 2.608}, {0.05, 3.324}, {0.62, 2.081}},
    {2.50, {1.22, 2.564}, {0.05, 3.093}, {1.04, 1.833}},
    {2.63, {1.25, 2.483}, {0.05, 2.869}, {1.31, 1.849}},
    {2.75, {1.24, 2.397}, {0.04, 2.657}, {1.38, 1.914}},
    {2.88, {1.25, 2.305}, {0.04, 2.462}, {1.45, 1.948}},
    {3.00, {1.28, 2.207}, {0.05, 2.275}, {1.46, 1.958}},
    {3.12, {1.32, 2.116}, {0.05, 2.070}, {1.47, 1.952}},
    {3.25, {1.33, 2.045}, {0.05, 1.864}, {1.46, 1.933}},
    {3.37, {1.36, 1.975}, {0.07, 1.657}, {1.48, 1.895}},
    {3.50, {1.37, 1.916}, {0.10, 1.419}, {1.50, 1.866}},
});

MetalIndex noble_metal(std::array<double, 2> NobleMetals::*metal) {
  std::vector<double> wavelengths, eta, k;
  // The table is by energy, so its wavelengths increase from its end.
  for (std::size_t i = kNobleMetals.size(); i-- > 0;) {
    const NobleMetals& row = kNobleMetals[i];
    wavelengths.push_back(kPhotonEnergy / row.energy);
    eta.push_back((row.*metal)[0]);
    k.push_back((row.*metal)[1]);
  }
  return {{wavelengths, std::move(eta)}, {wavelengths, std::move(k)}};
}

double square_of_micrometres(double wavelength) {
  const double micrometres = wavelength * 1e-3;
  return micrometres * micrometres;
}

}  // namespace

double Sellmeier::operator()(double wavelength) const {
  const double square = square_of_micrometres(wavelength);
  double sum = 1;
  for (std::size_t i = 0; i < b.size(); ++i) sum += b[i] * square / (square - c[i]);
  return std::sqrt(sum);
}

double magnesium_oxide_index(double wavelength) {
  const double square = square_of_micrometres(wavelength);
  return std::sqrt(2.956362 - 0.01062387 * square - 0.0000204968 * square * square +
                   0.02195770 / (square - 0.01428322));
}

double titanium_dioxide_index(double wavelength) {
  const double square = square_of_micrometres(wavelength);
  return std::sqrt(5.913 + 0.2441 / (square - 0.0803));
}

std::complex<double> aluminium_index(double wavelength) {
  // Strength, damping [eV] and resonance [eV] of the oscillators; the first one is of free
  // electrons.
  struct Oscillator {
    double strength, damping, resonance;
  };
  constexpr auto kOscillators = std::to_array<Oscillator>({{0.523, 0.047, 0},
                                                           {0.227, 0.333, 0.162},
                                                           {0.050, 0.312, 1.544},
                                                           {0.166, 1.351, 1.808},
                                                           {0.030, 3.382, 3.473}});
  constexpr double kPlasmaEnergy = 14.98;  // [eV]
  const double energy = kPhotonEnergy / wavelength;
  std::complex<double> permittivity = 1;
  for (const auto& [strength, damping, resonance] : kOscillators) {
    permittivity +=
        strength * kPlasmaEnergy * kPlasmaEnergy /
        std::complex<double>(resonance * resonance - energy * energy, -damping * energy);
  }
  return std::sqrt(permittivity);
}

MetalIndex copper_index() { return noble_metal(&NobleMetals::copper); }
MetalIndex silver_index() { return noble_metal(&NobleMetals::silver); }
MetalIndex gold_index() { return noble_metal(&NobleMetals::gold); }

}  // namespace freepath
