#include "bench/nanovdb_walk.h"

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/SampleFromVoxels.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

#include "freepath/base/random.h"

namespace freepath::bench {
namespace {

/// PCG-XSH-RR 64/32, the generator of most renderers.
class Pcg {
 public:
  explicit Pcg(uint64_t sequence) : increment_(sequence << 1 | 1) {
    bits();
    state_ += 0x853C49E6748FEA9BULL;
    bits();
  }
  uint32_t bits() {
    const uint64_t old = state_;
    state_ = old * 0x5851F42D4C957F2DULL + increment_;
    const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<uint32_t>(old >> 59);
    return shifted >> turn | shifted << (-turn & 31);
  }
  float uniform() { return uniform_from_bits(bits()); }
  float exponential() { return -std::log(open_uniform_from_bits(bits())); }

 private:
  uint64_t state_ = 0;
  uint64_t increment_;
};

openvdb::FloatGrid::Ptr to_openvdb(const BrickMap& map) {
  auto grid = openvdb::FloatGrid::create(0.0F);
  const Vec3i& counts = map.brick_counts();
  for (int x = 0; x < counts.x; ++x) {
    for (int y = 0; y < counts.y; ++y) {
      for (int z = 0; z < counts.z; ++z) {
        const uint32_t brick = map.index()[(std::size_t(x) * counts.y + y) * counts.z + z];
        if (brick == 0) continue;
        const Vec3i first = map.origin() + Vec3i(x, y, z) * BrickMap::kBrickSize;
        auto* leaf = new openvdb::FloatTree::LeafNodeType(openvdb::Coord(first.x, first.y, first.z),
                                                          0.0F, true);
        const auto voxels = map.voxels().subspan(std::size_t(brick) * BrickMap::kBrickVoxels,
                                                 BrickMap::kBrickVoxels);
        std::copy(voxels.begin(), voxels.end(), leaf->buffer().data());
        grid->tree().addLeaf(leaf);  // which takes it over
      }
    }
  }
  return grid;
}

/// The place of a ray among the cells, one coordinate an axis.
struct Cells {
  int cell[3];
  int step[3];
  int end[3];       ///< First cell outside.
  float next[3];    ///< Where the ray crosses the next plane [world].
  float across[3];  ///< Length between two planes [world].
};

}  // namespace

struct NanovdbWalk::Data {
  nanovdb::GridHandle<nanovdb::HostBuffer> handle;
  const SuperVoxels* cells;
  Vec3f first_corner;  ///< Of the cells [world]; the edge of a voxel is 1.
  Box3f bounds;        ///< Where the walk takes place [world].
  float sigma_t;       ///< [1/m per density]

  const nanovdb::FloatGrid& grid() const { return *handle.grid<float>(); }
};

namespace {

/// @return whether the ray meets the box between `begin` and `end`, which are narrowed to it
bool clip(const Box3f& box, const Vec3f& origin, const Vec3f& direction, float& begin, float& end) {
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / direction[axis];
    const float low = (box.min[axis] - origin[axis]) * inverse;
    const float high = (box.max[axis] - origin[axis]) * inverse;
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return begin < end;
}

/// [Amanatides87]: the cell at `begin`, and where its planes are crossed.
Cells enter(const SuperVoxels& cells, const Vec3f& first_corner, const Vec3f& origin,
            const Vec3f& direction, float begin) {
  Cells c;
  const auto edge = static_cast<float>(cells.cell_size);
  for (int axis = 0; axis < 3; ++axis) {
    const float place = (origin[axis] + begin * direction[axis] - first_corner[axis]) / edge;
    c.cell[axis] = std::clamp(static_cast<int>(place), 0, cells.counts[axis] - 1);
    const bool forward = direction[axis] >= 0;
    c.step[axis] = forward ? 1 : -1;
    c.end[axis] = forward ? cells.counts[axis] : -1;
    const float plane =
        first_corner[axis] + edge * static_cast<float>(c.cell[axis] + (forward ? 1 : 0));
    c.next[axis] = (plane - origin[axis]) / direction[axis];
    c.across[axis] = edge / std::abs(direction[axis]);
  }
  return c;
}

/// Density at a point [index], by a trilinear interpolation or one voxel drawn with its weight.
template <Interpolation kInterpolation>
class Density {
 public:
  explicit Density(const nanovdb::FloatGrid& grid) : accessor_(grid.tree()), sampler_(accessor_) {}

  float operator()(const Vec3f& point, Pcg& random) const {
    if constexpr (kInterpolation == Interpolation::kTrilinear) {
      return sampler_(nanovdb::Vec3f(point.x, point.y, point.z));
    } else {
      nanovdb::Coord voxel;
      for (int axis = 0; axis < 3; ++axis) {
        const float base = std::floor(point[axis]);
        voxel[axis] = static_cast<int>(base) + (random.uniform() < point[axis] - base ? 1 : 0);
      }
      return accessor_.getValue(voxel);
    }
  }

