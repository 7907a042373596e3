// Places in images of the whole sphere in lanes, on every target: bit for bit the scalar ones.

#include "freepath/base/lat_long.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "freepath/base/distributions.h"
#include "freepath/base/random.h"
#include "freepath/transport/kernels.h"

namespace freepath {
namespace {

/// Directions all around, and those that stand on edges: poles, axes, both sides of the seam.
std::vector<Vec3f> directions() {
  std::vector<Vec3f> all;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      for (const float aside : {0.0F, -0.0F, 1e-7F, -1e-7F, 1e-30F, -1e-30F}) {
        Vec3f d(aside);
        d[axis] = sign;
        all.push_back(d);
      }
    }
  }
  RandomStream random(1, 2, 3, 4);
  while (all.size() < 5000) {
    const float u = random.uniform();
    all.push_back(sample_sphere(u, random.uniform()));
  }
  return all;
}

TEST(LatLong, LanesOfEveryTargetFindThePlacesThatTheScalarFunctionsFind) {
  const LatLongGrid grids[] = {{1, 1, UpAxis::kY},  {2, 1, UpAxis::kZ},
                               {5, 3, UpAxis::kY},  {512, 256, UpAxis::kY},
                               {7, 40, UpAxis::kZ}, {4096, 2048, UpAxis::kZ}};
  const std::vector<Vec3f> all = directions();
  for (const Simd simd : available_simd()) {
    SCOPED_TRACE(std::string(to_string(simd)));
    for (const LatLongGrid& grid : grids) {
      SCOPED_TRACE(grid.width);
      // Streams that are filled to every count.
      for (std::size_t first = 0, count = 1; first + count <= all.size();
           first += count, count = count % LatLongStream::kCapacity + 1) {
        LatLongStream stream;
        stream.count = count;
        for (std::size_t i = 0; i < count; ++i) {
          for (int axis = 0; axis < 3; ++axis) stream.direction[axis][i] = all[first + i][axis];
        }
        kernels(simd).locate(grid, stream);
        for (std::size_t i = 0; i < count; ++i) {
          SCOPED_TRACE(first + i);
          const LatLong at = lat_long(all[first + i], grid.up);
          const float x = at.u * static_cast<float>(grid.width);
          const float y = at.v * static_cast<float>(grid.height);
          const LatLongPlace expected = place_of(grid, x, y);
          const LatLongPlace found = stream.place(i);
          ASSERT_EQ(found.corners, expected.corners);
          ASSERT_EQ(found.right, expected.right);
          ASSERT_EQ(found.down, expected.down);
          ASSERT_EQ(stream.pixel[i], pixel_at(grid, x, y));
          for (const uint32_t corner : found.corners) {
            ASSERT_LT(corner, static_cast<uint32_t>(grid.width * grid.height));
          }
        }
      }
    }
  }
}

TEST(LatLong, PlacesLieBetweenTheCentresOfPixels) {
  const LatLongGrid grid{8, 4, UpAxis::kY};
  // A quarter of the way from pixel (2, 1) to (3, 1), and three quarters down to row 2.
  const LatLongPlace inside = place_of(grid, 2.75F, 2.25F);
  EXPECT_EQ(inside.corners, (std::array<uint32_t, 4>{10, 11, 18, 19}));
  EXPECT_EQ(inside.right, 0.25F);
  EXPECT_EQ(inside.down, 0.75F);
  // Left of the first column's centre, above the first row's.
  const LatLongPlace corner = place_of(grid, 0.25F, 0.125F);
  EXPECT_EQ(corner.corners, (std::array<uint32_t, 4>{7, 0, 7, 0}));
  EXPECT_EQ(corner.right, 0.75F);
  EXPECT_EQ(corner.down, 0.625F);
  const LatLongPlace end = place_of(grid, 7.75F, 3.75F);
  EXPECT_EQ(end.corners, (std::array<uint32_t, 4>{31, 24, 31, 24}));
  EXPECT_EQ(pixel_at(grid, 7.75F, 3.75F), 31U);
  EXPECT_EQ(pixel_at(grid, 8.0F, 4.0F), 31U) << "rounding may reach the far edges";
}

}  // namespace
}  // namespace freepath
