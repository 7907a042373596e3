#pragma once
/// @file The laboratory's findings as charts.

#include <string>
#include <vector>

#include "freepath/report/chart.h"
#include "freepath/study/lab.h"

namespace freepath {

inline constexpr const char* kLabChannelNames[] = {"R", "G", "B"};
/// Channels are drawn in this order, so that the first colours of a chart, which are a blue, a red
/// and a green, are theirs.
inline constexpr int kLabDrawingOrder[] = {2, 0, 1};

struct LabFigure {
  std::string name;  ///< Name of its file, without ".svg".
  Chart chart;
  std::string caption;
};

/// What a reader calls a tracker: "spectral, max" for "spectral:collision-probability=max".
std::string lab_label(const std::string& tracker);

/// Small letters, digits and hyphens alone.
std::string lab_slug(const std::string& text);

/// The extinction along the ray, between the bounds of the super-voxels.
LabFigure extinction_figure(const LabFindings& findings);

/// Where flights end, as they are sampled and times their weights, against the exact curves. Where
/// channels differ, a figure for each tracker; else each shows several trackers.
std::vector<LabFigure> free_path_figures(const LabFindings& findings);

/// How far the scattered weight, summed from the ray's beginning, is from what is exact.
std::vector<LabFigure> deviation_figures(const LabFindings& findings);

/// How often flights end with a weight.
std::vector<LabFigure> weight_figures(const LabFindings& findings);

/// How the weights of paths evolve along the ray, and from scattering to scattering.
std::vector<LabFigure> throughput_figures(const LabFindings& findings);

/// What options cost.
std::vector<LabFigure> sweep_figures(const LabFindings& findings);

}  // namespace freepath
