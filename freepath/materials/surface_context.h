#pragma once
/// @file What materials are evaluated with, besides the point.

#include "freepath/materials/textures/texture_table.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The state of a path that materials need. Cheap to make for each hit.
struct SurfaceContext {
  const SpectrumValues& spectra;
  const TextureTable& textures;
  int hero = 0;            ///< The channel that decides where channels part.
  bool only_hero = false;  ///< All other channels of the path have ended before.

  /// The factor for the hero where the other channels end here: it then stands for all of them,
  /// since the wavelength of each channel has the same distribution.
  float hero_factor() const { return only_hero ? 1.0F : static_cast<float>(spectra.channels()); }
};

}  // namespace freepath
