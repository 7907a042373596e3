#pragma once
/// @file Media that overlap, as one medium each.

#include <cstdint>
#include <map>
#include <memory>
#include <shared_mutex>
#include <span>
#include <vector>

#include "freepath/paths/media_set.h"
#include "freepath/paths/scene_medium.h"

namespace freepath {

/// Numbers for the combinations of media that paths meet, above those of the media. A number
/// depends on who came first; what it stands for does not. Threads share it.
class MediaCombinations {
 public:
  /// @param media of the scene
  explicit MediaCombinations(std::size_t media) : media_(media) {}

  /// What fills a place: vacuum, a medium, or a combination.
  MediumId of(const MediaSet& set) const;
  /// The media of a combination, in ascending order.
  std::vector<MediumId> members(MediumId combination) const;

 private:
  MediumId number(std::vector<MediumId> members) const;

  std::size_t media_;
  mutable std::shared_mutex mutex_;
  mutable std::map<std::vector<MediumId>, MediumId> numbers_;
  mutable std::vector<std::vector<MediumId>> members_;
};

/// The components of several media.
/// @throws Error if there are more than a medium can have, or it can't have them together
std::shared_ptr<const Medium> combine_media(std::span<const std::shared_ptr<const Medium>> media);

}  // namespace freepath
