#pragma once
/// @file Fluxes through a medium that light falls on from above: what is reflected, transmitted and
/// absorbed, and the radiance that leaves, by the same paths as the renderer's.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "freepath/base/moments.h"
#include "freepath/paths/flux_meter.h"
#include "freepath/paths/path_scene.h"
#include "freepath/transport/walker.h"

namespace freepath {

struct FluxSettings {
  uint64_t paths = 1'000'000;
  int threads = 0;          ///< 0: as many as the machine has.
  std::size_t batch = 512;  ///< Paths in flight per thread; the result does not depend on it.
  /// Russian roulette is played where the weight's magnitude is below this.
  float roulette_threshold = 0.25F;
  /// Whether what is absorbed is wanted: media with a component that absorbs without scattering
  /// are then walked with analog absorption.
  bool tells_absorption = true;
  /// Traces although the weights of paths are not bounded (WeightGrowth): for who knows by other
  /// means that their variance is finite.
  bool studies_unbounded_weights = false;
  /// Tracker, transmittance towards views, absorption, interpolation, seed, instructions; its
  /// origin is that of the scene.
  WalkSettings walk;
};

/// Columns that a meter may have: their sums take 100 bytes and more each.
inline constexpr uint64_t kMostColumns = uint64_t{1} << 22;

/// One quantity, as a fraction of what falls on the domain, and of what falls on each column.
struct FluxMap {
  Estimate all;
  /// Estimates of the columns, along the first of the level axes first; empty where there is one.
  std::vector<Estimate> columns;
};

struct FluxResult {
  FluxMap reflectance;
  FluxMap transmittance;  ///< Part that arrives at the bottom, scattered or not.
  FluxMap unscattered;    ///< The part of the transmittance that never scattered.
  /// Part that stays in the medium; a ground below it keeps more.
  FluxMap absorptance;
  /// Radiances towards each view, as π I / F: the radiance I by that of a white diffuse surface
  /// under the flux F that falls on the top. Light that never scattered is no part of it.
  std::vector<FluxMap> radiances;
  Estimate leaving;  ///< Reflectance and transmittance together.
  /// Largest magnitude of a weight that left. Far above 1 (a tracker whose rate is no bound), the
  /// variance may be infinite and the errors say little.
  double largest_weight = 0;
  uint64_t paths = 0;  ///< Fewer than asked for where interrupted.
};

/// Called with the paths done and in all, by one thread at a time; false ends the tracing soon.
using FluxProgress = std::function<bool(uint64_t done, uint64_t total)>;

/// Traces paths of light until each has left or was absorbed. Unbiased if the tracker is. The
/// result depends on scene, meter, seed, methods and the number of paths alone, never on threads or
/// batch.
/// @param scene one medium that is the same in all channels, perhaps a ground; lights have no part
///   in it
/// @param meter in place of whose absorbed_of_scattered those of the medium are taken
/// @throws Error for settings out of range, methods that do not exist or whose weights would grow
///   at every scattering (weight_growth.h), coefficients that differ between channels, a medium
///   that emits, more than kMostColumns, and if weights leave the range of float
FluxResult trace_flux(const PathScene& scene, FluxMeter meter, const FluxSettings& settings,
                      const FluxProgress& progress = {});

}  // namespace freepath
