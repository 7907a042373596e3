#include "freepath/study/lab_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <utility>

#include "freepath/transport/walker.h"

namespace freepath {
namespace {

/// Series in a chart beyond which nobody tells them apart.
constexpr std::size_t kMostSeries = 5;
constexpr double kNormal95 = 1.96;

ChartAxis along_ray() { return {.label = "x", .minimum = 0, .maximum = 1}; }

std::vector<double> bin_edges() {
  std::vector<double> edges;
  for (int bin = 0; bin <= kLabBins; ++bin) edges.push_back(double{1} * bin / kLabBins);
  return edges;
}

ChartSeries exact_series(const std::vector<double>& values, std::string name) {
  return {.name = std::move(name),
          .x = bin_edges(),
          .y = values,
          .mark = ChartMark::kSteps,
          .is_reference = true};
}

/// Density times weight, in a band of two standard errors.
ChartSeries scattered_series(const LabChannel& channel, std::string name) {
  ChartSeries series{
      .name = std::move(name), .x = bin_edges(), .y = channel.scattered, .mark = ChartMark::kSteps};
  for (int bin = 0; bin < kLabBins; ++bin) {
    series.low.push_back(channel.scattered[bin] - kNormal95 * channel.error[bin]);
    series.high.push_back(channel.scattered[bin] + kNormal95 * channel.error[bin]);
  }
  return series;
}

/// Measurements worth drawing, a few at a time: where there are many, those whose weights exceed 1
/// or which are biased, next to the first one, which stands for the others.
std::vector<std::vector<const LabMeasurement*>> groups_of(const LabFindings& findings) {
  constexpr float kRounding = 1.001F;
  std::vector<const LabMeasurement*> present;
  for (const LabMeasurement& measurement : findings.trackers) {
    if (measurement.refusal.empty()) present.push_back(&measurement);
  }
  if (present.size() > kMostSeries) {
    std::erase_if(present, [first = present[0]](const LabMeasurement* each) {
      return each != first && !each->biased && each->statistics.largest_weight <= kRounding;
    });
  }
  const std::size_t count = (present.size() + kMostSeries - 1) / kMostSeries;
  std::vector<std::vector<const LabMeasurement*>> groups(count);
  for (std::size_t i = 0; i < present.size(); ++i) {
    groups[i * count / present.size()].push_back(present[i]);
  }
  return groups;
}

std::string numbered(const std::string& name, std::size_t number, std::size_t count) {
  return count > 1 ? fmt::format("{}-{}", name, number + 1) : name;
}

/// mu_t T: the density of real collisions of a tracker without weights.
std::vector<double> collision_density(const LabCurves& curves, int channel) {
  std::vector<double> density;
  density.reserve(kLabBins);
  for (int bin = 0; bin < kLabBins; ++bin) {
    density.push_back(kLabBins * (curves.transmittance(double{1} * bin / kLabBins, channel) -
                                  curves.transmittance(double{1} * (bin + 1) / kLabBins, channel)));
  }
  return density;
}

std::vector<LabFigure> grey_free_paths(const LabFindings& findings) {
  std::vector<LabFigure> figures;
  const auto groups = groups_of(findings);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    Chart sampled{.title = "Where flights end: density of samples",
                  .x = along_ray(),
                  .y = {.label = "density of real collisions [1/m]", .minimum = 0},
                  .series = {}};
    Chart weighted{.title = "Density × weight: scattering",
                   .x = along_ray(),
                   .y = {.label = "density × weight [1/m]", .minimum = 0},
                   .series = {}};
    for (const LabMeasurement* measurement : groups[i]) {
      const LabChannel& channel = measurement->channels[0];
      const std::string name = lab_label(measurement->tracker);
      sampled.series.push_back(
          {.name = name, .x = bin_edges(), .y = channel.ended, .mark = ChartMark::kSteps});
      weighted.series.push_back(scattered_series(channel, name));
    }
    sampled.series.push_back(exact_series(collision_density(findings.curves, 0), "exact µt T"));
    weighted.series.push_back(exact_series(groups[i][0]->channels[0].exact, "exact µs T"));
    figures.push_back(
        {numbered("sampled", i, groups.size()), std::move(sampled),
         "Counts of flights that end in a real collision. A tracker may sample "
         "another density than the exact one: its weights make up for it. Trackers that "
         "are not drawn sample as the first one does."});
    figures.push_back({numbered("free-paths", i, groups.size()), std::move(weighted),
                       "The same flights, each counted with its weight: the scattering that the "
                       "transfer equation asks for, in bands of 95 %."});
  }
  return figures;
}

/// One tracker, all channels.
LabFigure chromatic_free_paths(const LabFindings& findings, const LabMeasurement& measurement) {
  LabFigure figure;
  figure.name = "free-paths-" + lab_slug(measurement.tracker);
  figure.chart.title = "Free paths: " + lab_label(measurement.tracker);
  figure.chart.x = along_ray();
  figure.chart.y = {.label = "density × weight [1/m]", .minimum = 0};
  for (const int channel : kLabDrawingOrder) {
    figure.chart.series.push_back(
        scattered_series(measurement.channels[channel], kLabChannelNames[channel]));
  }
  if (measurement.shared) {
    figure.chart.series.push_back({.name = "sampled",
                                   .x = bin_edges(),
                                   .y = measurement.channels[0].ended,
                                   .mark = ChartMark::kSteps});
  }
  for (int channel = 0; channel < findings.setting.channels; ++channel) {
    figure.chart.series.push_back(
        exact_series(measurement.channels[channel].exact, channel == 0 ? "exact µs T" : ""));
  }
  figure.caption =
      measurement.shared
          ? "One density is sampled for all channels; times the weights of each it is "
            "the exact one of each."
          : "Each channel takes paths of its own. Trackers that are not drawn look like the "
            "first one.";
  return figure;
}

}  // namespace

