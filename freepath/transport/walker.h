#pragma once
/// @file The facade of the walk: what programs, Python and embedders call.

#include <memory>
#include <span>
#include <string>

#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"
#include "freepath/transport/kernels.h"
#include "freepath/transport/part_walks.h"

namespace freepath {

/// Which methods to walk with, and how.
struct WalkSettings {
  std::string tracker = "delta";        ///< "name:option=value"; see tracker_infos().
  std::string transmittance = "ratio";  ///< Estimator and its options; see transmittance_infos().
  Interpolation interpolation = Interpolation::kStochastic;
  Absorption absorption = Absorption::kWeighted;
  EmissionTally emission = EmissionTally::kCollision;
  Simd simd = Simd::kBest;
  uint64_t seed = 0;
  /// What positions of rays are relative to [world]. They are in single precision: of a medium far
  /// from the world's origin, a point near it should be the origin.
  Vec3d origin{0, 0, 0};
};

std::span<const MethodInfo> tracker_infos();
std::span<const MethodInfo> transmittance_infos();

/// Whether one path can carry all channels: the tracker is spectral, or the extinction is the same
/// in all. Otherwise each channel takes paths of its own, by a walker of its own.
/// @throws Error for a tracker that does not exist
bool shares_paths(const Medium& medium, const WalkSettings& settings);
bool shares_paths(const MediumChannels& channels, const WalkSettings& settings);

/// Samples free paths and estimates transmittances in one medium. Const and without state of its
/// own: any number of threads may share it, each with its own streams.
class Walker {
 public:
  /// Carries all channels in one walk.
  static constexpr int kAllChannels = -1;

  /// @param medium must outlive the walker
  /// @param channel the one channel to carry, or kAllChannels, which needs shares_paths()
  /// @throws Error for methods, options or instructions that do not exist, and for kAllChannels
  ///   where each channel must take its own path
  Walker(const Medium& medium, const WalkSettings& settings, int channel = kAllChannels);

  /// A walker of given channels: of wavelengths, or with emission that varies from place to place.
  /// @param channels one for each component of the medium; their fields must outlive the walker
  /// @throws Error as above; for cross sections that are negative or not finite, or are not those
  /// of
  ///   the medium's components, or more than kMaxChannels
  Walker(const Medium& medium, const MediumChannels& channels, const WalkSettings& settings);

  /// Flies every ray to its next scattering, absorption or escape [Kutz17]. Flights are written to
  /// the slots of their rays; a ray's flight depends on the ray and the seed alone.
  void free_paths(const RayStream& rays, FlightStream& flights, WalkStatistics& statistics) const;

  /// Estimates the transmittance from each ray's origin to its t_max: the weight of its flight.
  void transmittance(const RayStream& rays, FlightStream& flights,
                     WalkStatistics& statistics) const;

  /// Draws a component that scatters at each ray's t_max, in proportion to its scattering
  /// coefficients there: the flight is a scattering by that component, whose weights are its
  /// coefficients over the probability of the draw [1/m]. Nothing scatters, and the flight is an
  /// escape, where the ray ends outside of the medium or in a void of it.
  void scattering_at_ends(const RayStream& rays, FlightStream& flights,
                          WalkStatistics& statistics) const;

  /// Channels in the weights of a flight: 1, where one stands for all, or those of the medium.
  int channels() const { return channels_; }
  /// Channels in the weights of a transmittance: 1 where one extinction serves all.
  int transmittance_channels() const { return transmittance_.channels; }

 private:
  struct Bound {
    WalkFunction function = nullptr;
    Method method;
    int channels = 1;
    PartWeights weights = PartWeights::kHandedOn;
  };
  void walk(const Bound& bound, const WalkModes& modes, const RayStream& rays,
            FlightStream& flights, WalkStatistics& statistics) const;

  MediumView view_;
  std::shared_ptr<const PartWalks> parts_;  // null where the medium is one part
  Bound tracker_;
  Bound transmittance_;
  WalkModes modes_;
  uint64_t seed_;
  int channels_;
};

}  // namespace freepath
