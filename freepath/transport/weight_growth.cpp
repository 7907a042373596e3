#include "freepath/transport/weight_growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();
/// A mean square of the weight that costs so many times the paths is noise still; more is none.
constexpr double kLargestGrowth = 1000;
/// 1, but for the rounding of cross sections.
constexpr double kBarelyOne = 1 + 1e-6;

/// A method with the names of its options.
class NamedMethod {
 public:
  NamedMethod(const std::string& text, std::span<const MethodInfo> known)
      : text_(text), method_(parse_method(text, known)), info_(find(method_.name, known)) {}

  const std::string& text() const { return text_; }
  std::string_view name() const { return method_.name; }
  /// The value of an option, or what stands for it where the method has none of the name.
  float option(std::string_view name, float otherwise) const {
    for (std::size_t i = 0; i < info_.options.size(); ++i) {
      if (info_.options[i].name == name) return method_.options[i];
    }
    return otherwise;
  }
  /// The same as a word; empty where the method has no such option.
  std::string_view word(std::string_view name) const {
    for (std::size_t i = 0; i < info_.options.size(); ++i) {
      const MethodOption& option = info_.options[i];
      if (option.name == name) return option.choices[static_cast<std::size_t>(method_.options[i])];
    }
    return {};
  }
  bool biased() const { return info_.biased; }

 private:
  static const MethodInfo& find(std::string_view name, std::span<const MethodInfo> known) {
    return *std::find_if(known.begin(), known.end(),
                         [&](const MethodInfo& info) { return info.name == name; });
  }

  std::string text_;
  Method method_;
  const MethodInfo& info_;
};

/// Of weighted-delta with a rate of `scale` < 1 times the bound, where the extinction reaches it.
/// With x = mu_t/rate a collision multiplies the weight by ±(2x - 1) and is real with probability
/// x/(2x - 1), hence M = (2x - 1) (x + (x - 1) M); M grows with x, so that it bounds what happens
/// wherever the extinction lies below its bound.
WeightGrowth growth_below_the_bound(double scale) {
  const double x = 1 / scale;
  const double null = (2 * x - 1) * (x - 1);
  WeightGrowth growth;
  growth.per_flight = null < 1 ? (2 * x - 1) * x / (1 - null) : kNoBound;
  growth.per_mean_free_path = 2 * x - 1;
  return growth;
}

/// Of a scattering that is chosen by the mean albedo of channels: one of albedo a keeps the mean
/// square a²/ā. That is largest where a component is alone, being convex.
double growth_of_mean_albedo(const MediumChannels& channels) {
  double largest = 0;
  for (const ComponentChannels& component : channels.components) {
    double sum = 0;
    double most = 0;
    for (int c = 0; c < channels.count; ++c) {
      const double sigma_t = double{component.sigma_a[c]} + component.sigma_s[c];
      const double albedo = sigma_t > 0 ? component.sigma_s[c] / sigma_t : 0;
      sum += albedo;
      most = std::max(most, albedo);
    }
    if (sum > 0) largest = std::max(largest, most * most * channels.count / sum);
  }
  return largest;
}

/// Of the methods whose events are chosen by coefficients of several channels, and not by the
/// path's own throughput.
WeightGrowth growth_of_choice(const NamedMethod& tracker, const MediumChannels& channels,
                              Absorption absorption) {
  WeightGrowth growth;
  if (channels.is_grey()) return growth;
  const std::string_view probability = tracker.word("collision-probability");
  if (probability.empty()) {  // of the mean over channels that share an extinction
    const bool partitions = tracker.word("energy-partitioning") == "yes";
    if (tracker.name() == "hero-wavelength") {
      if (tracker.word("selection") != "throughput-albedo") return growth;
      // A tenth of the heroes are drawn whatever the throughput is.
      growth.per_flight = 1 / 0.9;
      growth.reason = "its heroes are drawn anew at each scattering; take selection=uniform";
    } else if (partitions || absorption == Absorption::kAnalog) {
      const double mean_square = growth_of_mean_albedo(channels);
      if (mean_square <= kBarelyOne) return growth;
      growth.per_flight = mean_square;
      growth.reason =
          partitions ? "energy-partitioning chooses one event for channels of different albedo; "
                       "take energy-partitioning=no and weighted absorption"
                     : "analog absorption chooses one event for channels of different albedo; take "
                       "weighted absorption (--absorption weighted), or the tracker spectral";
    }
    return growth;
  }
  // By history-max they grow to a few times that, and slowly.
  if (probability.starts_with("history")) return growth;
  if (probability == "average" && absorption == Absorption::kWeighted &&
      channels.has_grey_extinction()) {
    return growth;
  }
  growth.per_flight = kNoBound;
  growth.reason = fmt::format(
      "with collision-probability={} events don't follow the throughput of the path in media of "
      "colour; take collision-probability=history-average",
      probability);
  return growth;
}

}  // namespace

