#include "freepath/geometry/boundary_crossings.h"

#include <algorithm>

namespace freepath {

void BoundaryCrossings::clear() {
  count_ = 0;
  overflowed_ = false;
}

void BoundaryCrossings::add(const BoundaryCrossing& crossing) {
  BoundaryCrossing* const begin = crossings_.data();
  BoundaryCrossing* const end = begin + count_;
  BoundaryCrossing* const slot = std::upper_bound(
      begin, end, crossing,
      [](const auto& a, const auto& b) { return a.position.is_before(b.position); });
  // Two triangles that share an edge may both claim a ray through it.
  for (auto* at = slot; at != begin && (at - 1)->position.is_tied(crossing.position); --at) {
    if ((at - 1)->is_same(crossing)) return;
  }
  for (auto* at = slot; at != end && at->position.is_tied(crossing.position); ++at) {
    if (at->is_same(crossing)) return;
  }
  if (count_ < kCapacity) {
    std::move_backward(slot, end, end + 1);
    ++count_;
  } else {
    overflowed_ = true;
    if (slot == end) return;
    std::move_backward(slot, end - 1, end);
  }
  *slot = crossing;
}

}  // namespace freepath
