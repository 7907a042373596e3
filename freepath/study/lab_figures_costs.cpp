// Figures of what evolves along paths, and of what options cost.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "freepath/study/lab_figures.h"

namespace freepath {
namespace {

/// One tracker's stages: bands from 5 to 95 % of the living paths, and their mean.
Chart evolution_chart(const LabThroughput& throughput, const std::string& what,
                      const ChartAxis& x) {
  Chart chart{.title = what + lab_label(throughput.tracker),
              .x = x,
              .y = {.label = "|weight|", .logarithmic = true, .minimum = 1e-4, .maximum = 1e2},
              .series = {}};
  for (const int channel : kLabDrawingOrder) {
    ChartSeries series{.name = kLabChannelNames[channel], .x = {}, .y = {}};
    for (const LabStage& stage : throughput.stages) {
      const LabWeights& weights = stage.channels[channel];
      series.x.push_back(stage.at);
      series.y.push_back(std::abs(weights.mean) / stage.alive);
      series.low.push_back(weights.low);
      series.high.push_back(weights.high);
    }
    chart.series.push_back(std::move(series));
  }
  for (const int channel : kLabDrawingOrder) {
    ChartSeries series{.name = channel == kLabDrawingOrder[0] ? "exact mean" : "",
                       .x = {},
                       .y = {},
                       .is_reference = true};
    for (const LabStage& stage : throughput.stages) {
      series.x.push_back(stage.at);
      series.y.push_back(stage.channels[channel].exact / stage.alive);
    }
    if (std::isfinite(series.y.back())) chart.series.push_back(std::move(series));
  }
  return chart;
}

/// The largest weight of any path and channel, tracker by tracker.
Chart largest_chart(const std::vector<LabThroughput>& throughputs, std::string title,
                    const ChartAxis& x) {
  Chart chart{.title = std::move(title),
              .x = x,
              .y = {.label = "largest |weight|", .logarithmic = true},
              .series = {}};
  for (const LabThroughput& throughput : throughputs) {
    ChartSeries series{.name = lab_label(throughput.tracker), .x = {}, .y = {}};
    for (const LabStage& stage : throughput.stages) {
      double largest = 0;
      for (const LabWeights& weights : stage.channels) {
        largest = std::max(largest, weights.largest);
      }
      series.x.push_back(stage.at);
      series.y.push_back(largest);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

struct SweepView {
  const char* option;
  const char* name;  ///< Of the file.
  const char* title;
  const char* label;  ///< Of the y axis.
  double (*value)(const LabSweepPoint&);
  bool logarithmic_x, logarithmic_y;
  const char* caption;
};

constexpr double kNanoseconds = 1e9;

constexpr SweepView kViews[] = {
    {"control", "control-lookups", "Look-ups against the control's level", "look-ups per path",
     [](const LabSweepPoint& point) { return point.lookups; }, false, false,
     "The control is a multiple of the super-voxel's minimum; what it decides needs no look-up. "
     "Above 1 it may exceed the density, and the residual turns negative."},
    {"control", "control-variance", "Variance against the control's level", "variance",
     [](const LabSweepPoint& point) { return point.variance; }, false, true,
     "Of the radiance. Beyond the minimum, look-ups that are saved are paid for in variance; far "
     "beyond it the weights spread so widely that a finite sample underestimates it."},
    {"rate-scale", "rate-cost", "Look-ups × variance against the rate's scale",
     "look-ups × variance",
     [](const LabSweepPoint& point) { return point.lookups * point.variance; }, true, true,
     "The rate is a multiple of the majorant. Below 1 it is no bound, and negative weights raise "
     "the variance; above 1 null collisions are added for nothing."},
    {"rate-scale", "rate-time", "Time × variance against the rate's scale",
     "nanoseconds × variance",
     [](const LabSweepPoint& point) { return kNanoseconds * point.seconds * point.variance; }, true,
     true, "The same in time on one thread, which differs from run to run."},
};

}  // namespace

std::vector<LabFigure> throughput_figures(const LabFindings& findings) {
  std::vector<LabFigure> figures;
  if (findings.along_ray.empty()) return figures;
  const ChartAxis x{.label = "x", .minimum = 0, .maximum = 1};
  const ChartAxis n{.label = "scatterings", .minimum = 0, .maximum = double(kLabScatterings)};
  figures.push_back({"scatterings-largest",
                     largest_chart(findings.scatterings, "Largest weight after each scattering", n),
                     "Paths are scattered straight on through copies of the setting, end to end. "
                     "Probabilities that do not look at the path's history let weights grow."});
  figures.push_back({"ray-largest",
                     largest_chart(findings.along_ray, "Largest weight along the ray", x),
                     "Of the paths that have met nothing but null collisions so far."});
  for (const LabThroughput& throughput : findings.scatterings) {
    figures.push_back(
        {"scatterings-" + lab_slug(throughput.tracker),
         evolution_chart(throughput, "After each scattering: ", n),
         "Weights after each scattering: their mean, in bands from 5 to 95 % of the paths. Where "
         "the mean lies above the band, few paths carry it all."});
  }
  for (const LabThroughput& throughput : findings.along_ray) {
    figures.push_back(
        {"ray-" + lab_slug(throughput.tracker), evolution_chart(throughput, "Along the ray: ", x),
         "Weights of the paths that still fly at x: their mean, in bands from 5 to 95 %. Times "
         "the share of these paths, the mean is the transmittance."});
  }
  return figures;
}

std::vector<LabFigure> sweep_figures(const LabFindings& findings) {
  std::vector<LabFigure> figures;
  for (const SweepView& view : kViews) {
    LabFigure figure{view.name,
                     {.title = view.title,
                      .x = {.label = view.option, .logarithmic = view.logarithmic_x},
                      .y = {.label = view.label, .logarithmic = view.logarithmic_y},
                      .series = {}},
                     view.caption};
    for (const LabSweep& sweep : findings.sweeps) {
      if (sweep.option != view.option) continue;
      ChartSeries series{
          .name = lab_label(sweep.tracker), .x = {}, .y = {}, .mark = ChartMark::kBoth};
      for (const LabSweepPoint& point : sweep.points) {
        series.x.push_back(point.value);
        series.y.push_back(view.value(point));
      }
      figure.chart.series.push_back(std::move(series));
    }
    if (!figure.chart.series.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace freepath
