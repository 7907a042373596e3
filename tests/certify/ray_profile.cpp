#include "tests/certify/ray_profile.h"

#include <algorithm>
#include <cmath>

namespace freepath::testing {
namespace {

/// Gauss and Legendre's nodes and weights on [-1, 1], exact to degree 9.
constexpr double kNodes[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                             0.9061798459386640};
constexpr double kWeights[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                               0.4786286704993665, 0.2369268850561891};

/// Largest optical depth of a part that is treated at once.
constexpr double kPartDepth = 0.2;
/// Behind this depth nothing is left in double precision.
constexpr double kOpaque = 80;

/// Where the ray is in a component's index space: place + t · step.
struct IndexRay {
  Vec3d position;
  Vec3d step;
};

IndexRay index_ray(const Field& field, const CertifiedRay& ray) {
  const Matrix4d world_to_index = field.index_to_world.inverse();
  const Vec3d begin = Vec3d(ray.origin) * world_to_index;
  const Vec3d end = (Vec3d(ray.origin) + Vec3d(ray.direction)) * world_to_index;
  return {begin, end - begin};
}

/// Distances at which a ray crosses the seams of a field's interpolant: voxel faces (nearest), or
/// planes through voxel centres.
void add_seams(const Field& field, const CertifiedRay& ray, bool nearest,
               std::vector<double>& seams) {
  const IndexRay path = index_ray(field, ray);
  for (int axis = 0; axis < 3; ++axis) {
    if (path.step[axis] == 0) continue;
    const int first = field.voxels.active_min()[axis] - 2;
    const int last = field.voxels.active_max()[axis] + 2;
    for (int plane = first; plane <= last; ++plane) {
      const double t = (plane + (nearest ? 0.5 : 0.0) - path.position[axis]) / path.step[axis];
      if (t > 0 && t < ray.t_max) seams.push_back(t);
    }
  }
}

double density_at(const Field& field, const Vec3d& point, bool nearest) {
  if (!nearest) return field.voxels.interpolate(point);
  Vec3i voxel;
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = static_cast<int>(std::floor(point[axis] + 0.5));
  }
  return field.voxels.value(voxel);
}

}  // namespace

RayProfile::RayProfile(const Medium& medium, const MediumChannels& channels,
                       const CertifiedRay& ray, Interpolation interpolation)
    : medium_(medium),
      channels_(channels),
      ray_(ray),
      nearest_(interpolation == Interpolation::kNearest) {
  std::vector<double> seams = {0, ray.t_max};
  for (const Component& component : medium.components()) {
    add_seams(*component.density, ray, nearest_, seams);
  }
  std::sort(seams.begin(), seams.end());
  cuts_.push_back({});
  for (std::size_t i = 0; i + 1 < seams.size(); ++i) {
    if (seams[i + 1] - seams[i] <= 1e-12 * ray.t_max) continue;
    pieces_.push_back(make_piece(seams[i], seams[i + 1]));
    pieces_.back().depth = cuts_.back().depth;
    add_cuts(pieces_.size() - 1);
  }
}

RayProfile::Piece RayProfile::make_piece(double begin, double end) const {
  Piece piece{.begin = begin, .end = end, .density = {}, .depth = {}};
  const std::vector<Component>& components = medium_.components();
  for (std::size_t k = 0; k < components.size(); ++k) {
    const Field& field = *components[k].density;
    const IndexRay path = index_ray(field, ray_);
    const auto at = [&](double s) {
      return density_at(field, path.position + path.step * (begin + s * (end - begin)), nearest_);
    };
    Cubic& cubic = piece.density[k];
    if (nearest_) {
      cubic[0] = at(0.5);
      continue;
    }
    // Newton's divided differences at inner points, then in powers of s.
    constexpr double kAt[4] = {0.125, 0.375, 0.625, 0.875};
    double difference[4];
    for (int i = 0; i < 4; ++i) difference[i] = at(kAt[i]);
    for (int order = 1; order < 4; ++order) {
      for (int i = 3; i >= order; --i) {
        difference[i] = (difference[i] - difference[i - 1]) / (kAt[i] - kAt[i - order]);
      }
    }
    for (int i = 3; i >= 0; --i) {
      for (int power = 3; power > 0; --power) {
        cubic[power] = cubic[power - 1] - kAt[i] * cubic[power];
      }
      cubic[0] = difference[i] - kAt[i] * cubic[0];
    }
  }
  return piece;
}