 private:
  using Accessor = nanovdb::DefaultReadAccessor<float>;
  Accessor accessor_;
  nanovdb::SampleFromVoxels<Accessor, 1, false> sampler_;
};

/// A collision of ratio tracking. @return whether the ray goes on
bool weigh(float ratio, Pcg& random, float& weight) {
  constexpr float kRoulette = 0.1F;
  weight *= ratio;
  if (weight >= kRoulette) return true;
  if (random.uniform() * kRoulette >= weight) {
    weight = 0;
    return false;
  }
  weight = kRoulette;
  return true;
}

template <Estimate kEstimate, Interpolation kInterpolation>
void fly(const NanovdbWalk::Data& data, const Density<kInterpolation>& density, const Vec3f& origin,
         const Vec3f& direction, Pcg& random, Tally& tally) {
  float t = 0;
  float end = INFINITY;
  if (!clip(data.bounds, origin, direction, t, end)) return tally.add_ray(0, 1);
  const SuperVoxels& cells = *data.cells;
  Cells c = enter(cells, data.first_corner, origin, direction, t);
  int collisions = 0;
  float weight = 1;
  float tau = random.exponential();
  for (;;) {
    const int axis =
        c.next[0] < c.next[1] ? (c.next[0] < c.next[2] ? 0 : 2) : (c.next[1] < c.next[2] ? 1 : 2);
    const float exit = std::min(c.next[axis], end);
    const float rate =
        data.sigma_t *
        cells.maxima[(c.cell[0] * cells.counts.y + c.cell[1]) * cells.counts.z + c.cell[2]];
    float depth = rate * (exit - t);
    while (tau < depth) {
      t += tau / rate;
      ++collisions;
      const float sigma_t = data.sigma_t * density(origin + direction * t, random);
      if constexpr (kEstimate == Estimate::kFreePath) {
        if (random.uniform() * rate < sigma_t) return tally.add_ray(collisions, 0);
      } else {
        if (!weigh((rate - sigma_t) / rate, random, weight)) return tally.add_ray(collisions, 0);
      }
      tau = random.exponential();
      depth = rate * (exit - t);
    }
    tau -= depth;
    t = exit;
    c.cell[axis] += c.step[axis];
    if (exit >= end || c.cell[axis] == c.end[axis]) return tally.add_ray(collisions, weight);
    c.next[axis] += c.across[axis];
  }
}

template <Estimate kEstimate, Interpolation kInterpolation>
Tally fly_all(const NanovdbWalk::Data& data, const RayStream& rays) {
  const Density<kInterpolation> density(data.grid());
  Tally tally;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Pcg random(uint64_t{rays.pixel[i]} << 32 | rays.sample[i]);
    fly<kEstimate>(data, density, Vec3f(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]),
                   Vec3f(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]), random,
                   tally);
  }
  return tally;
}

}  // namespace

NanovdbWalk::NanovdbWalk(const Medium& medium) : data_(std::make_unique<Data>()) {
  const Component& component = medium.components()[0];
  const BrickMap& map = component.density->voxels;
  data_->handle = nanovdb::openToNanoVDB(*to_openvdb(map), nanovdb::StatsMode::Disable,
                                         nanovdb::ChecksumMode::Disable);
  data_->cells = &medium.super_voxels();
  data_->first_corner = Vec3f(map.origin()) - Vec3f(0.5F);
  data_->bounds = Box3f(Vec3f(map.active_min()) - Vec3f(1), Vec3f(map.active_max()) + Vec3f(1));
  data_->sigma_t = component.sigma_t()[0];
}

NanovdbWalk::~NanovdbWalk() = default;
NanovdbWalk::NanovdbWalk(NanovdbWalk&&) noexcept = default;

Tally NanovdbWalk::run(Estimate estimate, Interpolation interpolation,
                       const RayStream& rays) const {
  const bool trilinear = interpolation == Interpolation::kTrilinear;
  if (estimate == Estimate::kFreePath) {
    return trilinear ? fly_all<Estimate::kFreePath, Interpolation::kTrilinear>(*data_, rays)
                     : fly_all<Estimate::kFreePath, Interpolation::kStochastic>(*data_, rays);
  }
  return trilinear ? fly_all<Estimate::kTransmittance, Interpolation::kTrilinear>(*data_, rays)
                   : fly_all<Estimate::kTransmittance, Interpolation::kStochastic>(*data_, rays);
}

}  // namespace freepath::bench
