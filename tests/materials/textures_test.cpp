// Textures give the values that their definitions say.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/materials/textures/texture_noise.h"
#include "freepath/materials/textures/texture_table.h"
#include "freepath/spectra/rgb_color_space.h"

namespace freepath::testing {
namespace {

std::shared_ptr<const TextureImage> read_texture_image(const std::string& path,
                                                       const ImageEncoding& encoding = {}) {
  return texture_image(read_image(path), path, encoding);
}

SurfacePoint at(float u, float v) {
  SurfacePoint point;
  point.position = Vec3f(0);
  point.normal = point.shading_normal = Vec3f(0, 0, 1);
  point.u = u;
  point.v = v;
  return point;
}

/// 2x2, grey: 1 2 in the upper row, 3 4 in the lower.
std::shared_ptr<const TextureImage> four_greys() {
  return std::make_shared<TextureImage>(2, 2, 1, std::vector<float>{1, 2, 3, 4});
}

float looked_up(const ImageMapTexture& texture, float u, float v) {
  TextureTable table;
  return table.evaluate_float(table.add(FloatTexture(texture)), at(u, v));
}

TEST(ImageMap, PixelCentresAreExactAndTheTopRowHasTheLargestV) {
  const ImageMapTexture texture{four_greys(), {}};
  EXPECT_EQ(looked_up(texture, 0.25F, 0.75F), 1);
  EXPECT_EQ(looked_up(texture, 0.75F, 0.75F), 2);
  EXPECT_EQ(looked_up(texture, 0.25F, 0.25F), 3);
  EXPECT_EQ(looked_up(texture, 0.75F, 0.25F), 4);
}

TEST(ImageMap, IsBilinearBetweenThem) {
  const ImageMapTexture texture{four_greys(), {}};
  EXPECT_EQ(looked_up(texture, 0.5F, 0.75F), 1.5F);
  EXPECT_EQ(looked_up(texture, 0.25F, 0.5F), 2);
  EXPECT_EQ(looked_up(texture, 0.375F, 0.625F),
            0.75F * 0.75F * 1 + 0.75F * 0.25F * (2 + 3) + 0.0625F * 4);
}

TEST(ImageMap, WrapsAtItsEdges) {
  ImageMapTexture texture{four_greys(), {}};
  EXPECT_EQ(looked_up(texture, 1.25F, -0.25F), 1);  // one period on
  EXPECT_EQ(looked_up(texture, 0, 0.75F), 1.5F);    // half of either column
  texture.wrap = ImageWrap::kClamp;
  EXPECT_EQ(looked_up(texture, 0, 0.75F), 1);
  EXPECT_EQ(looked_up(texture, 7, 0.25F), 4);
  texture.wrap = ImageWrap::kBlack;
  EXPECT_EQ(looked_up(texture, 0, 0.75F), 0.5F);
  EXPECT_EQ(looked_up(texture, -3, 0.75F), 0);
}

TEST(ImageMap, MapsScalesAndInverts) {
  ImageMapTexture texture{four_greys(), UvMapping{2, 3, 0.25F, -0.25F}};
  EXPECT_EQ(looked_up(texture, 0.25F, 1 / 3.0F), 2);  // s = 0.75, t = 0.75
  texture.mapping = {};
  texture.scale = 0.125F;
  EXPECT_EQ(looked_up(texture, 0.75F, 0.25F), 0.5F);
  texture.invert = true;
  EXPECT_EQ(looked_up(texture, 0.25F, 0.75F), 0.875F);
  texture.scale = 1;
  EXPECT_EQ(looked_up(texture, 0.75F, 0.25F), 0);
}

TEST(ImageMap, OfNoPlaceIsACorner) {
  const float infinite = std::numeric_limits<float>::infinity();
  const ImageMapTexture texture{four_greys(), {}};
  EXPECT_GE(looked_up(texture, infinite, std::nanf("")), 1);
}

TEST(ImageMap, OfColoursIsTheirMeanOrTheirAlphaAsANumber) {
  const auto rgb = std::make_shared<TextureImage>(1, 1, 3, std::vector<float>{0.1F, 0.2F, 0.6F});
  EXPECT_NEAR(looked_up({rgb, {}}, 0, 0), 0.3, 1e-6);
  const auto rgba =
      std::make_shared<TextureImage>(1, 1, 4, std::vector<float>{0.1F, 0.2F, 0.6F, 0.75F});
  EXPECT_EQ(looked_up({rgba, {}}, 0, 0), 0.75F);
}

TEST(ImageMap, OfColoursIsAReflectance) {
  SpectrumTable spectra(rgb_color_space("srgb"));
  const SpectrumValues rgb = spectra.in_rgb();
  TextureTable table;
  const auto image = std::make_shared<TextureImage>(1, 1, 3, std::vector<float>{0.1F, 0.2F, 0.6F});
  const SpectrumTextureId id = table.add(SpectrumTexture(ImageMapTexture{image, {}}));
  const SampledSpectrum found = table.evaluate_spectrum(id, at(0, 0), rgb);
  const SampledSpectrum expected = rgb.reflectance({0.1F, 0.2F, 0.6F});
  for (int i = 0; i < kMaxChannels; ++i) EXPECT_NEAR(found[i], expected[i], 1e-6);
}

TEST(Checkerboard, ChangesAtEveryWhole) {
  TextureTable table;
  const FloatTextureId board =
      table.add(FloatTexture(CheckerboardTexture<FloatInput>{1.0F, 2.0F, UvMapping{4, 2}}));
  EXPECT_EQ(table.evaluate_float(board, at(0.1F, 0.1F)), 1);
  EXPECT_EQ(table.evaluate_float(board, at(0.26F, 0.1F)), 2);
  EXPECT_EQ(table.evaluate_float(board, at(0.1F, 0.6F)), 2);
  EXPECT_EQ(table.evaluate_float(board, at(0.26F, 0.6F)), 1);
  EXPECT_EQ(table.evaluate_float(board, at(-0.1F, 0.1F)), 2);
  EXPECT_EQ(table.evaluate_float(board, at(-0.1F, -0.1F)), 1);
}

TEST(Textures, ScaleAndMixTakeTextures) {
  SpectrumTable spectra(rgb_color_space("srgb"));
  const SpectrumId half = spectra.add(0.5, SpectrumRole::kReflectance);
  const SpectrumId full = spectra.add(1.0, SpectrumRole::kReflectance);
  const SpectrumValues rgb = spectra.in_rgb();
  TextureTable table;
  const FloatTextureId quarter = table.add(FloatTexture(0.25F));
  const FloatTextureId scaled = table.add(FloatTexture(ScaleTexture<FloatInput>{quarter, 2.0F}));
  EXPECT_EQ(table.evaluate_float(scaled, at(0, 0)), 0.5F);
  const FloatTextureId mixed = table.add(FloatTexture(MixTexture<FloatInput>{1.0F, 2.0F, quarter}));
  EXPECT_EQ(table.evaluate_float(mixed, at(0, 0)), 1.25F);
  const SpectrumTextureId dim =
      table.add(SpectrumTexture(ScaleTexture<SpectrumInput>{half, quarter}));
  EXPECT_NEAR(table.evaluate_spectrum(dim, at(0, 0), rgb)[1], 0.125, 1e-6);
  const SpectrumTextureId between =
      table.add(SpectrumTexture(MixTexture<SpectrumInput>{dim, full, 0.5F}));
  EXPECT_NEAR(table.evaluate_spectrum(between, at(0, 0), rgb)[1], 0.5625, 1e-6);
  EXPECT_NEAR(table.evaluate(SpectrumInput(full), at(0, 0), rgb)[1], 1, 1e-6);
}

TEST(Textures, RefuseWhatCannotBe) {
  TextureTable table;
  EXPECT_THROW(table.add(FloatTexture(ImageMapTexture{})), Error);
  EXPECT_THROW(table.add(FloatTexture(ScaleTexture<FloatInput>{FloatTextureId{0}, 1.0F})), Error);
  EXPECT_THROW(
      table.add(SpectrumTexture(MixTexture<SpectrumInput>{SpectrumTextureId{3}, SpectrumId{}})),
      Error);
  EXPECT_THROW(TextureImage(2, 2, 1, {1, 2, 3}), Error);
  EXPECT_THROW(TextureImage(1, 1, 2, {1, 2}), Error);
  EXPECT_THROW(image_wrap("octahedralsphere"), Error);
  EXPECT_THROW(image_encoding("gamma"), Error);
  EXPECT_THROW(image_encoding("gamma 0"), Error);
  EXPECT_THROW(image_encoding("gamma 2.2x"), Error);
  EXPECT_THROW(read_texture_image("/nowhere/none.png"), Error);
}

TEST(Textures, NamesAreKnown) {
  EXPECT_EQ(image_wrap("clamp"), ImageWrap::kClamp);
  EXPECT_EQ(image_encoding("linear").kind, ImageEncoding::Kind::kLinear);
  EXPECT_EQ(image_encoding("gamma 2.2").gamma, 2.2F);
  EXPECT_TRUE(holds_encoded_integers("a.b/wood.PNG"));
  EXPECT_FALSE(holds_encoded_integers("wood.exr"));
}

/// A file that goes when the test does.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& extension)
      : path((std::filesystem::temp_directory_path() /
              ("freepath_textures_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
               extension))
                 .string()) {}
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::string path;
};

TEST(ReadTextureImage, DecodesIntegersAsAsked) {
  const TemporaryFile file(".png");
  // 188 of 255 is the sRGB value of 0.5029.
  const float linear = linear_from_srgb(188 / 255.0F);
  write_png(file.path, {1, 1, {"R", "G", "B"}, {linear, 0, 1}});
  const auto pixel = [&](const char* encoding) {
    return read_texture_image(file.path, image_encoding(encoding))
        ->color(0.5F, 0.5F, ImageWrap::kClamp)
        .x;
  };
  EXPECT_NEAR(pixel("sRGB"), 0.5029, 1e-4);
  EXPECT_NEAR(pixel("linear"), 188 / 255.0, 1e-6);
  EXPECT_NEAR(pixel("gamma 2"), std::pow(188 / 255.0, 2), 1e-6);
}

TEST(ReadTextureImage, LeavesFloatsAsTheyAreAndOpaqueAlphaOut) {
  const TemporaryFile file(".exr");
  write_exr(file.path, {1, 1, {"R", "G", "B", "A"}, {2, 3, 4, 1}});
  const auto image = read_texture_image(file.path, image_encoding("gamma 2"));
  EXPECT_EQ(image->channels(), 3);
  EXPECT_EQ(image->color(0.5F, 0.5F, ImageWrap::kClamp), Vec3f(2, 3, 4));
  write_exr(file.path, {1, 1, {"R", "G", "B", "A"}, {0.5F, 0.5F, 0.5F, 0.5F}});
  EXPECT_EQ(read_texture_image(file.path)->channels(), 4);
  write_exr(file.path, {1, 1, {"Y"}, {0.25F}});
  EXPECT_EQ(read_texture_image(file.path)->channels(), 1);
}

SurfacePoint in_world(const Vec3f& position) {
  SurfacePoint point;
  point.position = position;
  return point;
}

/// A texture twice as large as the world, and moved.
Matrix4d doubled() { return Matrix4d().setTranslation(Vec3d(2, 4, 6)) * Matrix4d().setScale(0.5); }

void expect_coordinates(const TextureMapping& mapping, const Vec3f& position, double s, double t) {
  const SurfacePoint point = in_world(position);
  const TextureCoordinates at = mapped(mapping, {point, Vec3d(position)});
  EXPECT_NEAR(at.s, s, 1e-6);
  EXPECT_NEAR(at.t, t, 1e-6);
}

TEST(Mapping, PlanarProjectsOnTwoVectors) {
  expect_coordinates(PlanarTextureMapping{}, {3, 4, 5}, 3, 4);
  // (3, 4, 5) is (2.5, 4, 5.5) there.
  expect_coordinates(PlanarTextureMapping{doubled(), Vec3d(0, 2, 0), Vec3d(1, 0, 1), 0.25, -8},
                     {3, 4, 5}, 2 * 4 + 0.25, 2.5 + 5.5 - 8);
}

TEST(Mapping, SphericalHasThePoleAtZ) {
  const SphericalTextureMapping mapping{doubled()};
  const auto expect = [&](const Vec3f& there, double s, double t) {
    expect_coordinates(mapping, there * 2 - Vec3f(2, 4, 6), s, t);
  };
  expect({0, 0, 3}, 0, 0);
  expect({0, 0, -3}, 1, 0);
  expect({2, 0, 0}, 0.5, 0);
  expect({0, 2, 0}, 0.5, 0.25);
  expect({-1, 0, 0}, 0.5, 0.5);
  expect({0, -1, 0}, 0.5, 0.75);
  expect({1, 1, std::sqrt(2.0F)}, 0.25, 0.125);
}

TEST(Mapping, CylindricalBeginsAtMinusX) {
  const CylindricalTextureMapping mapping{doubled()};
  const auto expect = [&](const Vec3f& there, double s, double t) {
    expect_coordinates(mapping, there * 2 - Vec3f(2, 4, 6), s, t);
  };
  expect({2, 0, 7}, 0.5, 7);
  expect({0, 3, -1}, 0.75, -1);
  expect({0, -3, 0}, 0.25, 0);
  expect({-1, 0, 0}, 1, 0);
  expect({1, -1, 0}, 0.375, 0);
}

TEST(Mapping, IsThatOfImagesBoardsAndDots) {
  const TextureMapping mapping = PlanarTextureMapping{{}, Vec3d(0, 1, 0), Vec3d(0, 0, 1)};
  const SurfacePoint point = in_world({9, 0.75F, 0.25F});
  TextureTable table;
  EXPECT_EQ(
      table.evaluate_float(table.add(FloatTexture(ImageMapTexture{four_greys(), mapping})), point),
      4);
  const auto board = table.add(FloatTexture(CheckerboardTexture<FloatInput>{1.0F, 2.0F, mapping}));
  EXPECT_EQ(table.evaluate_float(board, point), 1);
  EXPECT_EQ(table.evaluate_float(board, in_world({9, 1.75F, 0.25F})), 2);
}

TEST(Bilerp, IsTheValueOfItsCornersAndGoesOnBeyondThem) {
  TextureTable table;
  const auto id = table.add(FloatTexture(BilerpTexture<FloatInput>{1.0F, 2.0F, 4.0F, 16.0F, {}}));
  EXPECT_EQ(table.evaluate_float(id, at(0, 0)), 1);
  EXPECT_EQ(table.evaluate_float(id, at(0, 1)), 2);
  EXPECT_EQ(table.evaluate_float(id, at(1, 0)), 4);
  EXPECT_EQ(table.evaluate_float(id, at(1, 1)), 16);
  EXPECT_EQ(table.evaluate_float(id, at(0.25F, 0.5F)), (0.75F * 3 + 0.25F * 20) / 2);
  EXPECT_EQ(table.evaluate_float(id, at(2, 0)), 7);
}

TEST(Dots, HaveAnInsideAndAnOutside) {
  TextureTable table;
  const auto id = table.add(FloatTexture(DotsTexture<FloatInput>{3.0F, 5.0F, {}}));
  int inside = 0;
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint point = at(0.13F * static_cast<float>(i), 0.07F * static_cast<float>(i));
    const bool dot = in_polka_dot(point.u, point.v);
    inside += dot ? 1 : 0;
    EXPECT_EQ(table.evaluate_float(id, point), dot ? 3 : 5);
  }
  EXPECT_GT(inside, 5);
  EXPECT_LT(inside, 95);
}

