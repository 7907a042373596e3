#pragma once
/// @file What the channels of paths stand for, and the walkers of media in these channels.

#include <cstdint>
#include <map>
#include <memory>
#include <shared_mutex>
#include <utility>
#include <vector>

#include "freepath/paths/emission_guide.h"
#include "freepath/paths/media_combinations.h"
#include "freepath/paths/path_scene.h"
#include "freepath/sensors/sample_share.h"
#include "freepath/spectra/spectrum_table.h"
#include "freepath/spectra/wavelengths.h"
#include "freepath/transport/walker.h"
#include "freepath/transport/weight_growth.h"

namespace freepath {

/// Walkers of a medium: one for all channels of a path, or one for each.
struct MediumWalkers {
  /// A component of a medium of the scene.
  struct Origin {
    MediumId medium = kVacuum;
    uint32_t component = 0;
  };

  BoundMedium bound;
  std::vector<Walker> walkers;
  std::vector<Origin> origins;  ///< Origins of the components of a combination; else none.
};

class WavelengthSampler;

/// Paths that share wavelengths: the spectra at them and the walkers of all media.
class SampleSpectra {
 public:
  /// @param factory must outlive this
  SampleSpectra(const WavelengthSampler& factory, SpectrumValues values,
                std::vector<std::shared_ptr<const MediumWalkers>> walkers)
      : spectra(std::move(values)),
        per_white(1 / sum_of(spectra.illuminant(Vec3f(1)))),
        mean_per_white(per_white * static_cast<float>(spectra.channels())),
        media(std::move(walkers)),
        factory_(factory) {}

  /// The walkers of a medium, or of a combination, which are made when they are first asked for.
  /// @throws Error if the media of a combination can't be walked together
  const MediumWalkers& walkers(MediumId medium) const {
    const auto number = static_cast<std::size_t>(medium);
    return number < media.size() ? *media[number] : combination(medium);
  }
  /// @param channel the one that a path carries, or -1
  const Walker& walker(MediumId medium, int channel) const {
    return walkers(medium).walkers[channel < 0 ? 0 : channel];
  }

  const SpectrumValues spectra;
  /// What makes the sum of a radiance's channels 1 where it is white: an illuminant of R, G, B = 1.
  const float per_white;
  /// What makes the mean of a radiance's channels 1 where it is white.
  const float mean_per_white;
  const std::vector<std::shared_ptr<const MediumWalkers>> media;

 private:
  const MediumWalkers& combination(MediumId medium) const;

  const WavelengthSampler& factory_;
  mutable std::shared_mutex mutex_;
  mutable std::map<MediumId, std::shared_ptr<const MediumWalkers>> combinations_;
};

/// Makes colours for the samples of a scene. In R, G, B all samples share them.
///
/// In spectral mode a path has N wavelengths at equal distances of probability [Wilkie14], and
/// there are sets of them: K sets make a block, whose K·N wavelengths are equidistant, shifted by
/// the seed. K samples of a pixel run through a block in an order of bits reversed and scrambled,
/// which is random for each pixel: so the wavelengths of 2^k samples of a pixel are equidistant and
/// pictures have next to no noise of colour, yet pixels are independent but for the error of a
/// quadrature with K·N nodes. The next block lies between the nodes of the blocks before.
class WavelengthSampler {
 public:
  /// @param scene must outlive this
  /// @throws Error as Walker
  /// @param wavelengths of a path in spectral mode, 1 to kMaxChannels
  /// @param chooses_transmittance whether homogeneous media have the estimator that is exact there
  ///   in place of that of `walk`
  /// @param density of each wavelength
  WavelengthSampler(const PathScene& scene, ColorMode mode, int wavelengths,
                    const WalkSettings& walk, bool chooses_transmittance = false,
                    WavelengthDensity density = WavelengthDensity::kFilm);

  /// Number of the set of wavelengths that a sample has; in R, G, B its own.
  /// @param pixel of the whole picture
  /// @param share of the pixel: its samples in a block of rounds have the sets of the block
  uint32_t set_of(uint32_t pixel, uint32_t sample, SampleShare share = {}) const;
  /// Sets of a block, a power of two. Samples [K·b, K·(b + 1)) have sets of the same numbers.
  uint32_t sets_per_block() const { return sets_per_block_; }
  std::shared_ptr<const SampleSpectra> colors_of_set(uint32_t set) const;

