#include "freepath/io/view_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace freepath {
namespace {

TEST(ViewTransform, StandardLeavesLightAsItIs) {
  EXPECT_EQ(view_transform({0.2F, 1.5F, 7}, ViewTransform::kStandard), Vec3f(0.2F, 1.5F, 7));
}

// By hand, from the specification.
TEST(ViewTransform, NeutralHasTheValuesOfItsSpecification) {
  const auto expect = [](const Vec3f& light, const Vec3f& expected) {
    const Vec3f value = view_transform(light, ViewTransform::kNeutral);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-5F) << light.x << " " << c;
  };
  expect({0, 0, 0}, {0, 0, 0});
  expect({0.5F, 0.3F, 0.2F}, {0.46F, 0.26F, 0.16F});
  expect({0.04F, 0.04F, 0.04F}, {0.01F, 0.01F, 0.01F});  // 6.25 · 0.04²
  // Less 0.04: 1.96. The peak becomes 1 - 0.24²/1.44 = 0.96.
  expect({2, 2, 2}, {0.96F, 0.96F, 0.96F});
  // Less 0.04: (1.96, 0.46, 0.16); times 0.96/1.96; then 1 - 1/1.15 of the way to white.
  const float white = 1 - 1 / 1.15F;
  const auto mixed = [&](float v) { return v * 0.96F / 1.96F * (1 - white) + 0.96F * white; };
  expect({2, 0.5F, 0.2F}, {0.96F, mixed(0.46F), mixed(0.16F)});
}

TEST(ViewTransform, NeutralGrowsWithLightAndStaysBelowWhite) {
  float last = -1;
  for (float light = 0; light < 1000; light = light * 1.05F + 0.001F) {
    const Vec3f value = view_transform({light, light, light}, ViewTransform::kNeutral);
    EXPECT_GT(value.x, last);
    EXPECT_LE(value.x, 1);
    last = value.x;
  }
}

}  // namespace
}  // namespace freepath