std::string lab_label(const std::string& tracker) {
  const std::size_t colon = tracker.find(':');
  const std::string name = tracker.substr(0, colon);
  std::string options = colon == std::string::npos ? "" : tracker.substr(colon + 1);
  constexpr std::string_view kProbability = "collision-probability=";
  const std::size_t found = options.find(kProbability);
  if (found != std::string::npos) {
    options.erase(found, kProbability.size());
  } else if (name == "spectral" || name == "spectral-decomposition") {
    options = options.empty() ? "history-average" : "history-average," + options;
  }
  return options.empty() ? name : name + ", " + options;
}

std::string lab_slug(const std::string& text) {
  std::string slug;
  for (const char c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.';
    slug += plain ? c : '-';
  }
  return slug;
}

LabFigure extinction_figure(const LabFindings& findings) {
  LabFigure figure{"extinction",
                   {.title = "Extinction, between the bounds of its super-voxels",
                    .x = along_ray(),
                    .y = {.label = "µt [1/m]", .minimum = 0},
                    .series = {}},
                   "The band reaches from the least to the largest extinction of each super-voxel, "
                   "which is what trackers know of it before they look."};
  const std::vector<LabBounds> bounds = lab_bounds(findings.setting);
  const bool grey = findings.setting.channels == 1;
  for (const int channel : kLabDrawingOrder) {
    if (channel >= findings.setting.channels) continue;
    ChartSeries series{.name = grey ? "µt" : kLabChannelNames[channel],
                       .x = {},
                       .y = {},
                       .mark = ChartMark::kSteps};
    for (int voxel = 0; voxel < kLabVoxels; ++voxel) {
      const LabBounds& cell = bounds[voxel / kLabCell];
      series.x.push_back(double{1} * voxel / kLabVoxels);
      series.y.push_back(findings.curves.sigma_t((voxel + 0.5) / kLabVoxels, channel));
      series.low.push_back(cell.minorant[channel]);
      series.high.push_back(cell.majorant[channel]);
    }
    series.x.push_back(1);
    figure.chart.series.push_back(std::move(series));
  }
  return figure;
}

std::vector<LabFigure> free_path_figures(const LabFindings& findings) {
  if (findings.setting.channels == 1) return grey_free_paths(findings);
  std::vector<LabFigure> figures;
  for (const auto& group : groups_of(findings)) {
    for (const LabMeasurement* measurement : group) {
      figures.push_back(chromatic_free_paths(findings, *measurement));
    }
  }
  return figures;
}

std::vector<LabFigure> deviation_figures(const LabFindings& findings) {
  std::vector<LabFigure> figures;
  const auto groups = groups_of(findings);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    LabFigure figure{
        numbered("deviation", i, groups.size()),
        {.title = "Scattered weight up to x, less what is exact",
         .x = along_ray(),
         .y = {.label = "deviation of the sum"},
         .series = {}},
        findings.setting.channels == 1
            ? "Unbiased trackers stay near 0 and come back to it as paths are added."
            : "Of the first channel. Unbiased trackers stay near 0 and come back to it "
              "as paths are added."};
    for (const LabMeasurement* measurement : groups[i]) {
      const LabChannel& channel = measurement->channels[0];
      ChartSeries series{.name = lab_label(measurement->tracker), .x = {0}, .y = {0}};
      double sum = 0;
      for (int bin = 0; bin < kLabBins; ++bin) {
        sum += (channel.scattered[bin] - channel.exact[bin]) / kLabBins;
        series.x.push_back(double{1} * (bin + 1) / kLabBins);
        series.y.push_back(sum);
      }
      figure.chart.series.push_back(std::move(series));
    }
    figure.chart.series.push_back(
        {.name = "exact", .x = {0, 1}, .y = {0, 0}, .is_reference = true});
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<LabFigure> weight_figures(const LabFindings& findings) {
  std::vector<LabFigure> figures;
  const auto groups = groups_of(findings);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    LabFigure figure{
        numbered("weights", i, groups.size()),
        {.title = "Weights that flights end with",
         .x = {.label = "|weight|", .logarithmic = true, .minimum = 1e-3, .maximum = 1e3},
         .y = {.label = "share of the flights", .logarithmic = true},
         .series = {}},
        "Scatterings and escapes, in ten bins a decade, all channels together. The "
        "further the right tail reaches, the larger the variance."};
    for (const LabMeasurement* measurement : groups[i]) {
      ChartSeries series{.name = lab_label(measurement->tracker),
                         .x = {},
                         .y = std::vector<double>(kLabWeightBins, 0.0),
                         .mark = ChartMark::kSteps};
      for (int bin = 0; bin < kLabWeightBins; ++bin) {
        series.x.push_back(lab_weight_edge(bin));
        for (const LabChannel& channel : measurement->channels) {
          series.y[bin] += channel.weights[bin] / static_cast<double>(measurement->channels.size());
        }
      }
      series.x.push_back(lab_weight_edge(kLabWeightBins));
      figure.chart.series.push_back(std::move(series));
    }
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace freepath
