#include "freepath/spectra/cie_observer.h"

#include <algorithm>
#include <cstddef>

namespace freepath {

Vec3d color_matching(double wavelength) {
  if (!(wavelength >= kShortestWavelength && wavelength <= kLongestWavelength)) return Vec3d(0);
  const double position = wavelength - kShortestWavelength;
  const std::size_t left = std::min(static_cast<std::size_t>(position), kCie1931Table.size() - 2);
  const double share = position - static_cast<double>(left);
  const auto& [x0, y0, z0] = kCie1931Table[left];
  const auto& [x1, y1, z1] = kCie1931Table[left + 1];
  return {x0 + share * (x1 - x0), y0 + share * (y1 - y0), z0 + share * (z1 - z0)};
}

Chromaticity chromaticity_of(const Vec3d& xyz) {
  const double sum = xyz.x + xyz.y + xyz.z;
  return {xyz.x / sum, xyz.y / sum};
}

}  // namespace freepath
