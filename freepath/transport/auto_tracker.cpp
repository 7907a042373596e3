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

/// Share of the tentative collisions that the minima decide, were the rays spread evenly.
double control_share(const Medium& medium, const MediumChannels& channels) {
  const std::size_t components = medium.components().size();
  double control = 0;
  double rate = 0;
  for (std::size_t k = 0; k < components; ++k) {
    const ComponentChannels& values = channels.components[k];
    float sigma_t = 0;
    for (int channel = 0; channel < channels.count; ++channel) {
      sigma_t = std::max(sigma_t, values.sigma_a[channel] + values.sigma_s[channel]);
    }
    for (const WalkPart& part : medium.parts()) {
      const SuperVoxels& cells = part.cells;
      const double volume = double(cells.cell_size) * cells.cell_size * cells.cell_size;
      for (std::size_t cell = 0; cell < cells.cell_count(); ++cell) {
        control += volume * sigma_t * cells.minima[cell * components + k];
        rate += volume * sigma_t * cells.maxima[cell * components + k];
      }
    }
  }
  return rate > 0 ? control / rate : 0;
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

}  // namespace freepath
