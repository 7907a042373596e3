#pragma once
/// @file Points and directions that are almost the same.

#include <gtest/gtest.h>

#include "freepath/base/vector.h"

namespace freepath::testing {

inline void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-6F) {
  EXPECT_LE((a - b).length(), tolerance) << a << " is not " << b;
}

}  // namespace freepath::testing
