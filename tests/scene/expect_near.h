#pragma once
/// @file Colours that are almost the same.

#include <gtest/gtest.h>

#include "freepath/base/vector.h"

namespace freepath::testing {

inline void expect_near(const Vec3f& found, const Vec3f& expected, float tolerance = 1e-4F) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "channel " << i;
}

}  // namespace freepath::testing
