// Scenes made for another renderer, against its pictures: the means of the channels, and those of
// blocks of 16x16 pixels.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;

/// A scene, and samples of each pixel that make the error of its mean some 0.1 %.
struct Reference {
  const char* name;
  uint32_t samples;
};

// NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Reference& reference, std::ostream* out) { *out << reference.name; }

constexpr double kLargestDifference = 5e-3;
constexpr int kBlock = 16;

fs::path bench_folder() { return fs::path(FREEPATH_TEST_DATA).parent_path() / "bench"; }

/// Sums over part of a picture, with the variance of the sum.
struct Sum {
  double value = 0;
  double variance = 0;

  double z_against(const Sum& other) const {
    return std::abs(value - other.value) / std::sqrt(variance + other.variance + 1e-30);
  }
};

class Pictures {
 public:
  explicit Pictures(const Reference& reference) {
    const fs::path folder = bench_folder();
    for (const char* seed : {"1", "2"}) {
      references_.push_back(read_image(
          (folder / "reference" / (std::string(reference.name) + "_seed" + seed + ".exr"))
              .string()));
    }
    Diagnostics diagnostics;
    const BuiltScene built =
        load_scene(folder / "scenes" / (std::string(reference.name) + ".pbrt"), diagnostics);
    warnings_ = diagnostics.warnings();
    const testing::PictureOptions options{.mode = ColorMode::kSpectral,
                                          .samples = reference.samples};
    mine_ = testing::picture_of(built, options).image;
  }

  int width() const { return mine_.width; }
  int height() const { return mine_.height; }
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// A channel over part of the picture: of mine, and of the mean of the references, whose variance
  /// follows from their difference.
  void sum(int channel, int left, int top, int right, int bottom, Sum& mine, Sum& theirs) const {
    const char* const names[] = {"R", "G", "B"};
    const int own = *find_channel(mine_, names[channel]);
    const int variance = *find_channel(mine_, std::string("variance.") + names[channel]);
    const int first = *find_channel(references_[0], names[channel]);
    const int second = *find_channel(references_[1], names[channel]);
    for (int row = top; row < std::min(bottom, height()); ++row) {
      for (int column = left; column < std::min(right, width()); ++column) {
        const double a = references_[0].pixel(column, row)[first];
        const double b = references_[1].pixel(column, row)[second];
        mine.value += mine_.pixel(column, row)[own];
        mine.variance += mine_.pixel(column, row)[variance];
        theirs.value += (a + b) / 2;
        theirs.variance += (a - b) * (a - b) / 4;
      }
    }
  }

 private:
  std::vector<Image> references_;
  Image mine_;
  std::vector<std::string> warnings_;
};

class ReferenceScene : public ::testing::TestWithParam<Reference> {};

TEST_P(ReferenceScene, LooksAsTheOtherRendererShowsIt) {
  if (!fs::exists(bench_folder())) GTEST_SKIP() << "no reference scenes in " << bench_folder();
  const Pictures pictures(GetParam());
  EXPECT_TRUE(pictures.warnings().empty()) << pictures.warnings().front();
  int blocks = 0;
  int strays = 0;
  for (int c = 0; c < 3; ++c) {
    Sum mine;
    Sum theirs;
    pictures.sum(c, 0, 0, pictures.width(), pictures.height(), mine, theirs);
    const double noise = 4 * std::sqrt(mine.variance + theirs.variance) / theirs.value;
    EXPECT_NEAR(mine.value / theirs.value, 1, kLargestDifference + noise) << "channel " << c;
    EXPECT_LT(noise, 0.015) << "too few samples to tell, channel " << c;
    for (int top = 0; top < pictures.height(); top += kBlock) {
      for (int left = 0; left < pictures.width(); left += kBlock) {
        Sum block;
        Sum expected;
        pictures.sum(c, left, top, left + kBlock, top + kBlock, block, expected);
        ++blocks;
        if (block.z_against(expected) > 4) ++strays;
      }
    }
  }
  EXPECT_LE(strays, blocks / 100) << "blocks beyond 4 standard errors, of " << blocks;
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceScene,
                         ::testing::Values(Reference{"wdas_sun", 32}, Reference{"wdas_env", 32},
                                           Reference{"wdas_chroma", 24},
                                           Reference{"smoke_floor", 64}, Reference{"fireball", 96},
                                           Reference{"fog_spot", 768}, Reference{"glass_jar", 48},
                                           Reference{"rgbgrid", 96}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace freepath
