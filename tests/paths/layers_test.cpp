// Layers of volumes: that they are what they are called, whatever the walk, and add up.

#include "freepath/sensors/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "tests/scene/volume_pictures.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr int kWidth = 12;
constexpr int kHeight = 8;

/// A homogeneous cube, 2 wide, that glows.
Medium glowing_cube(const Rgb& sigma_s) {
  Matrix4d eighths;
  eighths.setScale(Vec3d(0.125));
  Component component;
  component.density = make_field(
      Vec3i(-8), Vec3i(7), [](const Vec3i&) { return 1.0F; }, eighths);
  component.sigma_a = Rgb(0.3F);
  component.sigma_s = sigma_s;
  component.emission = Rgb(2.0F, 1.0F, 0.5F);
  std::vector<Component> components;
  components.push_back(std::move(component));
  return Medium(std::move(components));
}

Camera camera_at(const Vec3d& from) {
  return {{from, Vec3d(0), Vec3d(0, 1, 0), 35}, kWidth, kHeight};
}

Surroundings environment() { return {Rgb(0.5F, 1.0F, 1.5F)}; }

RenderSettings sampled(uint32_t samples) {
  RenderSettings settings;
  settings.samples = samples;
  settings.layers = LayerSet::all();
  settings.walk.interpolation = Interpolation::kNearest;
  return settings;
}

float value(const Image& image, const std::string& channel, std::size_t pixel) {
  return image.values[pixel * image.channels.size() + find_channel(image, channel).value()];
}

void expect_parts_make_the_whole(const Image& image) {
  for (const std::string c : {"R", "G", "B"}) {
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
      const float whole = value(image, c, i);
      const float sum = value(image, "emission." + c, i) + value(image, "background." + c, i) +
                        value(image, "direct." + c, i) + value(image, "indirect." + c, i);
      EXPECT_NEAR(sum, whole, 1e-5F * std::abs(whole) + 1e-7F) << c << " of pixel " << i;
      const auto n = value(image, "samples", i);
      const float odd = std::floor(n / 2);
      const float halves =
          (value(image, "A." + c, i) * (n - odd) + value(image, "B." + c, i) * odd) / n;
      EXPECT_NEAR(halves, whole, 1e-5F * std::abs(whole) + 1e-7F) << c << " of pixel " << i;
    }
  }
}

TEST(Layers, PartsOfTheLightAddUpForEveryKindOfPath) {
  // One path for all channels, one for each, and one that carries channels of its own.
  for (const char* tracker : {"delta", "weighted-delta:rate-scale=1.3", "spectral"}) {
    for (const Rgb& sigma_s : {Rgb(1.5F), Rgb(1.5F, 0.7F, 0.2F)}) {
      for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
        RenderSettings settings = sampled(7);
        settings.walk.tracker = tracker;
        settings.walk.absorption = absorption;
        const Medium medium = glowing_cube(sigma_s);
        const RenderResult result = render(medium, camera_at({0, 0, 6}), environment(), settings);
        SCOPED_TRACE(tracker);
        expect_parts_make_the_whole(result.film.to_image());
      }
    }
  }
}

TEST(Layers, PartsAreThePicturesOfPathsThatEndThere) {
  const Medium medium = glowing_cube(Rgb(1.5F));
  RenderSettings settings = sampled(5);
  const auto picture = [&](uint32_t max_scatterings) {
    settings.max_scatterings = max_scatterings;
    return render(medium, camera_at({0, 0, 6}), environment(), settings).film.to_image();
  };
  const Image all = picture(UINT32_MAX);
  const Image single = picture(1);
  double indirect = 0;
  for (std::size_t i = 0; i < all.pixel_count(); ++i) {
    for (const std::string c : {"R", "G", "B"}) {
      const float expected = value(single, c, i);
      const float direct = value(all, "emission." + c, i) + value(all, "background." + c, i) +
                           value(all, "direct." + c, i);
      EXPECT_NEAR(direct, expected, 1e-5F * expected + 1e-7F) << c << " of pixel " << i;
      EXPECT_NEAR(value(single, "indirect." + c, i), 0, 1e-6F);
      indirect += value(all, "indirect." + c, i);
    }
  }
  EXPECT_GT(indirect, 1);
}

