#include "freepath/lights/thermal_radiance.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "freepath/spectra/blackbody.h"

namespace freepath {
namespace {

/// Below this a black body of the scene language emits nothing [K].
constexpr double kCoolest = 100;

/// Steps of a table of thermal radiance: at 1500 K a step of 2 K changes violet, the steepest, by
/// 3 %, so that a straight line is off by 1e-4.
constexpr double kTableStep = 2;             // [K]
constexpr std::size_t kLargestTable = 8192;  // values, beyond which steps grow

struct ValueSpan {
  float low = 0, high = 0;
};

/// What a field's values span, those outside its voxels, 0, included.
ValueSpan span_of(const Field& field) {
  ValueSpan range;
  for (const float value : field.voxels.voxels()) {
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

}  // namespace

double thermal_radiance(double temperature, double wavelength) {
  if (!(temperature > kCoolest)) return 0;
  return kMediumRadiance * BlackbodySpectrum(temperature, BlackbodyScale::kPeak)(wavelength);
}

Vec3d thermal_xyz(double temperature) {
  if (!(temperature > kCoolest)) return Vec3d(0);
  return observe(BlackbodySpectrum(temperature, BlackbodyScale::kPeak)) * kMediumRadiance;
}

std::array<RadianceField, kMaxChannels> tabulate_radiance(
    const TemperatureEmission& emission, const std::function<SampledSpectrum(double)>& radiance) {
  std::array<RadianceField, kMaxChannels> fields;
  const ValueSpan range = span_of(*emission.field);
  const auto temperature = [&](double value) { return (value - emission.offset) * emission.scale; };
  const double hottest = std::max(temperature(range.low), temperature(range.high));
  if (!(hottest > kCoolest)) return fields;
  const double wanted = std::clamp(hottest / kTableStep, 16.0, double{kLargestTable});
  const auto nodes = static_cast<std::size_t>(wanted);
  // Of a field that is the same everywhere any step will do.
  const float width = range.high > range.low ? range.high - range.low : 1.0F;
  const float step = width / static_cast<float>(nodes - 1);
  std::array<std::vector<float>, kMaxChannels> tables;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double value = range.low + static_cast<double>(step) * static_cast<double>(i);
    const SampledSpectrum emitted = radiance(temperature(value));
    for (int c = 0; c < kMaxChannels; ++c) tables[c].push_back(emitted[c]);
  }
  for (int c = 0; c < kMaxChannels; ++c) {
    fields[c] = {emission.field, std::make_shared<const std::vector<float>>(std::move(tables[c])),
                 range.low, step};
  }
  return fields;
}

}  // namespace freepath