WeightGrowth weight_growth(const MediumChannels& channels, const WalkSettings& settings) {
  const NamedMethod tracker(settings.tracker, tracker_infos());
  if (tracker.biased()) return {};
  WeightGrowth growth;
  const float scale = tracker.option("rate-scale", 1);
  const float control = tracker.option("control", 1);
  if (scale < 1) {
    growth = growth_below_the_bound(scale);
    if (tracker.name() != "weighted-delta" || !channels.is_grey()) growth.per_flight = kNoBound;
    growth.reason = fmt::format(
        "a rate of {:g} times the bound is no bound; take a rate-scale of 1 or more", scale);
  } else if (control > 1) {
    growth.per_flight = kNoBound;
    growth.reason = fmt::format(
        "a control of {:g} times the minimum exceeds it; take a control of at most 1", control);
  } else {
    growth = growth_of_choice(tracker, channels, settings.absorption);
  }
  if (!growth.bounded()) {
    growth.reason = fmt::format("tracker {}: weights grow at every scattering, since {}",
                                tracker.text(), growth.reason);
  }
  return growth;
}

WeightGrowth shadow_weight_growth(const WalkSettings& settings) {
  const NamedMethod estimator(settings.transmittance, transmittance_infos());
  const float scale = estimator.option("rate-scale", 1);
  // E[W²] = exp ∫(mu_n²/rate - rate) = exp ∫mu_t (mu_t/rate - 2).
  if (estimator.biased() || scale >= 0.5F) return {};
  return {kNoBound, 1,
          fmt::format("transmittance {}: with a rate below half of the extinction the weights of "
                      "shadow rays grow with their length; take a rate-scale of 0.5 or more",
                      estimator.text())};
}

void require_bounded_weights(const WeightGrowth& growth, uint32_t max_scatterings) {
  if (growth.bounded()) return;
  const double flights = static_cast<double>(max_scatterings) + 1;
  if (flights * std::log(growth.per_flight) <= std::log(kLargestGrowth)) return;
  const bool limits = std::isfinite(growth.per_flight);
  const auto most = std::floor(std::log(kLargestGrowth) / std::log(growth.per_flight)) - 1;
  fail("{}{}; the variance of the picture would be infinite", growth.reason,
       limits && most >= 1 ? fmt::format(", or at most {} (maxdepth)", counted(most, "scattering"))
                           : "");
}

std::string weights_in_paths(const MethodInfo& info) {
  const bool tracks = std::any_of(tracker_infos().begin(), tracker_infos().end(),
                                  [&](const MethodInfo& other) { return other.name == info.name; });
  const std::array<std::array<std::string_view, 2>, 4> of_options = {{
      {"rate-scale", tracks ? "a rate-scale below 1" : "a rate-scale below 0.5"},
      {"control", "a control above 1"},
      {"collision-probability", "collision-probability=max or average in media of colour"},
      {"selection", "selection=throughput-albedo in media of colour"},
  }};
  std::string options;
  for (const auto& [name, what] : of_options) {
    const bool has = std::any_of(
        info.options.begin(), info.options.end(),
        [&, wanted = name](const MethodOption& option) { return option.name == wanted; });
    if (has) options += fmt::format("{}{}", options.empty() ? "" : " or ", what);
  }
  if (options.empty()) return {};
  const char* const how = tracks ? "at every scattering" : "with the length of a shadow ray";
  return fmt::format("with {} weights grow {}, and pictures refuse it", options, how);
}

}  // namespace freepath
