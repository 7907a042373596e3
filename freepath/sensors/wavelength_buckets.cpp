#include "freepath/sensors/wavelength_buckets.h"

#include <fmt/format.h>

#include <algorithm>

namespace freepath {

int WavelengthBuckets::bucket_of(double wavelength) const {
  if (count == 0 || !(wavelength >= first && wavelength <= last)) return -1;
  return std::min(static_cast<int>((wavelength - first) / (last - first) * count), count - 1);
}

std::string WavelengthBuckets::channel(int bucket) const {
  // A dot would separate layers.
  std::string middle = fmt::format("{:.6f}", first + (last - first) * (bucket + 0.5) / count);
  std::replace(middle.begin(), middle.end(), '.', ',');
  return fmt::format("S0.{}nm", middle);
}

}  // namespace freepath
