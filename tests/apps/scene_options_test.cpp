// Options that change or add to what the file of a scene says.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {
namespace {

constexpr const char* kFogGrid = R"(Film "rgb" "integer xresolution" 12 "integer yresolution" 8
Integrator "volpath" "integer maxdepth" 20
PixelFilter "box"
LookAt 0 0 6  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
MakeNamedMedium "fog" "string type" "uniformgrid" "integer nx" 1 "integer ny" 1 "integer nz" 1
  "point3 p0" [ -1 -1 -1 ] "point3 p1" [ 1 1 1 ] "float density" [ 1 ]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Shape "sphere" "float radius" 2
AttributeEnd
)";

class SceneOptionsTest : public ProgramTest {
 protected:
  void SetUp() override { write_text(path("fog.pbrt"), kFogGrid); }

  Outcome render(const std::string& options) const {
    return run("render fog.pbrt --spp 1 -o picture.exr " + options);
  }
  void expect_refused(const std::string& options, const std::string& message) const {
    const Outcome outcome = render(options);
    EXPECT_NE(outcome.status, 0) << options;
    EXPECT_NE(outcome.messages.find(message), std::string::npos) << options << '\n' << outcome;
    EXPECT_FALSE(std::filesystem::exists(path("picture.exr")));
  }
};

TEST_F(SceneOptionsTest, ThatWouldChangeNothingAreRefused) {
  expect_refused("--turbidity 3", "give one of them for a scene");
  expect_refused("--up z", "give one of their options for a scene");
  expect_refused("--frames 1-2", "is for volumes");
  expect_refused("--camera fisheye", "--camera");
  expect_refused("--look-at 1,2", "--look-at");
  expect_refused("--fov 0", "angle of view");
  expect_refused("--sigma-a 1 --sigma-a 2", "--sigma-a");
  expect_refused("--g 0.5 --phase rayleigh", "say the same thing twice");
  for (const char* used :
       {"--turbidity 3 --sun 20,0", "--up z --ground 0.5", "--up z --turbidity 3 --environment sky",
        "--up z --camera spherical", "--look-at 0.5,0.5,-3 --fov 30"}) {
    EXPECT_EQ(render(used).status, 0) << used;
  }
}

// The sky of such a sun can't be made, and is not asked for.
TEST_F(SceneOptionsTest, TheSunAloneMayStandBelowTheHorizon) {
  EXPECT_EQ(render("--sun -10,0").status, 0);
  std::filesystem::remove(path("picture.exr"));
  expect_refused("--sun -10,0 --environment sky", "horizon");
}

TEST_F(SceneOptionsTest, AGroundNeedsAHeightWhereNothingHasABottom) {
  write_text(path("fog.pbrt"),
             "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
             "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n");
  expect_refused("--ground 0.5", "give its height");
  EXPECT_EQ(render("--ground 0.5,-1").status, 0);
}

// A picture depends on the files that options name as on those of the scene.
TEST_F(SceneOptionsTest, AReferenceIsFoundAgainWhileTheirFilesAreTheSame) {
  const auto origin = [&] {
    const Outcome outcome =
        run("compare fog.pbrt -o report --trackers delta --spp 4 --repeats 2 --reference-spp 8 "
            "--cache kept --environment sky.exr --phase tabulated:table.txt");
    EXPECT_EQ(outcome.status, 0) << outcome;
    std::ifstream file(path("report/compare.json"));
    const auto json = nlohmann::json::parse(file);
    return json["references"][0]["origin"].get<std::string>().substr(0, 5);
  };
  write_environment(path("sky.exr"), 1, 2);
  write_text(path("table.txt"), "0 1\n180 1\n");
  EXPECT_EQ(origin(), "made ");
  EXPECT_EQ(origin(), "found");
  write_environment(path("sky.exr"), 1, 3);
  EXPECT_EQ(origin(), "made ");
  write_text(path("table.txt"), "0 2\n180 1\n");
  EXPECT_EQ(origin(), "made ");
}

}  // namespace
}  // namespace freepath::testing
