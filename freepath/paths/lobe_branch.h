#pragma once
/// @file Branches of paths into the lobe around a light that outshines others.

#include <cstdint>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/paths/media_set_table.h"

namespace freepath {

/// A branch of a path, which waits until what was before it has ended. Where light comes from one
/// direction above all, as from a sun, and a medium scatters into a lobe, a scattering is followed
/// in two directions: one drawn by the phase function, as ever, and with some chance another drawn
/// by the phase function as if light from there were scattered, which is about that direction. Of
/// the light in the cone around that direction each brings the share that the balance heuristic
/// gives it [Veach97], which sum up to the phase function: so weights never grow, and a path that
/// happens to fly towards the sun brings little, since branches do so all the time. All other light
/// is the path's alone, which goes on as if it had no branches.
struct LobeBranch {
  Vec3f origin{0};     ///< [world, relative to the scene's origin]
  Vec3f direction{0};  ///< Unit [world].
  SampledSpectrum throughput = {};
  SampledSpectrum density = {};  ///< ScenePath::density
  uint32_t sample_key = 0;       ///< Of random numbers that no other part of the path draws.
  uint32_t scatterings = 0;
  MediaSetId media = 0;
  float pdf = 0;  ///< Density of the direction if the phase function drew it [1/sr].
  uint8_t hero = 0;
  bool only_hero = false;
  bool is_coloured = false;
};

/// Branches that may wait at a time, of one path; where so many do there are no more.
inline constexpr std::size_t kMostBranches = 24;

}  // namespace freepath
