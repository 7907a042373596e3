#pragma once
/// @file Media made of the cloud, and a haze.

#include "freepath/media/medium.h"

namespace freepath::bench {

/// A cube whose density varies smoothly between 0.55 and 1: minima of super-voxels are most of the
/// maxima.
Medium make_haze(const Rgb& sigma_a, const Rgb& sigma_s);

/// A medium of one component with other cross sections.
Medium with_spectra(const Medium& medium, const Rgb& sigma_a, const Rgb& sigma_s);

/// A medium of one component as two that share its field, and its extinction in the ratio 3 : 1.
Medium in_two_parts(const Medium& medium);

/// A medium of one component as `count` ≤ 8 that overlap: its mirror images, each a field of its
/// own with 1/count of the extinction.
Medium in_mirrors(const Medium& medium, int count);

}  // namespace freepath::bench
