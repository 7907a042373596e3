#include "bench/nanovdb_walk.h"

#include <algorithm>
#include <cmath>

#include "bench/scalar_grid.h"

namespace freepath::bench {

struct NanovdbWalk::Data {
  NanovdbHandle handle;
  CellGrid cells;
  float sigma_t;  ///< [1/m per density]
};

namespace {

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
  if (!clip(data.cells.bounds, origin, direction, t, end)) return tally.add_ray(0, 1);
  const std::vector<float>& maxima = data.cells.cells->maxima;
  CellSteps steps(data.cells, origin, direction, t);
  int collisions = 0;
  float weight = 1;
  float tau = random.exponential();
  for (;;) {
    const float exit = std::min(steps.exit(), end);
    const float rate = data.sigma_t * maxima[steps.cell()];
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
    if (exit >= end || !steps.leave()) return tally.add_ray(collisions, weight);
  }
}

template <Estimate kEstimate, Interpolation kInterpolation>
Tally fly_all(const NanovdbWalk::Data& data, const RayStream& rays) {
  const Density<kInterpolation> density(*data.handle.grid<float>());
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

NanovdbWalk::NanovdbWalk(const Medium& medium) {
  const Component& component = medium.components()[0];
  data_ = std::make_unique<Data>(Data{.handle = to_nanovdb(component.density->voxels),
                                      .cells = CellGrid(medium),
                                      .sigma_t = component.sigma_t()[0]});
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
