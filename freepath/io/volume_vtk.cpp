#include "freepath/io/volume_vtk.h"

#include <algorithm>
#include <utility>

namespace freepath::io {

Vec3i vtk_counts(const VtkImage& image, VtkSamples samples) {
  if (samples == VtkSamples::kPoints) return image.nodes;
  Vec3i counts;
  for (int axis = 0; axis < 3; ++axis) counts[axis] = std::max(1, image.nodes[axis] - 1);
  return counts;
}

Matrix4d vtk_transform(const VtkImage& image, VtkSamples samples) {
  Matrix4d matrix;
  Vec3d position = image.origin;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int i = static_cast<int>(axis);
    const Vec3d edge =
        Vec3d(image.direction[axis], image.direction[3 + axis], image.direction[6 + axis]) *
        image.spacing[i];
    const bool between = samples == VtkSamples::kCells && image.nodes[i] > 1;
    position += edge * (image.first[axis] + (between ? 0.5 : 0));
    for (int k = 0; k < 3; ++k) matrix[i][k] = edge[k];
  }
  for (int k = 0; k < 3; ++k) matrix[3][k] = position[k];
  return matrix;
}

DenseGrid vtk_grid(const VtkImage& image, VtkSamples samples, std::string name) {
  DenseGrid grid;
  grid.info.name = std::move(name);
  grid.info.grid_class = samples == VtkSamples::kPoints ? "samples at nodes" : "samples in cells";
  grid.info.index_to_world = vtk_transform(image, samples);
  grid.counts = vtk_counts(image, samples);
  return grid;
}

std::optional<NumberType> vtk_number_type(std::string_view name) {
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"Float32", NumberType::kFloat},
      {"Float64", NumberType::kDouble},
      {"Int8", NumberType::kInt8},
      {"UInt8", NumberType::kUint8},
      {"Int16", NumberType::kInt16},
      {"UInt16", NumberType::kUint16},
      {"Int32", NumberType::kInt32},
      {"UInt32", NumberType::kUint32},
      {"Int64", NumberType::kInt64},
      {"UInt64", NumberType::kUint64},
      {"float", NumberType::kFloat},
      {"double", NumberType::kDouble},
      {"char", NumberType::kInt8},
      {"signed_char", NumberType::kInt8},
      {"unsigned_char", NumberType::kUint8},
      {"short", NumberType::kInt16},
      {"unsigned_short", NumberType::kUint16},
      {"int", NumberType::kInt32},
      {"unsigned_int", NumberType::kUint32},
      {"long", NumberType::kInt64},
      {"unsigned_long", NumberType::kUint64},
      {"vtktypeint64", NumberType::kInt64},
      {"vtktypeuint64", NumberType::kUint64}};
  const auto* const found =
      std::ranges::find(kTypes, name, &std::pair<std::string_view, NumberType>::first);
  if (found == std::end(kTypes)) return std::nullopt;
  return found->second;
}

}  // namespace freepath::io
