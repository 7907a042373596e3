#pragma once
/// @file What the channels of paths stand for, and the walkers of media in these channels.

#include <cstdint>
#include <memory>
#include <vector>

#include "freepath/render/paths/emission_guide.h"
#include "freepath/render/paths/path_scene.h"
#include "freepath/spectra/spectrum_table.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// Walkers of a medium: one for all channels of a path, or one for each.
struct MediumWalkers {
  BoundMedium bound;
  std::vector<Walker> walkers;
};

/// Paths that share wavelengths: the spectra at them and the walkers of all media.
struct PathColors {
  SpectrumValues spectra;
  std::vector<std::shared_ptr<const MediumWalkers>> media;
};

/// Makes colours for the samples of a scene. In R, G, B all samples share them. In spectral mode a
/// sample of every pixel has the same wavelengths: the first channel's run through a van der Corput
/// sequence over 1/N of the spectrum's probability, shifted by the seed, and the others
/// follow at equal distances of probability [Wilkie14]. So the wavelengths of 2^k samples are
/// equidistant, and pictures have next to no noise of colour.
class ColorFactory {
 public:
  /// @param scene must outlive this
  /// @throws Error as Walker
  /// @param wavelengths of a path in spectral mode, 1 to kMaxChannels
  ColorFactory(const PathScene& scene, ColorMode mode, int wavelengths, const WalkSettings& walk);

  std::shared_ptr<const PathColors> colors_of_sample(uint32_t sample) const;

  /// Paths of a sample: 1, or one for each channel where a tracker gives each its own.
  int paths_per_sample() const { return paths_per_sample_; }
  /// Whether samples differ in walkers, so that flights of different samples are walked apart.
  bool depends_on_sample() const { return depends_on_sample_; }
  /// Directions towards the emission of a medium, null where there is none.
  const EmissionGuide* guide(std::size_t medium) const { return guides_[medium].get(); }
  /// Whether so much of a medium glows that a guide costs more than it gives.
  bool glow_is_spread(std::size_t medium) const { return glow_is_spread_[medium]; }
  /// R, G, B of the scene's spectra: as given where R, G, B is rendered, else as the observer sees
  /// the spectra, so that light may be seen in both ways.
  const SpectrumValues& rgb() const { return rgb_->spectra; }
  /// Whether paths without colour may see lights in R, G, B: wavelengths are rendered, and no
  /// medium tells them apart.
  bool sees_rgb() const { return sees_rgb_; }

 private:
  std::shared_ptr<const MediumWalkers> make_walkers(std::size_t medium,
                                                    const SpectrumValues& spectra) const;
  std::shared_ptr<const PathColors> make(SpectrumValues spectra) const;
  void make_guides();
  SpectrumValues spectra_of_sample(uint32_t sample) const;

  const PathScene& scene_;
  ColorMode mode_;
  int wavelengths_;
  WalkSettings walk_;
  int paths_per_sample_ = 1;
  bool depends_on_sample_ = false;
  bool sees_rgb_ = false;
  /// Walkers of media that are the same at all wavelengths, null of others.
  std::vector<std::shared_ptr<const MediumWalkers>> constant_;
  std::shared_ptr<const PathColors> rgb_;
  std::vector<std::unique_ptr<const EmissionGuide>> guides_;  // of media
  std::vector<bool> glow_is_spread_;                          // of media
};

}  // namespace freepath
