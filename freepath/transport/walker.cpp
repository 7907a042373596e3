#include "freepath/transport/walker.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/transport/end_scattering.h"

namespace freepath {
namespace {

std::vector<MethodInfo> infos_of(const std::vector<Kernel>& kernels) {
  std::vector<MethodInfo> infos;
  infos.reserve(kernels.size());
  for (const Kernel& kernel : kernels) infos.push_back(kernel.info);
  return infos;
}

const Kernel& find(const std::vector<Kernel>& kernels, const std::string& name) {
  for (const Kernel& kernel : kernels) {
    if (kernel.info.name == name) return kernel;
  }
  fail("there is no kernel '{}'", name);
}

/// What a method, given with its options, says of itself.
const MethodInfo& info_of(const std::string& text, std::span<const MethodInfo> known) {
  const std::string name = parse_method(text, known).name;
  return *std::find_if(known.begin(), known.end(),
                       [&](const MethodInfo& info) { return info.name == name; });
}

[[noreturn]] void fail_to_share_paths(const WalkSettings& settings) {
  fail("tracker '{}' gives each channel of this medium its own path: walk each by itself",
       settings.tracker);
}

void check_channels(const Medium& medium, const MediumChannels& channels) {
  if (channels.count < 1 || channels.count > kMaxChannels) {
    fail("a path carries 1 to {} channels, not {}; CMake's FREEPATH_MAX_CHANNELS sets how many",
         kMaxChannels, channels.count);
  }
  if (channels.components.size() != medium.components().size()) {
    fail("cross sections are given of {} components, but the medium has {}",
         channels.components.size(), medium.components().size());
  }
  const auto is_sound = [](float value) { return std::isfinite(value) && value >= 0; };
  for (std::size_t k = 0; k < channels.components.size(); ++k) {
    const ComponentChannels& values = channels.components[k];
    for (int channel = 0; channel < channels.count; ++channel) {
      if (is_sound(values.sigma_a[channel]) && is_sound(values.sigma_s[channel]) &&
          is_sound(values.emission[channel])) {
        continue;
      }
      fail(
          "component {} in channel {}: sigma_a {}, sigma_s {} and emission {} have to be finite "
          "and "
          "not negative",
          k, channel, values.sigma_a[channel], values.sigma_s[channel], values.emission[channel]);
    }
  }
}

MediumChannels channels_to_walk(const Medium& medium, const WalkSettings& settings, int channel) {
  if (channel == Walker::kAllChannels && !shares_paths(medium, settings)) {
    fail_to_share_paths(settings);
  }
  return channels_of(medium, channel);
}

}  // namespace

std::span<const MethodInfo> tracker_infos() {
  static const std::vector<MethodInfo> kInfos = infos_of(kernels(Simd::kOneLane).trackers);
  return kInfos;
}

std::span<const MethodInfo> transmittance_infos() {
  static const std::vector<MethodInfo> kInfos = infos_of(kernels(Simd::kOneLane).transmittance);
  return kInfos;
}

bool shares_paths(const MediumChannels& channels, const WalkSettings& settings) {
  const MethodInfo info = info_of(settings.tracker, tracker_infos());
  return info.chromatic || (channels.has_grey_extinction() && !info.one_channel);
}

bool shares_paths(const Medium& medium, const WalkSettings& settings) {
  const MethodInfo info = info_of(settings.tracker, tracker_infos());
  return info.chromatic || (medium.has_grey_extinction() && !info.one_channel);
}

Walker::Walker(const Medium& medium, const WalkSettings& settings, int channel)
    : Walker(medium, channels_to_walk(medium, settings, channel), settings) {}

Walker::Walker(const Medium& medium, const MediumChannels& channels, const WalkSettings& settings)
    : seed_(settings.seed), channels_(channels.is_grey() ? 1 : channels.count) {
  check_channels(medium, channels);
  if (channels_ > 1 && !shares_paths(channels, settings)) fail_to_share_paths(settings);
  view_ = view_of(medium, settings.interpolation, channels, settings.origin);
  if (!medium.part_tree().leaves().empty()) {
    parts_ = std::make_shared<const PartWalks>(medium, channels, settings.origin);
  }
  const KernelTable& table = kernels(settings.simd);
  tracker_.method = parse_method(settings.tracker, tracker_infos());
  transmittance_.method = parse_method(settings.transmittance, transmittance_infos());
  const Kernel& tracker = find(table.trackers, tracker_.method.name);
  const Kernel& transmittance = find(table.transmittance, transmittance_.method.name);
  for (const Kernel* kernel : {&tracker, &transmittance}) {
    if (kernel->check != nullptr) kernel->check(medium, settings.interpolation);
  }
  if (tracker.uniform_emission && channels.emits() && channels.has_radiance_fields()) {
    fail(
        "tracker '{}' takes emitted radiance for the same everywhere, but here it varies from "
        "place to place: take a null-collision tracker",
        settings.tracker);
  }
  tracker_.channels = channels_;
  tracker_.function = tracker.walks[compiled_channels(tracker.walks, channels_)];
  // One extinction for all channels makes one transmittance.
  transmittance_.weights = PartWeights::kMultiplied;
  transmittance_.channels = channels.has_grey_extinction() ? 1 : channels_;
  transmittance_.function =
      transmittance.walks[compiled_channels(transmittance.walks, transmittance_.channels)];
  modes_ = {settings.absorption, settings.emission, channels.emits()};
}

void Walker::walk(const Bound& bound, const WalkModes& modes, const RayStream& rays,
                  FlightStream& flights, WalkStatistics& statistics) const {
  flights.resize(rays.size());
  if (parts_) {
    parts_->walk(bound.function, bound.weights, view_, bound.method.options, modes, seed_,
                 bound.channels, rays, flights, statistics);
    return;
  }
  bound.function(view_, bound.method.options, modes, seed_, rays, flights, statistics);
}

void Walker::free_paths(const RayStream& rays, FlightStream& flights,
                        WalkStatistics& statistics) const {
  walk(tracker_, modes_, rays, flights, statistics);
}

void Walker::transmittance(const RayStream& rays, FlightStream& flights,
                           WalkStatistics& statistics) const {
  walk(transmittance_, WalkModes{}, rays, flights, statistics);
}

void Walker::scattering_at_ends(const RayStream& rays, FlightStream& flights,
                                WalkStatistics& statistics) const {
  Bound bound;
  bound.function = &scattering_at_ends_of;
  bound.channels = channels_;
  walk(bound, WalkModes{}, rays, flights, statistics);
}

}  // namespace freepath
