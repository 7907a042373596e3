#pragma once
/// @file A procedural cloud and incoherent rays through it: what the benchmarks walk.

#include <vector>

#include "freepath/media/medium.h"
#include "freepath/tracking/streams.h"

namespace freepath::bench {

/// Rays of one batch, about as many as a wavefront of the renderer carries.
inline constexpr std::size_t kRaysPerBatch = 8192;

/// A cloud of size³ voxels with 45 % of its bricks in use, lumpy enough that majorants are two to
/// four times the mean extinction. The edge of a voxel is 1 [world], and clouds of any size look
/// alike over a few voxels, so that their times differ by what memory costs. A function of the size
/// alone.
Medium make_cloud(int size);

/// Rays from random places in the cloud in random directions, as after a scattering: no two look up
/// the same part of memory but by chance.
std::vector<RayStream> make_rays(const Medium& medium, std::size_t batches);

/// Parallel rays along x from outside, through random places of the medium's side: the pixels of a
/// picture.
std::vector<RayStream> make_view_rays(const Medium& medium, std::size_t batches);

/// Of the cells that are not empty: the mean majorant over the mean extinction of their voxels.
double majorant_ratio(const Medium& medium);

}  // namespace freepath::bench
