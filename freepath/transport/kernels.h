#pragma once
/// @file The compiled walks: one function for each method, channel count and SIMD target.

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "freepath/base/lat_long.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/media/medium_view.h"
#include "freepath/tracking/method.h"
#include "freepath/tracking/streams.h"
#include "freepath/tracking/walk_modes.h"
#include "freepath/transport/scattering_kernels.h"

namespace freepath {

/// The instructions a walk is compiled for. All give the same bits.
enum class Simd { kBest, kOneLane, kSse4, kAvx2, kAvx512 };

/// @throws Error for an unknown name
Simd parse_simd(std::string_view name);
/// SIMD targets that this machine can run, best first, one lane last.
std::vector<Simd> available_simd();
std::string_view to_string(Simd simd);

/// Walks a stream of rays through a medium by one method.
using WalkFunction = void (*)(const MediumView& medium, std::span<const float> options,
                              const WalkModes& modes, uint64_t seed, const RayStream& rays,
                              FlightStream& flights, WalkStatistics& statistics);

/// Walks by the number of channels; null where it is not compiled.
using WalkTable = std::array<WalkFunction, kMaxChannels + 1>;

/// The walks that are compiled, of a template of them: `walk_of.operator()<N>()` is the walk of N
/// channels. Other numbers take the next larger walk (compiled_channels).
template <class WalkOf>
WalkTable walk_table(const WalkOf& walk_of) {
  WalkTable walks{};
  walks[1] = walk_of.template operator()<1>();
  walks[3] = walk_of.template operator()<3>();
  walks[4] = walk_of.template operator()<4>();
  if constexpr (kMaxChannels > 8) walks[8] = walk_of.template operator()<8>();
  walks[kMaxChannels] = walk_of.template operator()<kMaxChannels>();
  return walks;
}

/// One method as compiled for one target.
struct Kernel {
  MethodInfo info;
  WalkTable walks{};
  /// Throws Error if the method can't walk this medium; null where it can walk any.
  void (*check)(const Medium& medium, Interpolation interpolation) = nullptr;
  /// Whether it takes emitted radiance for the same everywhere.
  bool uniform_emission = false;
};

/// All methods of one target, in the order of the registry, and what paths do beside walks.
struct KernelTable {
  std::vector<Kernel> trackers;
  std::vector<Kernel> transmittance;
  ScatteringKernels scattering;
  LocateDirections locate = nullptr;  ///< Where directions stand in an image of the whole sphere.
};

/// Channels of the smallest compiled walk that carries so many.
int compiled_channels(const WalkTable& walks, int channels);

/// @throws Error if this machine can't run the target
const KernelTable& kernels(Simd simd);

}  // namespace freepath
