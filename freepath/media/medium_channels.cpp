#include "freepath/media/medium_channels.h"

#include <algorithm>
#include <limits>

#include "freepath/base/rgb.h"

namespace freepath {
namespace {

using Values = std::array<float, kMaxChannels>;

bool all_equal(const Values& values, int count) {
  return std::all_of(values.begin(), values.begin() + count,
                     [&](float value) { return value == values[0]; });
}

/// (1 - albedo) · sigma and albedo · sigma, each scaled once more, add up to sigma within a few
/// units in the last place.
bool is_grey_but_for_rounding(const ComponentChannels& c, int count) {
  constexpr float kTolerance = 8 * std::numeric_limits<float>::epsilon();
  float low = std::numeric_limits<float>::infinity();
  float high = 0;
  for (int i = 0; i < count; ++i) {
    low = std::min(low, c.sigma_a[i] + c.sigma_s[i]);
    high = std::max(high, c.sigma_a[i] + c.sigma_s[i]);
  }
  return high - low <= kTolerance * high;
}

}  // namespace

bool MediumChannels::has_grey_extinction() const {
  return std::all_of(components.begin(), components.end(), [this](const ComponentChannels& c) {
    return is_grey_but_for_rounding(c, count);
  });
}

bool MediumChannels::has_radiance_fields() const {
  return std::any_of(components.begin(), components.end(), [this](const ComponentChannels& c) {
    return std::any_of(c.radiance.begin(), c.radiance.begin() + count,
                       [](const RadianceField& radiance) { return radiance.field != nullptr; });
  });
}

bool MediumChannels::is_grey() const {
  if (count > 1 && has_radiance_fields()) return false;
  return std::all_of(components.begin(), components.end(), [this](const ComponentChannels& c) {
    return all_equal(c.sigma_a, count) && all_equal(c.sigma_s, count) &&
           all_equal(c.emission, count);
  });
}

bool MediumChannels::emits() const {
  return std::any_of(components.begin(), components.end(), [this](const ComponentChannels& c) {
    for (int i = 0; i < count; ++i) {
      if (c.sigma_a[i] > 0 && c.emission[i] > 0) return true;
    }
    return false;
  });
}

MediumChannels MediumChannels::only(int channel) const {
  MediumChannels one;
  one.count = 1;
  for (const ComponentChannels& component : components) {
    ComponentChannels& target = one.components.emplace_back();
    target.sigma_a[0] = component.sigma_a[channel];
    target.sigma_s[0] = component.sigma_s[channel];
    target.emission[0] = component.emission[channel];
    target.radiance.fill(component.radiance[channel]);
  }
  return one;
}

MediumChannels channels_of(const Medium& medium, int channel) {
  MediumChannels channels;
  channels.count = channel < 0 && !medium.is_grey() ? kChannels : 1;
  for (const Component& component : medium.components()) {
    ComponentChannels& target = channels.components.emplace_back();
    for (int slot = 0; slot < kChannels; ++slot) {
      const int from = channel < 0 ? slot : channel;
      target.sigma_a[slot] = component.sigma_a[from];
      target.sigma_s[slot] = component.sigma_s[from];
      target.emission[slot] = component.emission[from];
      target.radiance[slot] = component.radiance[from];
    }
  }
  return channels;
}

}  // namespace freepath
