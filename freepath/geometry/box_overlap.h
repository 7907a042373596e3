#pragma once
/// @file Whether surfaces meet a box, erring towards yes. Internal to this folder.

#include <array>
#include <cstdint>
#include <span>

#include "freepath/base/vector.h"
#include "freepath/geometry/traced_part.h"

namespace freepath {

/// False only if a plane separates them: that of the triangle, a side of the box, or one along an
/// edge of each [Akenine01].
bool triangle_meets_box(const std::array<Vec3d, 3>& corners, const Box3d& box);

/// @param to_box,to_part between the space of the part and that of the box
bool part_meets_box(const TracedPart& part, const AffineTransform& to_box,
                    const AffineTransform& to_part, std::span<const uint32_t> shapes,
                    const Box3d& box);

}  // namespace freepath
