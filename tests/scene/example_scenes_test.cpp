// The scenes that come with the project are rendered without a word.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

std::vector<std::string> example_scenes() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(FREEPATH_SCENES)) {
    if (entry.path().extension() == ".pbrt") files.push_back(entry.path().stem().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class ExampleScene : public ::testing::TestWithParam<std::string> {};

TEST_P(ExampleScene, IsRenderedWithoutAWord) {
  const std::filesystem::path file =
      std::filesystem::path(FREEPATH_SCENES) / (GetParam() + ".pbrt");
  EXPECT_LT(std::filesystem::file_size(file), 4096U);
  Diagnostics diagnostics;
  const BuiltScene built = load_scene(file, diagnostics, {.size = FilmSize{24, 24}});
  EXPECT_EQ(built.picture.file_name, GetParam() + ".exr");
  for (const ColorMode mode : kColorModes) {
    Picture picture = picture_of(built, {.mode = mode, .samples = 8});
    picture.warnings = diagnostics.warnings();
    expect_sound(picture);
    for (const float value : picture.image.values) ASSERT_TRUE(std::isfinite(value));
    for (const double mean : picture.mean) EXPECT_GT(mean, 0) << name_of(mode);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ExampleScene, ::testing::ValuesIn(example_scenes()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace freepath::testing
