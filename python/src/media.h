#pragma once
/// @file A medium as Python holds it.

#include <memory>
#include <optional>
#include <vector>

#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"
#include "freepath/scene/volume_medium.h"

namespace freepath::python {

/// A medium with cross sections in any number of channels.
struct PythonMedium {
  std::shared_ptr<const Medium> medium;
  MediumChannels channels;
  /// Temperatures of the components, in their order, where they glow as black bodies.
  std::vector<std::optional<TemperatureEmission>> temperatures;
  int super_voxel = 0;  ///< As it was asked for.

  /// Whether its coefficients are one for all, or R, G and B, so that it can be rendered.
  bool is_renderable() const { return channels.count == 1 || channels.count == kChannels; }
  /// Some of its channels, in this order; all of them where none are named.
  MediumChannels selected(const std::vector<int>& numbers) const;
  /// What positions are relative to in single precision: the middle of the medium.
  Vec3d origin() const;
  /// The same as scenes take it, repeated along `sides`, for which its voxels are copied.
  /// @throws Error for channels that are not R, G and B, and as make_medium
  VolumeMedium as_volumes(const PeriodicSides& sides = {}) const;
  /// Grey media that repeat along `sides`, one for each channel, of which there may be any number;
  /// one alone where all are the same.
  /// @throws Error as make_medium
  std::vector<VolumeMedium> as_grey_volumes(const PeriodicSides& sides) const;
};

}  // namespace freepath::python
