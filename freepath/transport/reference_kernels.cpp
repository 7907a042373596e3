#include "freepath/transport/reference_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "freepath/base/error.h"
#include "freepath/tracking/reference/closed_form.h"
#include "freepath/tracking/reference/p_series.h"
#include "freepath/tracking/reference/ray_marching.h"
#include "freepath/tracking/reference/regular.h"
#include "freepath/tracking/reference/unbiased_ray_marching.h"
#include "freepath/transport/ray_medium.h"

namespace freepath {
namespace {

static_assert(ReferenceMedium<RayMedium>);

template <int kN>
void count(const ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
  if (flight.event != Event::kEscape) {
    ++statistics.tentative_collisions;
    ++statistics.real_collisions;
  }
  for (const double weight : flight.weight) {
    statistics.largest_weight =
        std::max(statistics.largest_weight, static_cast<float>(std::abs(weight)));
    if (weight < 0) ++statistics.negative_weights;
  }
}

template <int kN>
void write(const ReferenceFlight<kN>& flight, std::size_t i, FlightStream& flights) {
  flights.event[i] = flight.event;
  flights.component[i] = flight.component;
  for (int channel = 0; channel < kN; ++channel) {
    flights.weight[channel][i] = static_cast<float>(flight.weight[channel]);
    flights.emitted[channel][i] = static_cast<float>(flight.emitted[channel]);
  }
}

template <int kN, class Method>
void fly_stream(const MediumView& view, std::span<const float> options, const WalkModes& modes,
                uint64_t seed, const RayStream& rays, FlightStream& flights,
                WalkStatistics& statistics) {
  const RayMedium medium(view, kN);
  Method method(options);
  statistics.rays += rays.size();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayMedium::Path path = medium.enter(
        Vec3d(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]),
        Vec3d(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]), rays.t_max[i]);
    ReferenceFlight<kN> flight;
    for (int channel = 0; channel < kN; ++channel) {
      flight.weight[channel] = rays.weighted() ? rays.weight[view.source(channel)][i] : 1.0F;
    }
    const uint64_t before = statistics.lookups;
    if (path.length > 0) {
      flight.t = path.length;
      RandomStream random(seed, rays.pixel[i], rays.sample[i], rays.stream[i]);
      method.template fly<kN>(medium, path, modes, random, flight, statistics);
      count(flight, statistics);
      flights.t[i] = static_cast<float>(path.begin + flight.t);
    } else {  // a ray that misses has flown to its end
      flights.t[i] = std::isnan(rays.t_max[i]) ? 0.0F : rays.t_max[i];
    }
    flights.lookups[i] = static_cast<uint32_t>(statistics.lookups - before);
    write(flight, i, flights);
  }
}

template <class Method>
Kernel kernel(void (*check)(const Medium&, Interpolation) = nullptr) {
  static_assert(has_room_for(Method::kInfo), "raise kMaxMethodOptions");
  return {Method::kInfo,
          walk_table([]<int kN>() -> WalkFunction { return &fly_stream<kN, Method>; }), check,
          /*uniform_emission=*/true};
}

/// Fails where densities are computed: reference methods go from voxel to voxel.
template <class Method>
void check_voxels(const Medium& medium, Interpolation /*interpolation*/) {
  const Field& field = *medium.components()[0].density;
  if (!field.function) return;
  fail("'{}' reads voxels, but the density '{}' is computed: take a null-collision method",
       Method::kInfo.name, field.name);
}

/// Fails unless the density of component k is the same in all voxels from `low` to `high`.
void check_constant(const Medium& medium, int k, const Vec3i& low, const Vec3i& high) {
  const Field& field = *medium.components()[k].density;
  const float expected = field.voxels.value(low);
  for (int x = low.x; x <= high.x; ++x) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int z = low.z; z <= high.z; ++z) {
        const float value = field.voxels.value(Vec3i(x, y, z));
        if (value == expected) continue;
        fail(
            "'closed-form' needs a homogeneous medium: the density of grid '{}' is {} at voxel "
            "({}, {}, {}) but {} at ({}, {}, {}); take 'regular', or a null-collision method",
            field.name, expected, low.x, low.y, low.z, value, x, y, z);
      }
    }
  }
}

/// Fails unless the bounds of component k, which are read in place of its voxels, are tight.
void check_tight(const Medium& medium, int k, float density) {
  for (const WalkPart& part : medium.parts()) {
    const SuperVoxels& cells = part.cells;
    for (std::size_t i = k; i < cells.maxima.size(); i += cells.components) {
      if (cells.maxima[i] == 0 || cells.maxima[i] == density) continue;
      fail("'closed-form' takes the density from its bounds, but grid '{}' is {} and its bound {}",
           medium.components()[k].density->name, density, cells.maxima[i]);
    }
  }
}

/// Homogeneous within its bounds, and not softened there.
void check_closed_form(const Medium& medium, Interpolation interpolation) {
  check_voxels<ClosedForm>(medium, interpolation);
  if (!medium.aligned()) {
    fail(
        "'closed-form' needs a homogeneous medium: grid '{}' and another differ in transform or "
        "bounds; take 'regular', or a null-collision method",
        medium.components()[0].density->name);
  }
  if (!medium.part_tree().leaves().empty()) {
    fail(
        "'closed-form' needs a homogeneous medium: the voxels of grid '{}' lie far apart; take "
        "'regular', or a null-collision method",
        medium.components()[0].density->name);
  }
  Vec3i low = medium.components()[0].density->voxels.active_min();
  Vec3i high = medium.components()[0].density->voxels.active_max();
  for (const Component& component : medium.components()) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], component.density->voxels.active_min()[axis]);
      high[axis] = std::max(high[axis], component.density->voxels.active_max()[axis]);
    }
  }
  for (int k = 0; k < static_cast<int>(medium.components().size()); ++k) {
    if (largest(medium.components()[k].sigma_t()) == 0) continue;
    check_constant(medium, k, low, high);
    check_tight(medium, k, medium.components()[k].density->voxels.value(low));
  }
  if (interpolation != Interpolation::kNearest) {
    fail(
        "'closed-form' needs interpolation 'nearest': others let the density of grid '{}' fall to "
        "0 over the outermost voxels, so that it is no longer the same everywhere",
        medium.components()[0].density->name);
  }
}

template <class Method>
void check_interpolation(const Medium& medium, Interpolation interpolation) {
  check_voxels<Method>(medium, interpolation);
  if (interpolation != Interpolation::kStochastic) return;
  fail(
      "'{}' puts the density inside an exponential, where a voxel drawn at random is no stand-in "
      "for the interpolated density: take interpolation 'trilinear' or 'nearest'",
      Method::kInfo.name);
}

}  // namespace

KernelTable make_reference_kernels() {
  KernelTable table;
  table.trackers = {kernel<ClosedForm>(check_closed_form),
                    kernel<Regular>(check_interpolation<Regular>),
                    kernel<RayMarching>(check_interpolation<RayMarching>)};
  table.transmittance = {
      kernel<ClosedFormTransmittance>(check_closed_form),
      kernel<RegularTransmittance>(check_interpolation<RegularTransmittance>),
      kernel<PSeries>(check_voxels<PSeries>),
      kernel<UnbiasedRayMarching>(check_voxels<UnbiasedRayMarching>),
  };
  return table;
}

}  // namespace freepath
