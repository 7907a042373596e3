#pragma once
/// @file Volumes made by a program: for demos, tests and benchmarks without a file.

#include <cstdint>
#include <functional>
#include <vector>

#include "freepath/media/field.h"

namespace freepath {

struct ProceduralOptions {
  int resolution = 256;  ///< Voxels along the longest side, 16 to 2048.
  uint64_t seed = 0;     ///< Another seed, another volume of the same kind.
  /// Called with the finished fraction now and then, by one thread at a time.
  std::function<void(double)> progress;
};

// Each stands on the plane y = 0 (up is +y), centred on the y axis; its longest side is 100 units
// of the world. Densities are 0 to 1. The result depends on resolution and seed alone; finer voxels
// show more detail of the same shape. All throw Error for a resolution out of range.

/// A cumulus: flat base, billows upon billows, sharp edges. Field "density".
std::vector<Field> generate_cloud(const ProceduralOptions& options);

/// A column of smoke that rises, widens and curls. Field "density".
std::vector<Field> generate_smoke(const ProceduralOptions& options);

/// A bank of fog: dense everywhere, 0.55 to 1, in slow waves. Field "density".
std::vector<Field> generate_fog(const ProceduralOptions& options);

/// A ball of voxels that have nothing to do with each other, uniform from 0 to 1: the highest
/// frequency that a grid holds. Field "density".
std::vector<Field> generate_noise(const ProceduralOptions& options);

/// Two round puffs, far apart: the same function of place at any resolution, most of it 0. Field
/// "density".
std::vector<Field> generate_puffs(const ProceduralOptions& options);

/// An explosion: hot where it is deep, sooty outside. Fields "density" and "temperature" (kelvin,
/// 300 to 3000 wherever there is density).
std::vector<Field> generate_fireball(const ProceduralOptions& options);

}  // namespace freepath