  /// Scatterings in media, by the instructions that walks are taken by.
  const ScatteringKernels& scattering() const { return kernels(walk_.simd).scattering; }
  /// Where escapes stand in an image around the scene, likewise.
  LocateDirections locate() const { return kernels(walk_.simd).locate; }
  /// Growth of the weights of paths in the medium where it is largest.
  const WeightGrowth& weight_growth() const { return weight_growth_; }

  /// Paths of a sample: 1, or one for each channel where a tracker gives each its own.
  int paths_per_sample() const { return paths_per_sample_; }
  /// Whether sets of wavelengths differ in walkers, so that their flights are walked apart.
  bool depends_on_wavelengths() const { return depends_on_wavelengths_; }
  /// Directions towards the emission of a medium, null where there is none.
  const EmissionGuide* guide(MediumId medium) const {
    const auto number = static_cast<std::size_t>(medium);
    return number < guides_.size() ? guides_[number].get() : nullptr;
  }
  /// Whether so much of a medium glows that a guide costs more than it gives. Paths in combinations
  /// do without.
  bool emission_is_uniform(MediumId medium) const {
    const auto number = static_cast<std::size_t>(medium);
    return number >= glow_is_spread_.size() || glow_is_spread_[number];
  }
  const PathScene& scene() const { return scene_; }
  /// A medium of the scene in R, G and B.
  BoundMedium bound_in_rgb(std::size_t medium) const;
  /// What fills a place.
  MediumId medium_of(const MediaSet& media) const { return combinations_.of(media); }
  /// The walkers of a combination of media, made of those of its media.
  std::shared_ptr<const MediumWalkers> combine(MediumId combination,
                                               const SampleSpectra& colors) const;
  /// R, G, B of the scene's spectra: as given where R, G, B is rendered, else as the observer sees
  /// the spectra, so that light may be seen in both ways.
  const SpectrumValues& rgb() const { return rgb_->spectra; }
  /// Whether paths without colour may see lights in R, G, B: those are rendered, or wavelengths
  /// that no medium tells apart.
  bool sees_rgb() const { return sees_rgb_; }

 private:
  std::shared_ptr<const MediumWalkers> make_walkers(std::size_t medium,
                                                    const SpectrumValues& spectra) const;
  void add_walkers(MediumWalkers& walkers, bool is_homogeneous) const;
  std::shared_ptr<const MediumWalkers> make_combination(MediumId combination,
                                                        const SampleSpectra& colors) const;
  std::shared_ptr<const Medium> combined_medium(
      MediumId combination, const std::vector<std::shared_ptr<const Medium>>& media) const;
  std::shared_ptr<const SampleSpectra> make(SpectrumValues spectra) const;
  void find_weight_growth(const SpectrumValues& first);
  void make_guides();
  SpectrumValues spectra_of_set(uint32_t set) const;
  uint32_t choose_sets_per_block() const;

  const PathScene& scene_;
  ColorMode mode_;
  int wavelengths_;
  WalkSettings walk_;
  bool chooses_transmittance_;
  WavelengthDensity density_;
  int paths_per_sample_ = 1;
  bool depends_on_wavelengths_ = false;
  uint32_t sets_per_block_ = 1;
  bool sees_rgb_ = false;
  WeightGrowth weight_growth_;
  /// Walkers of media that are the same at all wavelengths, null of others.
  std::vector<std::shared_ptr<const MediumWalkers>> constant_;
  std::shared_ptr<const SampleSpectra> rgb_;
  std::vector<std::unique_ptr<const EmissionGuide>> guides_;  // of media
  std::vector<bool> glow_is_spread_;                          // of media
  MediaCombinations combinations_;
  /// What is the same for all samples: walkers of combinations of constant media, and media
  /// together with those that they are made of.
  struct CombinedMedium {
    std::vector<std::shared_ptr<const Medium>> media;
    std::shared_ptr<const Medium> medium;
  };
  mutable std::shared_mutex mutex_;
  mutable std::map<MediumId, std::shared_ptr<const MediumWalkers>> constant_combinations_;
  mutable std::map<MediumId, CombinedMedium> combined_media_;
};

}  // namespace freepath
