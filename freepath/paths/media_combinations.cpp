#include "freepath/paths/media_combinations.h"

#include <mutex>
#include <utility>

namespace freepath {

MediumId MediaCombinations::of(const MediaSet& set) const {
  MediumId only = kVacuum;
  int present = 0;
  for (const MediaSet::Entry& entry : set.entries()) {
    if (entry.count <= 0) continue;
    only = entry.medium;
    ++present;
  }
  if (present <= 1) return only;
  std::vector<MediumId> members;
  for (const MediaSet::Entry& entry : set.entries()) {
    if (entry.count > 0) members.push_back(entry.medium);
  }
  return number(std::move(members));
}

MediumId MediaCombinations::number(std::vector<MediumId> members) const {
  {
    const std::shared_lock lock(mutex_);
    const auto found = numbers_.find(members);
    if (found != numbers_.end()) return found->second;
  }
  const std::unique_lock lock(mutex_);
  const auto next = static_cast<MediumId>(media_ + members_.size());
  const auto [entry, is_new] = numbers_.try_emplace(members, next);
  if (is_new) members_.push_back(std::move(members));
  return entry->second;
}

std::vector<MediumId> MediaCombinations::members(MediumId combination) const {
  const std::shared_lock lock(mutex_);
  return members_.at(static_cast<std::size_t>(combination) - media_);
}

std::shared_ptr<const Medium> combine_media(std::span<const std::shared_ptr<const Medium>> media) {
  std::vector<Component> components;
  for (const auto& medium : media) {
    components.insert(components.end(), medium->components().begin(), medium->components().end());
  }
  return std::make_shared<const Medium>(std::move(components));
}

}  // namespace freepath
