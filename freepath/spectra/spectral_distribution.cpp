#include "freepath/spectra/spectral_distribution.h"

#include <algorithm>

#include "freepath/spectra/cie_observer.h"

namespace freepath {

double SpectralDistribution::largest() const {
  double largest = (*this)(kShortestWavelength);
  for (std::size_t i = 1; i < kObserverNodes; ++i) {
    largest = std::max(largest, (*this)(observer_node(i)));
  }
  // The lines between samples have their extremes at the samples.
  if (const auto* samples = std::get_if<LinearSpectrum>(&kind_)) {
    for (const double wavelength : samples->wavelengths()) {
      if (wavelength < kShortestWavelength || wavelength > kLongestWavelength) continue;
      largest = std::max(largest, (*this)(wavelength));
    }
  }
  return largest;
}

}  // namespace freepath
