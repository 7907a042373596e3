#include "freepath/transport/auto_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "freepath/transport/walker.h"

namespace freepath {
namespace {

/// A control pays for reading the minima once it decides this share of the collisions; measured
/// with bench/tracker_bench.
constexpr double kWorthwhileControl = 0.3;

/// Reading one component a collision pays from so many on.
constexpr std::size_t kManyComponents = 3;

/// Integrals of a bound of super-voxels over their volume, one for each component.
std::vector<double> integrals_of(const Medium& medium, std::vector<float> SuperVoxels::*bound) {
  const std::size_t components = medium.components().size();
  std::vector<double> sums(components);
  for (const WalkPart& part : medium.parts()) {
    const SuperVoxels& cells = part.cells;
    const double volume = double(cells.cell_size) * cells.cell_size * cells.cell_size;
    for (std::size_t i = 0; i < cells.cell_count() * components; ++i) {
      sums[i % components] += volume * (cells.*bound)[i];
    }
  }
  return sums;
}

/// Share of the tentative collisions that the minima decide, were the rays spread evenly.
double control_share(const Medium& medium, const MediumChannels& channels) {
  const std::vector<double> minima = integrals_of(medium, &SuperVoxels::minima);
  const std::vector<double> maxima = integrals_of(medium, &SuperVoxels::maxima);
  double control = 0;
  double rate = 0;
  for (std::size_t k = 0; k < maxima.size(); ++k) {
    const ComponentChannels& values = channels.components[k];
    float sigma_t = 0;
    for (int channel = 0; channel < channels.count; ++channel) {
      sigma_t = std::max(sigma_t, values.sigma_a[channel] + values.sigma_s[channel]);
    }
    control += sigma_t * minima[k];
    rate += sigma_t * maxima[k];
  }
  return rate > 0 ? control / rate : 0;
}

/// Where the largest extinction of a channel is so many times the least one, and the largest albedo
/// is at least this, channels are better off with paths of their own: of a cloud with coefficients
/// 1 : 0.7 : 0.5 and albedo 0.99 the efficiency of those is 1.3 times that of `spectral`, with
/// 1 : 0.9 : 0.8 it is 0.6; of one with 1 : 0.5 : 0.25 and albedo 0.3 it is 0.9.
constexpr double kApartByExtinction = 1.7;
constexpr double kApartByAlbedo = 0.6;

/// Extinctions and albedos of channels, of all components by their bounds.
struct ChannelSpread {
  double extinction_ratio = 1;  ///< The largest over the least.
  double albedo = 0;            ///< The largest.
};

ChannelSpread channel_spread(const Medium& medium, const MediumChannels& channels) {
  const std::vector<double> densities = integrals_of(medium, &SuperVoxels::maxima);
  std::vector<double> sigma_t(channels.count);
  ChannelSpread spread;
  for (int channel = 0; channel < channels.count; ++channel) {
    double sigma_s = 0;
    for (std::size_t k = 0; k < densities.size(); ++k) {
      const ComponentChannels& values = channels.components[k];
      sigma_s += densities[k] * values.sigma_s[channel];
      sigma_t[channel] +=
          densities[k] * (double{values.sigma_a[channel]} + values.sigma_s[channel]);
    }
    if (sigma_t[channel] > 0) spread.albedo = std::max(spread.albedo, sigma_s / sigma_t[channel]);
  }
  const auto [least, most] = std::minmax_element(sigma_t.begin(), sigma_t.end());
  spread.extinction_ratio = *most / *least;  // infinite where a channel is clear
  return spread;
}

TrackerChoice choose_tracker(const Medium& medium, const MediumChannels& channels) {
  const double share = control_share(medium, channels);
  const std::string decided =
      fmt::format("minima of super-voxels decide {:.0f} % of the collisions", 100 * share);
  if (!channels.has_grey_extinction()) {
    const std::string chromatic = "the extinction differs between channels, and " + decided;
    return share >= kWorthwhileControl ? TrackerChoice{"spectral-decomposition", chromatic}
                                       : TrackerChoice{"spectral", chromatic};
  }
  if (medium.components().size() >= kManyComponents) {
    return {"multi-volume", fmt::format("channels share one extinction, and one of {} components "
                                        "is looked up instead of all",
                                        medium.components().size())};
  }
  const std::string grey = "channels share one extinction, and " + decided;
  return share >= kWorthwhileControl ? TrackerChoice{"decomposition", grey}
                                     : TrackerChoice{"delta", grey};
}

constexpr MethodInfo kAutomatic = {
    "auto", "chooses a tracker from the medium and says which and why",
    "",     "as the tracker it chooses",
    "",     {}};

}  // namespace

std::span<const MethodInfo> tracker_choices() {
  static const std::vector<MethodInfo> kChoices = [] {
    std::vector<MethodInfo> choices(tracker_infos().begin(), tracker_infos().end());
    choices.push_back(kAutomatic);
    return choices;
  }();
  return kChoices;
}

bool is_automatic(std::string_view tracker) { return tracker == kAutomatic.name; }

TrackerChoice settle_tracker(std::string tracker, const Medium& medium) {
  if (!is_automatic(tracker)) return {std::move(tracker), {}};
  return choose_tracker(medium, channels_of(medium));
}

TrackerChoice settle_tracker(std::string tracker, const Medium& medium,
                             const MediumChannels& channels) {
  if (!is_automatic(tracker)) return {std::move(tracker), {}};
  return choose_tracker(medium, channels);
}

TrackerChoice settle_picture_tracker(std::string tracker, const Medium& medium) {
  const MediumChannels channels = channels_of(medium);
  if (is_automatic(tracker) && !channels.has_grey_extinction()) {
    const ChannelSpread spread = channel_spread(medium, channels);
    if (spread.extinction_ratio >= kApartByExtinction && spread.albedo >= kApartByAlbedo) {
      return {"delta",
              fmt::format("a path for each channel, as their extinctions differ by a factor "
                          "of {:.2g} at albedos up to {:.2g}",
                          spread.extinction_ratio, spread.albedo)};
    }
  }
  return settle_tracker(std::move(tracker), medium);
}

}  // namespace freepath
