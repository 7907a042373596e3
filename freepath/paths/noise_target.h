#pragma once
/// @file How many samples a noise takes.

#include <cstdint>

#include "freepath/paths/renderer.h"

namespace freepath {

/// The noise of a picture: the root mean square, over all pixels and R, G and B, of the standard
/// error of the mean, as a part of the mean of all of them. Infinite where a variance is; 0 of a
/// black picture.
double relative_noise(const Film& film);

/// The settings of a pilot of a picture: another seed, and nothing recorded but the colour. It has
/// no time limit, and no samples yet.
RenderSettings pilot_settings(const RenderSettings& settings);

/// What a pilot has found.
struct NoisePlan {
  uint32_t samples = 0;        ///< Samples of each pixel that the noise takes.
  uint32_t pilot_samples = 0;  ///< Samples of each pixel that the pilot took.
  double pilot_noise = 0;      ///< Noise of the pilot's picture.
  bool is_known = false;       ///< Whether the pilot had samples enough to tell.
  bool interrupted = false;
};

/// Samples of the first pilot; the others have twice as many as the one before, and go on with it.
inline constexpr uint32_t kFirstPilot = 4;
/// Seed of the pilots of a picture.
uint64_t pilot_seed(uint64_t seed);

/// What a pilot tells: plan_noise() step by step, for who renders pilots elsewhere.
/// @param pilot of pilot_seed(), with the same samples of each pixel, kFirstPilot · 2^n
/// @param noise to reach, as relative_noise()
/// @param most samples that are planned; 0: no limit
/// @throws Error where its variance is infinite
NoisePlan plan_of_pilot(const Film& pilot, double noise, uint32_t most);

/// The number of samples that a picture takes to have a noise, by a pilot: a picture of the same
/// scene by another seed, of 4, 8, 16, ... samples, until it has a 16th of the samples that are
/// needed by its own variance. The picture's samples have no part in the decision, so that its mean
/// stays without bias, which a rule that looks at what it decides about spoils [Glynn92].
///
/// The result depends on the scene, the seed and the noise alone. A margin covers what the pilot
/// doesn't know: of pictures with as many samples, 19 in 20 have at most 1.05 times the noise where
/// no single path brings a noticeable part of the light.
/// @param settings of the picture; its samples are the most that are planned, 0: no limit
/// @param noise to reach, as relative_noise()
/// @throws Error where the pilot's variance is infinite, and as render_scene
NoisePlan plan_noise(const PathScene& scene, ColorMode mode, const RenderSettings& settings,
                     double noise, const ProgressFunction& progress = {});

}  // namespace freepath
