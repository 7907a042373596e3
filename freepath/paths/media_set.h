#pragma once
/// @file The media that fill a place.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "freepath/base/error.h"

namespace freepath {

/// A medium of PathScene::media, or none. Those beyond are combinations: see MediaCombinations.
using MediumId = int32_t;
inline constexpr MediumId kVacuum = -1;

/// The media at a place, as a path keeps them: how often each has been entered and not left. A
/// medium is there where its number is above 0.
///
/// A boundary with M inside and N outside adds one to M and takes one from N on the way in, and the
/// other way round on the way out, vacuum having no number. So what is at a place does not depend
/// on the way there, nor on the order in which boundaries at one distance are crossed: nested media
/// replace each other where their boundaries say so, and others overlap.
class MediaSet {
 public:
  static constexpr int kCapacity = 8;

  struct Entry {
    MediumId medium = kVacuum;
    int32_t count = 0;
    friend bool operator==(const Entry&, const Entry&) = default;
    friend bool operator<(const Entry& a, const Entry& b) {
      return a.medium < b.medium || (a.medium == b.medium && a.count < b.count);
    }
  };

  /// Media whose number is not 0, in the order of their ids.
  std::span<const Entry> entries() const { return {entries_.data(), size_}; }

  /// @throws Error where there are more media at once than it holds
  void add(MediumId medium, int32_t count) {
    if (medium == kVacuum || count == 0) return;
    uint32_t slot = 0;
    while (slot < size_ && entries_[slot].medium < medium) ++slot;
    if (slot < size_ && entries_[slot].medium == medium) {
      entries_[slot].count += count;
      if (entries_[slot].count == 0) {
        for (--size_; slot < size_; ++slot) entries_[slot] = entries_[slot + 1];
      }
      return;
    }
    if (size_ == kCapacity) {
      fail("more than {} media overlap at one place; make boundaries name what is around them",
           kCapacity);
    }
    for (uint32_t i = size_++; i > slot; --i) entries_[i] = entries_[i - 1];
    entries_[slot] = {medium, count};
  }

  /// Crosses a boundary.
  void cross(MediumId inside, MediumId outside, bool enters) {
    if (inside == outside) return;
    add(enters ? inside : outside, 1);
    add(enters ? outside : inside, -1);
  }

  /// Crosses a boundary that some rays go through unchanged (it has an alpha), so that one may
  /// leave what it never entered: whatever was entered before, the one side is there afterwards and
  /// the other is not, as in pbrt.
  void cross_porous(MediumId inside, MediumId outside, bool enters) {
    if (inside == outside) return;
    const MediumId to = enters ? inside : outside;
    const MediumId from = enters ? outside : inside;
    add(from, -std::max(0, count(from)));
    add(to, std::max(0, 1 - count(to)));
  }

  int32_t count(MediumId medium) const {
    for (const Entry& entry : entries()) {
      if (entry.medium == medium) return entry.count;
    }
    return 0;
  }

  friend bool operator==(const MediaSet& a, const MediaSet& b) {
    return std::ranges::equal(a.entries(), b.entries());
  }
  /// Any order.
  friend bool operator<(const MediaSet& a, const MediaSet& b) {
    const std::span<const Entry> one = a.entries();
    const std::span<const Entry> other = b.entries();
    return std::lexicographical_compare(one.begin(), one.end(), other.begin(), other.end());
  }

 private:
  std::array<Entry, kCapacity> entries_{};
  uint32_t size_ = 0;
};

}  // namespace freepath
