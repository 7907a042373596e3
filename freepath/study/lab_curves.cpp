#include "freepath/study/lab_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace freepath {
namespace {

/// Gauss's rule of three nodes on [0,1].
constexpr double kNodes[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
constexpr double kWeights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/// The voxel of the ray in y and z.
constexpr int kRow = kLabCell / 2;

}  // namespace

LabCurves::LabCurves(const LabSetting& setting) : channels_(setting.channels) {
  for (int channel = 0; channel < channels_; ++channel) {
    double depth = 0;
    for (int voxel = 0; voxel < kLabVoxels; ++voxel) {
      Piece piece;
      for (const Component& component : setting.medium->components()) {
        const double density = component.density->voxels.value(Vec3i(voxel, kRow, kRow));
        piece.sigma_a += density * component.sigma_a[channel];
        piece.sigma_s += density * component.sigma_s[channel];
        piece.source += density * component.sigma_a[channel] * component.emission[channel];
      }
      piece.depth = depth;
      depth += piece.sigma_t() / kLabVoxels;
      pieces_[channel].push_back(piece);
    }
    Piece last = pieces_[channel].back();
    last.depth = depth;
    pieces_[channel].push_back(last);
    radiance_[channel] = integrate_radiance(setting, channel);
  }
}

const LabCurves::Piece& LabCurves::piece(double x, int channel) const {
  const auto voxel = static_cast<int>(std::floor(x * kLabVoxels));
  return pieces_[channel][std::clamp(voxel, 0, kLabVoxels)];
}

double LabCurves::depth(double x, int channel) const {
  const double position = std::clamp(x, 0.0, 1.0) * kLabVoxels;
  const Piece& at = piece(std::clamp(x, 0.0, 1.0), channel);
  return at.depth + at.sigma_t() * (position - std::floor(position)) / kLabVoxels;
}

double LabCurves::transmittance(double x, int channel) const {
  return std::exp(-depth(x, channel));
}

double LabCurves::scattered(double begin, double end, int channel) const {
  double sum = 0;
  double from = begin;
  while (from < end) {
    const double face = (std::floor(from * kLabVoxels) + 1) / kLabVoxels;
    const double to = std::min(face, end);
    const Piece& at = piece(from, channel);
    const double lost = -std::expm1(-at.sigma_t() * (to - from));
    if (lost > 0) sum += at.sigma_s / at.sigma_t() * lost * transmittance(from, channel);
    from = to;
  }
  return sum;
}

double LabCurves::integrate_radiance(const LabSetting& setting, int channel) const {
  double sum = setting.background * transmittance(1, channel);
  for (int voxel = 0; voxel < kLabVoxels; ++voxel) {
    const Piece& at = pieces_[channel][voxel];
    for (int node = 0; node < 3; ++node) {
      const double t = kNodes[node] / kLabVoxels;
      const double x = double{1} * voxel / kLabVoxels + t;
      const double source = at.source + at.sigma_s * setting.scattered(x, channel);
      sum += kWeights[node] / kLabVoxels * std::exp(-at.depth - at.sigma_t() * t) * source;
    }
  }
  return sum;
}

std::vector<LabBounds> lab_bounds(const LabSetting& setting) {
  const SuperVoxels& cells = setting.medium->super_voxels();
  const std::vector<Component>& components = setting.medium->components();
  const Vec3i origin = components[0].density->voxels.origin();
  std::vector<LabBounds> result;
  for (int begin = 0; begin < kLabVoxels; begin += cells.cell_size) {
    LabBounds bounds;
    bounds.begin = double{1} * begin / kLabVoxels;
    bounds.end = double{1} * (begin + cells.cell_size) / kLabVoxels;
    const Vec3i at = (Vec3i(begin, kRow, kRow) - origin) / cells.cell_size;
    const std::size_t cell = (std::size_t(at.x) * cells.counts.y + at.y) * cells.counts.z + at.z;
    for (std::size_t k = 0; k < components.size(); ++k) {
      for (int channel = 0; channel < kChannels; ++channel) {
        const double sigma_t = components[k].sigma_t()[channel];
        bounds.majorant[channel] += cells.maxima[cell * components.size() + k] * sigma_t;
        bounds.minorant[channel] += cells.minima[cell * components.size() + k] * sigma_t;
      }
    }
    result.push_back(bounds);
  }
  return result;
}

}  // namespace freepath
