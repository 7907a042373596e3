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
  BoundaryCrossing* const place =
      std::upper_bound(begin, end, crossing,
                       [](const auto& a, const auto& b) { return a.place.is_before(b.place); });
  // Two triangles that share an edge may both claim a ray through it.
  for (auto* at = place; at != begin && (at - 1)->place.is_tied(crossing.place); --at) {
    if ((at - 1)->is_same(crossing)) return;
  }
  for (auto* at = place; at != end && at->place.is_tied(crossing.place); ++at) {
    if (at->is_same(crossing)) return;
  }
  if (count_ < kCapacity) {
    std::move_backward(place, end, end + 1);
    ++count_;
  } else {
    overflowed_ = true;
    if (place == end) return;
    std::move_backward(place, end - 1, end);
  }
  *place = crossing;
}

}  // namespace freepath
