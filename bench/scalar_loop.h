#pragma once
/// @file The loop of the scalar walks, and the medium that it reads. A tracker is a small policy:
///
///   Path             weights along the ray, and what else the method carries
///   enter(cell)      what it reads of a super-voxel, with the `rate` of tentative collisions
///   pass(local, length, path)            a stretch of the ray
///   collide(local, look, random, path)   a tentative collision; look(k) reads component k
///   finish(path)     the weights of a ray that has left the medium

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "bench/scalar_grid.h"
#include "bench/scalar_trackers.h"

namespace freepath::bench {

/// The densities of a medium as NanoVDB grids, their cross sections and bounds.
struct ScalarMedium {
  explicit ScalarMedium(const Medium& medium)
      : cells(medium), components(medium.components()), handles(components.size()) {
    std::map<const Field*, const nanovdb::FloatGrid*> known;
    for (std::size_t k = 0; k < components.size(); ++k) {
      const Field* field = components[k].density.get();
      if (known.count(field) == 0) {
        handles[k] = to_nanovdb(field->voxels);
        known[field] = handles[k].grid<float>();
      }
      grids.push_back(known[field]);
    }
  }

  CellGrid cells;
  std::vector<Component> components;
  std::vector<NanovdbHandle> handles;              ///< Empty where another component's is shared.
  std::vector<const nanovdb::FloatGrid*> grids{};  ///< Of each component.
};

/// What a tentative collision did to a ray.
enum class Outcome {
  kNull,     ///< It goes on.
  kScatter,  ///< It has scattered.
  kEnd,      ///< Nothing is left of it.
};

/// A weight for each channel.
template <int kN>
struct Weights {
  Weights() { weight.fill(1.0F); }
  std::array<float, kN> weight;
};

/// What most methods leave as it is.
template <int kN>
struct ScalarMethod {
  static constexpr int kChannelCount = kN;
  using Path = Weights<kN>;
  template <class Local>
  void pass(const Local& /*local*/, float /*length*/, Path& /*path*/) const {}
  void finish(Path& /*path*/) const {}
};

/// One ray, from its origin to its end.
template <class Method, Interpolation kInterpolation>
ScalarFlight fly(const Method& method, const CellGrid& cells,
                 const Density<kInterpolation>* densities, const Vec3f& origin,
                 const Vec3f& direction, Pcg random) {
  ScalarFlight flight;
  typename Method::Path path;
  const auto leave = [&](Event event, float t) {
    flight.event = event;
    flight.t = t;
    for (int channel = 0; channel < Method::kChannelCount; ++channel) {
      flight.weight[channel] = event == Event::kAbsorb ? 0.0F : path.weight[channel];
    }
    return flight;
  };
  float t = 0;
  float end = INFINITY;
  if (!clip(cells.bounds, origin, direction, t, end)) return leave(Event::kEscape, end);
  CellSteps steps(cells, origin, direction, t);
  const auto look = [&](int component) {
    ++flight.lookups;
    return densities[component](origin + direction * t, random);
  };
  float tau = random.exponential();
  for (;;) {
    const float exit = std::min(steps.exit(), end);
    const auto local = method.enter(steps.cell());
    float depth = local.rate * (exit - t);
    while (tau < depth) {
      const float length = tau / local.rate;
      t += length;
      ++flight.collisions;
      method.pass(local, length, path);
      const Outcome outcome = method.collide(local, look, random, path);
      if (outcome == Outcome::kScatter) return leave(Event::kScatter, t);
      if (outcome == Outcome::kEnd) return leave(Event::kAbsorb, t);
      tau = random.exponential();
      depth = local.rate * (exit - t);
    }
    method.pass(local, exit - t, path);
    tau -= depth;
    t = exit;
    if (exit >= end || !steps.leave()) {
      method.finish(path);
      return leave(Event::kEscape, t);
    }
  }
}

/// All rays of a stream, one after the other.
template <class Method, Interpolation kInterpolation>
void fly_all(const ScalarMedium& medium, const RayStream& rays,
             std::vector<ScalarFlight>& flights) {
  const Method method(medium);
  std::vector<Density<kInterpolation>> densities;
  densities.reserve(medium.grids.size());  // a sampler refers to the accessor beside it
  for (const nanovdb::FloatGrid* grid : medium.grids) densities.emplace_back(*grid);
  flights.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Pcg random(uint64_t{rays.pixel[i]} << 32 | rays.sample[i]);
    flights[i] =
        fly(method, medium.cells, densities.data(),
            Vec3f(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]),
            Vec3f(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]), random);
  }
}

}  // namespace freepath::bench
