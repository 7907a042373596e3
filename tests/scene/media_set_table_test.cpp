// Media around a ray by number, against the sets themselves.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "freepath/paths/media_set_table.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

// More crossings than are remembered at once, so that they drive each other out.
TEST(MediaSetTable, AreWhatTheSetsSay) {
  constexpr int kMedia = 5;
  constexpr int kShapes = 700;
  std::mt19937 random(3);
  const auto any = [&](int count) { return static_cast<int>(random() % count); };
  std::string text = kUnlimited + film() + "Camera \"perspective\"\nWorldBegin\n";
  for (int medium = 0; medium < kMedia; ++medium) {
    text += "MakeNamedMedium \"m" + std::to_string(medium) + R"(" "string type" "homogeneous" )";
  }
  const auto name = [&](int medium) {
    return medium == kMedia ? std::string() : "m" + std::to_string(medium);
  };
  for (int shape = 0; shape < kShapes; ++shape) {
    text += R"(AttributeBegin Material "interface" MediumInterface ")" + name(any(kMedia)) +
            R"(" ")" + name(any(kMedia + 1)) + R"(" Translate )" + std::to_string(3 * shape) +
            R"( 0 9 Shape "sphere" AttributeEnd )";
  }
  Diagnostics diagnostics;
  const BuiltScene built = build_scene(parse(text, diagnostics), diagnostics);
  const PathScene& scene = built.scene;
  ASSERT_EQ(scene.shapes.size(), kShapes);
  const WavelengthSampler factory(scene, ColorMode::kRgb, 4, {});
  MediaSetTable table(scene, factory);
  std::vector<MediaSet> sets(8);
  std::vector<MediaSetId> numbers(sets.size(), table.of(MediaSet()));
  for (int step = 0; step < 20'000; ++step) {
    const auto ray = static_cast<std::size_t>(any(static_cast<int>(sets.size())));
    const auto shape = static_cast<uint32_t>(any(kShapes));
    const bool enters = any(2) == 0;
    scene.shapes[shape].cross(sets[ray], enters);
    numbers[ray] = table.cross(numbers[ray], shape, enters);
    ASSERT_EQ(numbers[ray], table.of(sets[ray])) << step;
    ASSERT_EQ(table.medium(numbers[ray]), factory.medium_of(sets[ray])) << step;
    // Sets grow where rays enter without leaving: begin anew now and then, as paths do.
    if (any(16) == 0) {
      sets[ray] = MediaSet();
      numbers[ray] = table.of(MediaSet());
    }
  }
}

}  // namespace
}  // namespace freepath::testing
