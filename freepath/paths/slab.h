#pragma once
/// @file Plane-parallel layers: fluxes through a medium that changes with depth alone.
///
/// The classical problem of radiative transfer, with published answers [vandeHulst80] to check the
/// whole chain against: medium, super-voxels, tracker, phase function, roulette.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/media/phase/phase_function.h"
#include "freepath/paths/flux.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// A layer without lateral bounds or change.
struct SlabLayer {
  double tau = 1;     ///< Optical thickness, > 0; infinite (a half-space) in the last layer alone.
  double albedo = 1;  ///< sigma_s / sigma_t.
  double g = 0;       ///< Mean cosine of the Henyey-Greenstein phase function, |g| < 1.
  /// Phase function in place of Henyey-Greenstein's; layers of one component share it.
  std::shared_ptr<const PhaseFunction> phase = nullptr;
};

struct SlabSettings {
  double mu0 = 1;        ///< Cosine of incidence, in (0, 1].
  bool diffuse = false;  ///< Instead of mu0: the same radiance from all directions above.
  uint64_t paths = 1'000'000;
  int threads = 0;          ///< 0: as many as the machine has.
  int super_voxel = 0;      ///< Edge of a super-voxel [voxels], 0 for automatic.
  float bound_scale = 1;    ///< Looseness of bounds, see Medium::with_scaled_bounds(); at least 1.
  std::size_t batch = 512;  ///< Paths in flight per thread; the result does not depend on it.
  /// Russian roulette is played where the weight's magnitude is below this.
  float roulette_threshold = 0.25F;
  /// Tracker, absorption, seed, instructions. The interpolation is always nearest: layers are
  /// sharp.
  WalkSettings walk;
};

/// Fluxes, as fractions of the flux that comes in. Light comes in through the top of the first
/// layer.
struct SlabResult {
  Estimate reflectance;    ///< What leaves through the top.
  Estimate transmittance;  ///< What leaves through the bottom, scattered or not.
  Estimate unscattered;    ///< The part of the transmittance that never scattered.
  Estimate total;          ///< What leaves at all: 1 - absorptance.
  /// Largest magnitude of a weight that left. Far above 1 (a tracker whose rate is no bound), the
  /// variance may be infinite and the errors say little.
  double largest_weight = 0;
  uint64_t paths = 0;          ///< Fewer than asked for where interrupted.
  std::string tracker_reason;  ///< Why `auto` has chosen it; empty where it was given.
  std::string tracker;  ///< Tracker as it was understood, options that are not standard included.
};

/// Layers as a medium: densities are columns of voxels along z, and x and y are collapsed, so that
/// wherever a ray is, it sees the same column. World space: the top is z = 0 and z grows downwards;
/// the unit is the mean free path in the layer of largest tau, whose density is 1.
struct SlabMedium {
  Medium medium;
  double thickness = 0;     ///< [world]
  bool half_space = false;  ///< Whether what arrives at the bottom is to be forgotten.
  /// Depths [world], from the top down, at which paths split on their way down, so that their
  /// number stays about the same where light decays by many powers of ten; empty where it does not.
  std::vector<float> splits;
};

/// @param super_voxel as in SlabSettings
/// @param mu0 cosine of incidence, for the depths at which paths split
/// @throws Error for a value out of range, layers of more than Medium::kMaxComponents kinds (of
///   albedo and phase function), and a half-space that absorbs too little for paths in it to end
SlabMedium make_slab_medium(std::span<const SlabLayer> layers, int super_voxel = 0, double mu0 = 1);

/// Traces paths through layers until each has left or was absorbed. Unbiased if the tracker is. The
/// result depends on layers, seed, tracker, absorption, instructions and the number of paths alone,
/// never on threads or batch.
/// @throws Error as make_slab_medium, for settings out of range, methods that do not exist, and
///   trackers whose weights may have an infinite variance in these layers
SlabResult trace_slab(std::span<const SlabLayer> layers, const SlabSettings& settings,
                      const FluxProgress& progress = {});

}  // namespace freepath
