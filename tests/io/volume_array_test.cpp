// Fields from dense arrays: every value in its place, and nothing that is no density.

#include "freepath/io/volume_array.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// Values that are all different, x fastest, over more than one brick along each axis.
constexpr std::array<std::size_t, 3> kCounts{9, 10, 17};
constexpr std::array<std::ptrdiff_t, 3> kStrides{1, 9, 90};

template <class Real>
std::vector<Real> distinct_values() {
  std::vector<Real> values(kCounts[0] * kCounts[1] * kCounts[2]);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Real>(i + 1);
  return values;
}

template <class Real>
LoadedField load(const std::vector<Real>& values, const LoadOptions& options = {}) {
  return field_from_array(VoxelArray<Real>{values.data(), kCounts, kStrides}, "array", Matrix4d(),
                          options);
}

LoadOptions with(NegativePolicy negative, InvalidPolicy invalid) {
  LoadOptions options;
  options.negative = negative;
  options.invalid = invalid;
  return options;
}

std::string failure(const std::vector<float>& values, const LoadOptions& options) {
  try {
    load(values, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

template <class Real>
class VolumeArray : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(VolumeArray, Reals);

TYPED_TEST(VolumeArray, EveryValueStandsInItsPlace) {
  const auto values = distinct_values<TypeParam>();
  const BrickMap map = load(values).field.voxels;
  EXPECT_EQ(map.active_min(), Vec3i(0));
  EXPECT_EQ(map.active_max(), Vec3i(8, 9, 16));
  EXPECT_EQ(map.value({1, 0, 0}), 2);
  EXPECT_EQ(map.value({0, 1, 0}), 10);
  EXPECT_EQ(map.value({0, 0, 1}), 91);
  EXPECT_EQ(map.value({8, 9, 16}), static_cast<float>(values.size()));
  EXPECT_EQ(map.value({9, 9, 16}), 0);
  std::vector<float> copy(values.size());
  copy_voxels(map, copy.data());
  for (int x = 0, i = 0; x < 9; ++x) {
    for (int y = 0; y < 10; ++y) {
      for (int z = 0; z < 17; ++z, ++i) {
        ASSERT_EQ(copy[i], static_cast<float>(values[x + 9 * y + 90 * z]));
      }
    }
  }
}

TEST(VolumeArray, BricksOfOneValueAreStoredOnce) {
  const std::vector<float> values(64 * 64 * 64, 2.5F);
  const LoadedField loaded = field_from_array(
      VoxelArray<float>{values.data(), {64, 64, 64}, {4096, 64, 1}}, "array", Matrix4d());
  EXPECT_EQ(loaded.field.voxels.brick_count(), 2U);  // the empty one, and that
  EXPECT_EQ(loaded.field.voxels.active_max(), Vec3i(63));
  EXPECT_EQ(loaded.active_voxels, values.size());
}

TEST(VolumeArray, ZerosAreActiveAndTakeNoBricks) {
  std::vector<float> values(64 * 64 * 64, 0.0F);
  values[20] = 1;
  const LoadedField loaded = field_from_array(
      VoxelArray<float>{values.data(), {64, 64, 64}, {4096, 64, 1}}, "array", Matrix4d());
  EXPECT_EQ(loaded.field.voxels.brick_count(), 2U);
  EXPECT_EQ(loaded.field.voxels.active_min(), Vec3i(0));
  EXPECT_EQ(loaded.field.voxels.active_max(), Vec3i(63));
}

TEST(VolumeArray, WhatIsNoDensityIsNamed) {
  auto values = distinct_values<float>();
  values[8 + 9 * 2 + 90 * 3] = -1;
  EXPECT_EQ(failure(values, {}),
            "array: voxel (8, 2, 3) is negative (-1); densities are 0 or more: repair the grid, or "
            "have negative ones taken as 0 (--negative clamp)");
  EXPECT_EQ(load(values, with(NegativePolicy::kClamp, InvalidPolicy::kZero)).clamped_voxels, 1U);
  values[8 + 9 * 2 + 90 * 3] = std::numeric_limits<float>::quiet_NaN();
  const LoadOptions strict = with(NegativePolicy::kError, InvalidPolicy::kError);
  EXPECT_NE(failure(values, strict).find("voxel (8, 2, 3) is NaN"), std::string::npos);
  EXPECT_EQ(load(values).invalid_voxels, 1U);
}

TEST(VolumeArray, WhatCannotBeHeldIsRefused) {
  const float value = 1;
  const auto reason = [&](std::array<std::size_t, 3> counts, const Matrix4d& transform) {
    try {
      field_from_array(VoxelArray<float>{&value, counts, {0, 0, 0}}, "array", transform);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(reason({3, 0, 3}, Matrix4d()), "array: the array is empty: it has no voxel along y");
  EXPECT_NE(reason({100000, 100000, 100000}, Matrix4d()).find("memory"), std::string::npos);
  Matrix4d flat;
  flat[2][2] = 0;
  EXPECT_NE(reason({1, 1, 1}, flat).find("invertible"), std::string::npos);
}

}  // namespace
}  // namespace freepath