void RayProfile::add_cuts(std::size_t number) {
  const Piece& piece = pieces_[number];
  cuts_.back().piece = number;
  double depth = 0;
  double least = piece.depth[0];
  for (int channel = 0; channel < channels_.count; ++channel) {
    depth = std::max(depth, depth_within(piece, 1, channel));
    least = std::min(least, piece.depth[channel]);
  }
  const bool opaque = least > kOpaque;
  const int parts = opaque ? 1 : 2 + static_cast<int>(std::min(depth / kPartDepth, 2e4));
  for (int part = 1; part <= parts; ++part) {
    const double t = piece.begin + (piece.end - piece.begin) * part / parts;
    cuts_.push_back({t, depth_at(piece, t), number});
  }
}

double RayProfile::depth_within(const Piece& piece, double s, int channel) const {
  double sum = 0;
  for (std::size_t k = 0; k < medium_.components().size(); ++k) {
    const Cubic& cubic = piece.density[k];
    const double integral =
        s * (cubic[0] + s * (cubic[1] / 2 + s * (cubic[2] / 3 + s * cubic[3] / 4)));
    sum += integral * double(channels_.components[k].sigma_a[channel]);
    sum += integral * double(channels_.components[k].sigma_s[channel]);
  }
  return sum * (piece.end - piece.begin);
}

std::array<double, kMaxChannels> RayProfile::depth_at(const Piece& piece, double t) const {
  const double s = (t - piece.begin) / (piece.end - piece.begin);
  std::array<double, kMaxChannels> depth = piece.depth;
  for (int channel = 0; channel < channels_.count; ++channel) {
    depth[channel] += depth_within(piece, s, channel);
  }
  return depth;
}

std::vector<double> RayProfile::equal_bins(int channel, int bins) const {
  const double collided = -std::expm1(-depth(channel));
  std::vector<double> edges = {0};
  double last = 0;  // probability of a collision before the last edge
  for (std::size_t i = 1; i + 1 < cuts_.size(); ++i) {
    const double before = -std::expm1(-cuts_[i].depth[channel]);
    if (before - last < collided / bins) continue;
    edges.push_back(cuts_[i].t);
    last = before;
  }
  edges.push_back(cuts_.back().t);
  return edges;
}

void RayProfile::visit(double begin, double end, const std::function<void(const Node&)>& f) const {
  for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
    if (cuts_[i].t < begin || cuts_[i].t >= end) continue;
    const Piece& piece = pieces_[cuts_[i].piece];
    const double half = 0.5 * (cuts_[i + 1].t - cuts_[i].t);
    for (int node = 0; node < 5; ++node) {
      Node at;
      at.t = cuts_[i].t + half * (1 + kNodes[node]);
      at.width = half * kWeights[node];
      const double s = (at.t - piece.begin) / (piece.end - piece.begin);
      for (std::size_t k = 0; k < medium_.components().size(); ++k) {
        const Cubic& cubic = piece.density[k];
        at.density[k] = cubic[0] + s * (cubic[1] + s * (cubic[2] + s * cubic[3]));
      }
      const std::array<double, kMaxChannels> depth = depth_at(piece, at.t);
      for (int channel = 0; channel < channels_.count; ++channel) {
        at.transmittance[channel] = std::exp(-depth[channel]);
      }
      f(at);
    }
  }
}

}  // namespace freepath::testing
