// Volumes far from the world's origin look as they do near it.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "freepath/base/box.h"
#include "tests/scene/volume_pictures.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kSize = 32;

/// A lump of noise, placed in the world.
Medium lump(const Matrix4d& index_to_world) {
  const auto density = [](const Vec3i& p) {
    return p.length2() < 140 ? 0.1F + hash_noise(p) : 0.0F;
  };
  Component component;
  component.density = make_field(Vec3i(-12), Vec3i(11), density, index_to_world);
  component.sigma_a = Rgb(0.2F);
  component.sigma_s = Rgb(3, 2, 1.5F);
  component.phase = PhaseFunction::henyey_greenstein(0.5F);
  return Medium({component});
}

Image picture(const Medium& medium, const View& view) {
  const Surroundings lights{Rgb(0.5F), Sun({.elevation = 50}, UpAxis::kY)};
  RenderSettings settings;
  settings.samples = 64;
  return render(medium, Camera(view, kSize, kSize), lights, settings).film.to_image();
}

// All numbers are multiples of powers of two that a double holds even there.
TEST(FarVolumes, AreTheSameBitForBitWhereNumbersAreExact) {
  const auto picture_at = [](const Vec3d& origin) {
    Matrix4d index_to_world;
    index_to_world.setScale(Vec3d(0.125));
    index_to_world *= Matrix4d().setTranslation(origin);
    View view;
    view.from = origin + Vec3d(-2, 1.5, 4.25);
    view.at = origin + Vec3d(0.25, 0, 0);
    return picture(lump(index_to_world), view);
  };
  const Image near = picture_at(Vec3d(0));
  for (const double distance : {1e6, 1e9}) {
    const Image far = picture_at(Vec3d(distance, -3 * distance, 0.5 * distance));
    EXPECT_EQ(far.values, near.values) << distance;
  }
}

double mean_of(const Image& image, const std::string& channel) {
  const int index = *find_channel(image, channel);
  double sum = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) sum += image.pixel(column, row)[index];
  }
  return sum / static_cast<double>(image.pixel_count());
}

// Turned and framed, numbers are rounded. Doubles at a distance of 3e9 are 5e-7 apart, a hundred
// thousandth of a voxel; the same random numbers lead to almost the same paths.
TEST(FarVolumes, AreTheSameButForRoundingElsewhere) {
  const auto picture_at = [](const Vec3d& origin) {
    Matrix4d index_to_world;
    index_to_world.setScale(Vec3d(0.1, 0.07, 0.12));
    index_to_world *= Matrix4d().rotate(Vec3d(0.3, 0.5, 0.2));
    index_to_world *= Matrix4d().setTranslation(origin);
    const Medium medium = lump(index_to_world);
    return picture(medium, frame_points(corners_of(medium.world_bounds()), UpAxis::kY, 30, 1));
  };
  const Image near = picture_at(Vec3d(0));
  for (const double distance : {1e6, 1e9}) {
    const Image far = picture_at(Vec3d(distance, -3 * distance, 0.5 * distance));
    for (const char* channel : {"R", "G", "B", "A", "depth.Z", "lookups"}) {
      const double mean = mean_of(near, channel);
      EXPECT_NEAR(mean_of(far, channel), mean, 1e-3 * mean) << channel << " at " << distance;
    }
  }
}

}  // namespace
}  // namespace freepath::testing
