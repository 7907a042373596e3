#pragma once
/// @file What VTK's two formats of images share: where their samples lie.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "freepath/io/volume_dense.h"

namespace freepath::io {

/// A regular grid of nodes, with cells between them.
struct VtkImage {
  std::array<int, 3> first{0, 0, 0};  ///< Index of the first node along each axis.
  Vec3i nodes{1};                     ///< Nodes along each axis.
  Vec3d origin{0}, spacing{1};        ///< Position of node 0, and steps to the next.
  /// Columns are the directions of the axes, as VTK writes it row by row.
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// The samples of point data lie at the nodes, those of cell data in the middle between them.
enum class VtkSamples { kPoints, kCells };

/// Samples along each axis. Of an axis with one node there is one layer of cells.
Vec3i vtk_counts(const VtkImage& image, VtkSamples samples);

/// Transform of indices from 0 that gives the positions of samples.
Matrix4d vtk_transform(const VtkImage& image, VtkSamples samples);

/// A grid for an array of the image, still without values.
DenseGrid vtk_grid(const VtkImage& image, VtkSamples samples, std::string name);

/// The type of a name in VTK's XML ("Float32") or in its old format ("float"); nothing if numbers
/// can't be of it.
std::optional<NumberType> vtk_number_type(std::string_view name);

}  // namespace freepath::io
