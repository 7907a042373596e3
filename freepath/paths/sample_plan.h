#pragma once
/// @file Samples where the noise is: the shares that pixels take, by a pilot.

#include <cstdint>
#include <vector>

#include "freepath/sensors/film.h"
#include "freepath/sensors/sample_share.h"

namespace freepath {

/// The pixels of a pilot's film: squares of pixels of the picture, of which those at its right and
/// lower edge may reach beyond it.
struct PilotGrid {
  int edge = 1;  ///< Of a square [pixels].
  int width = 1, height = 1;

  /// The finest grid of at most kMostSquares over a picture.
  static PilotGrid over(int width, int height);
  static constexpr int64_t kMostSquares = 8192;
};

/// Samples that a pilot takes of each of its pixels.
inline constexpr uint32_t kPilotSamples = 4;
/// Number of its first pixel for random numbers: no picture has so many, so that a pilot's are its
/// own.
inline constexpr uint32_t kFirstPilotPixel = uint32_t{1} << 31;

/// The shares of the samples that the squares of a pilot's grid take, row by row: their mean over
/// the squares is 1, as nearly as steps allow.
///
/// For the smallest mean square error in a given time a pixel takes samples in proportion to its
/// standard deviation over the root of the time of a sample [Neyman34]. The deviation is that
/// of the pilot's few samples, averaged over the neighbouring squares; as such estimates err by
/// factors where a few paths bring most of the light, its square root is taken: half the way, in
/// powers, that the exact one would ask for. The time of a sample is a constant and its look-ups,
/// which don't depend on the machine.
///
/// The pilot's samples have no part in the picture, so that its pixels' means stay without bias
/// [Kirk91].
/// @param pilot with look-ups recorded
std::vector<SampleShare> shares_of_pilot(const Film& pilot);

/// Gives the pixels of a film of a picture the shares of the squares that they lie in.
/// @param film without samples
void give_shares(const std::vector<SampleShare>& shares, const PilotGrid& grid, Film& film);

}  // namespace freepath