TEST(Layers, OfTheMiddleOfACubeAreThoseOfTheClosedForm) {
  // A camera far away sees the middle of the cube along 2 of extinction 0.3 + sigma_s. Light that
  // has not scattered: T of the background, and (1 - T) of sigma_a / sigma_t of the glow.
  for (const char* tracker : {"delta", "spectral"}) {
    const Rgb sigma_s(1.2F, 0.6F, 0.2F);
    const Medium medium = glowing_cube(sigma_s);
    RenderSettings settings = sampled(20'000);
    settings.crop = Crop{6, 4, 7, 5};
    settings.walk.tracker = tracker;
    const Camera camera({Vec3d(0, 0, 60), Vec3d(0), Vec3d(0, 1, 0), 0.5}, kWidth, kHeight);
    const Image image = render(medium, camera, environment(), settings).film.to_image();
    const Rgb glow(2.0F, 1.0F, 0.5F);
    const Rgb outside(0.5F, 1.0F, 1.5F);
    const std::string names[] = {"R", "G", "B"};
    for (int c = 0; c < kChannels; ++c) {
      const double sigma_t = 0.3 + sigma_s[c];
      const double t = std::exp(-2 * sigma_t);
      const double standard_error = std::sqrt(t * (1 - t) / 20'000);
      EXPECT_NEAR(value(image, "transmittance." + names[c], 0), t, 5 * standard_error) << tracker;
      EXPECT_NEAR(value(image, "background." + names[c], 0), t * outside[c],
                  5 * standard_error * outside[c]);
      EXPECT_NEAR(value(image, "emission." + names[c], 0), (1 - t) * 0.3 / sigma_t * glow[c],
                  0.02 * glow[c]);
    }
    // Towards the camera, as often as there is an event; and between front and back.
    EXPECT_NEAR(value(image, "normal.Z", 0), value(image, "A", 0), 0.02) << tracker;
    EXPECT_NEAR(value(image, "position.Z", 0), 60 - value(image, "depth.Z", 0), 1e-3);
    EXPECT_EQ(value(image, "samples", 0), 20'000);
  }
}

// In a medium that takes colours apart, a path of all channels has its first event where one of
// them may rarely have it: depths are means over events with their weights.
TEST(Layers, DepthsCountByTheWeightsOfTheirEvents) {
  constexpr double kLength = 2;
  const Rgb sigma_s(6, 1, 0.3F);
  double events = 0;
  double ways = 0;
  for (int c = 0; c < kChannels; ++c) {
    const double sigma = sigma_s[c] + 0.3;
    const double passed = std::exp(-sigma * kLength);
    events += 1 - passed;
    ways += (1 - passed) / sigma - kLength * passed;
  }
  RenderSettings settings = sampled(8192);
  settings.walk.tracker = "spectral:collision-probability=history-max";
  OrthographicCamera straight;
  straight.screen_window = {-0.5, 0.5, -0.5, 0.5};
  const View view{Vec3d(0, 0, 3), Vec3d(0), Vec3d(0, 1, 0)};
  const Camera camera(straight, world_from_camera(view), 4, 4);
  for (const Absorption absorption : {Absorption::kAnalog, Absorption::kWeighted}) {
    settings.walk.absorption = absorption;
    const Image image =
        render(glowing_cube(sigma_s), camera, environment(), settings).film.to_image();
    double depth = 0;
    for (std::size_t i = 0; i < 16; ++i) depth += value(image, "depth.Z", i) / 16;
    constexpr double kToFace = 3 - 0.9375;
    EXPECT_NEAR(depth, kToFace + ways / events, 0.005);
  }
}

TEST(Layers, ChangeNothingOfThePicture) {
  const Medium medium = glowing_cube(Rgb(1.5F, 0.7F, 0.2F));
  RenderSettings settings = sampled(3);
  const Film with = render(medium, camera_at({0, 0, 6}), environment(), settings).film;
  settings.layers = {};
  const Film without = render(medium, camera_at({0, 0, 6}), environment(), settings).film;
  EXPECT_EQ(without.to_image().channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(without.to_image().values, with.to_image({}).values);
}

TEST(Crop, IsBitForBitThePartOfThePicture) {
  const Medium medium = glowing_cube(Rgb(1.5F, 0.7F, 0.2F));
  RenderSettings settings = sampled(3);
  const Image whole = render(medium, camera_at({1, 2, 6}), environment(), settings).film.to_image();
  for (const Crop& crop : {Crop{3, 2, 10, 7}, Crop{0.25, 0.25, 0.8, 0.875, true}}) {
    settings.crop = crop;
    const Image part =
        render(medium, camera_at({1, 2, 6}), environment(), settings).film.to_image();
    ASSERT_EQ(part.width, 7);
    ASSERT_EQ(part.height, 5);
    EXPECT_EQ(part.x, 3);
    EXPECT_EQ(part.y, 2);
    EXPECT_EQ(part.full_width, kWidth);
    EXPECT_EQ(part.full_height, kHeight);
    for (int row = 0; row < part.height; ++row) {
      const float* const expected = whole.pixel(part.x, part.y + row);
      EXPECT_TRUE(std::equal(part.pixel(0, row),
                             part.pixel(0, row) + part.width * part.channels.size(), expected));
    }
  }
}

TEST(Crop, IsWithinThePictureAndHasPixels) {
  for (const Crop& crop : {Crop{-1, 0, 4, 4}, Crop{0, 0, 13, 4}, Crop{4, 4, 4, 6},
                           Crop{0, 0.5, 0.5, 1.5, true}, Crop{NAN, 0, 1, 1}}) {
    EXPECT_THROW(pixel_window(crop, kWidth, kHeight), Error);
  }
  // Neighbours in fractions share no pixel and leave none out.
  int columns = 0;
  for (int i = 0; i < 10; ++i) {
    columns += pixel_window(Crop{i / 10.0, 0, (i + 1) / 10.0, 1, true}, 1280, 8).width;
  }
  EXPECT_EQ(columns, 1280);
}

TEST(OnPass, SeesTheFilmGrow) {
  const Medium medium = glowing_cube(Rgb(1.5F));
  RenderSettings settings = sampled(9);
  std::vector<uint32_t> samples;
  settings.on_pass = [&](const Film& film) { samples.push_back(film.sample_counts().fewest); };
  render(medium, camera_at({0, 0, 6}), environment(), settings);
  ASSERT_GE(samples.size(), 2U);
  EXPECT_EQ(samples.front(), 1U);
  EXPECT_EQ(samples.back(), 9U);
  EXPECT_TRUE(std::is_sorted(samples.begin(), samples.end()));
}

TEST(ParseLayers, KnowsSetsNamesAndTheirUnions) {
  EXPECT_EQ(parse_layers("all"), LayerSet::all());
  EXPECT_EQ(parse_layers("none"), LayerSet());
  EXPECT_EQ(parse_layers("depth,normal"), (LayerSet{Layer::kDepth, Layer::kNormal}));
  EXPECT_EQ(parse_layers("default,halves"), LayerSet::standard().with({Layer::kHalves}));
  for (const LayerInfo& info : layer_infos()) {
    EXPECT_EQ(parse_layers(info.name), LayerSet{info.layer});
  }
  for (const char* wrong : {"", "norml", "depth,", "Depth"}) {
    EXPECT_THROW(parse_layers(wrong), Error) << wrong;
  }
}

}  // namespace
}  // namespace freepath::testing
