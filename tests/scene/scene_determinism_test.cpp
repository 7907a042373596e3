// A picture depends on its scene, seed and samples, not on how the work is divided.

#include <gtest/gtest.h>

#include <string>

#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

/// Media that are clear and others that are not, grey and with a colour; instances; lights that are
/// shapes; glass that takes a hero.
std::string crowded() {
  return stage(
      R"(MakeNamedMedium "grid" "string type" "uniformgrid" "rgb sigma_a" [ .2 .2 .2 ] )"
      R"("rgb sigma_s" [ 2 2 2 ] "point3 p0" [ -.5 -.5 -.5 ] "point3 p1" [ .5 .5 .5 ] )"
      "\"integer nx\" 3 \"float density\" [ 1 0 2 ]\n"
      R"(MakeNamedMedium "juice" "string type" "homogeneous" "string preset" "Apple Juice" )"
      "\"float scale\" 100\n" +
          medium_box("grid", Vec3d(-0.9), Vec3d(0.9)) + R"(
      ObjectBegin "glass"
        Material "dielectric" "spectrum eta" "glass-BK7" MediumInterface "juice" ""
        Shape "sphere" "float radius" 0.4
      ObjectEnd
      AttributeBegin Translate 1.2 -0.5 -1.5 ObjectInstance "glass" AttributeEnd
      AttributeBegin Translate -1.1 -1 -1.6 ObjectInstance "glass" AttributeEnd
      AttributeBegin
        Translate 1.3 0.6 -1 Material "coateddiffuse" "float roughness" 0.1
        AreaLightSource "diffuse" "rgb L" [ 3 2 1 ]
        Shape "sphere" "float radius" 0.2
      AttributeEnd)",
      "Integrator \"volpath\" \"integer maxdepth\" 30\n", 50);
}

TEST(SceneDeterminism, ThreadsAndBatchesDoNotMatter) {
  const std::string scene = crowded();
  for (const ColorMode mode : kColorModes) {
    PictureOptions options{.mode = mode, .samples = 5, .threads = 1};
    const Picture first = render_text(scene, options);
    expect_sound(first);
    const std::vector<float>& reference = first.image.values;
    for (const int threads : {1, 2}) {
      for (const std::size_t batch : {64, 2048}) {
        options.threads = threads;
        options.batch = batch;
        EXPECT_EQ(render_text(scene, options).image.values, reference)
            << name_of(mode) << ", " << threads << " threads, batch " << batch;
      }
    }
    options.seed = 6;
    EXPECT_NE(render_text(scene, options).image.values, reference) << name_of(mode);
  }
}

}  // namespace
}  // namespace freepath::testing