TEST(DirectionMix, GoesByTheCosineToItsDirection) {
  TextureTable table;
  const auto id =
      table.add(FloatTexture(DirectionMixTexture<FloatInput>{10.0F, 20.0F, Vec3f(0.6F, 0, 0.8F)}));
  const auto seen = [&](const Vec3f& normal) {
    SurfacePoint point;
    point.normal = normal;
    point.shading_normal = Vec3f(0, 1, 0);  // which has no part in it
    return table.evaluate_float(id, point);
  };
  EXPECT_FLOAT_EQ(seen({0, 0, 1}), 0.8F * 10 + 0.2F * 20);
  EXPECT_FLOAT_EQ(seen({-1, 0, 0}), 0.6F * 10 + 0.4F * 20);
  EXPECT_FLOAT_EQ(seen({0, 1, 0}), 20);
}

/// How many textures are evaluated for one that is made of the one before it twice, N times over.
template <class Id, class First, class Next, class Evaluate>
uint64_t evaluated(int depth, const First& first, const Next& next, const Evaluate& evaluate) {
  TextureTable table;
  Id last = table.add(first);
  for (int i = 0; i < depth; ++i) last = table.add(next(last));
  uint64_t count = 0;
  evaluate(table, last, count);
  return count;
}

// Without memory they would be 2^N.
TEST(NestedTextures, AreEvaluatedOnceEach) {
  SpectrumTable spectra(rgb_color_space("srgb"));
  const SpectrumId half = spectra.add(0.5, SpectrumRole::kReflectance);
  const SpectrumValues rgb = spectra.in_rgb();
  for (const int depth : {15, 60}) {
    const auto floats = [&](const auto& next) {
      return evaluated<FloatTextureId>(
          depth, FloatTexture(0.5F), next,
          [](const TextureTable& table, FloatTextureId id, uint64_t& count) {
            EXPECT_FLOAT_EQ(table.evaluate_float(id, at(0.25F, 0.5F), &count), 0.5F);
          });
    };
    const auto colors = [&](const auto& next) {
      return evaluated<SpectrumTextureId>(
          depth, SpectrumTexture(half), next,
          [&](const TextureTable& table, SpectrumTextureId id, uint64_t& count) {
            const SampledSpectrum found = table.evaluate_spectrum(id, at(0.25F, 0.5F), rgb, &count);
            EXPECT_FLOAT_EQ(found[1], 0.5F);
          });
    };
    const uint64_t each = depth + 1;
    EXPECT_EQ(floats([](FloatTextureId last) {
                return FloatTexture(MixTexture<FloatInput>{last, last, last});
              }),
              each);
    EXPECT_EQ(floats([](FloatTextureId last) {
                return FloatTexture(BilerpTexture<FloatInput>{last, last, last, last, {}});
              }),
              each);
    EXPECT_EQ(
        floats([](FloatTextureId last) {
          return FloatTexture(DirectionMixTexture<FloatInput>{last, last, Vec3f(0.6F, 0, 0.8F)});
        }),
        each);
    EXPECT_EQ(colors([](SpectrumTextureId last) {
                return SpectrumTexture(MixTexture<SpectrumInput>{last, last, 0.25F});
              }),
              each);
    EXPECT_EQ(colors([](SpectrumTextureId last) {
                return SpectrumTexture(BilerpTexture<SpectrumInput>{last, last, last, last, {}});
              }),
              each);
  }
}

}  // namespace
}  // namespace freepath::testing
