#pragma once
/// @file The media around the rays of a thread, by number.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "freepath/paths/media_set.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/sample_spectra.h"

namespace freepath {

/// A set of media that MediaSetTable knows.
using MediaSetId = uint32_t;

/// Numbers the sets of media that rays come to, and remembers what crossing a boundary makes of
/// them, so that a path carries a number and not a set. One for each thread.
class MediaSetTable {
 public:
  /// @param scene,factory must outlive this
  MediaSetTable(const PathScene& scene, const WavelengthSampler& factory)
      : scene_(scene), factory_(factory) {}

  /// The number of a set, which is made if there is none.
  MediaSetId of(const MediaSet& media) {
    const auto [known, is_new] = numbers_.try_emplace(media, static_cast<MediaSetId>(sets_.size()));
    if (is_new) {
      sets_.push_back(media);
      media_.push_back(factory_.medium_of(media));
    }
    return known->second;
  }

  /// The medium, or combination of media, that fills a place: WavelengthSampler::medium_of.
  MediumId medium(MediaSetId set) const { return media_[set]; }

  /// The media beyond the boundary of a shape.
  /// @throws Error where there are more media at once than a set holds
  MediaSetId cross(MediaSetId set, uint32_t shape, bool enters) {
    const PathShape& boundary = scene_.shapes[shape];
    if (boundary.inside == boundary.outside) return set;
    Crossing& last = crossings_[(set * 31 + shape * 2 + (enters ? 1 : 0)) % kRemembered];
    if (last.from != set || last.shape != shape) {  // its place in the table tells the side
      MediaSet media = sets_[set];
      boundary.cross(media, enters);
      last = {set, shape, of(media)};
    }
    return last.to;
  }

 private:
  const PathScene& scene_;
  const WavelengthSampler& factory_;
  std::vector<MediaSet> sets_;
  std::vector<MediumId> media_;
  std::map<MediaSet, MediaSetId> numbers_;
  /// Crossings that came last to the places of a table.
  struct Crossing {
    MediaSetId from = ~MediaSetId{0};
    uint32_t shape = 0;
    MediaSetId to = 0;
  };
  static constexpr uint32_t kRemembered = 256;
  std::array<Crossing, kRemembered> crossings_;
};

}  // namespace freepath
