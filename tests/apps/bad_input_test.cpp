// What the program says to wrong input: one line that names the culprit, no picture, no crash.

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"
#include "tests/io/volume_files.h"

namespace freepath::testing {
namespace {

class BadInputTest : public ProgramTest {
 protected:
  BadInputTest() { write_cube(path("ball.vdb")); }

  /// Runs a command that must fail, with one line that has each of `parts` in it, and no new file.
  void expect_error(const std::string& line, const std::vector<std::string>& parts) const {
    expect_error(words(line), line, parts);
  }

  void expect_error(const std::vector<std::string>& arguments, const std::string& name,
                    const std::vector<std::string>& parts) const {
    const std::vector<std::string> before = files();
    const Outcome outcome =
        as_process_ ? start_program(arguments, folder_) : call_program(arguments, folder_);
    SCOPED_TRACE(name);
    EXPECT_FALSE(outcome.timed_out) << outcome;
    EXPECT_EQ(outcome.signal, 0) << outcome;
    EXPECT_GT(outcome.status, 0) << outcome;
    EXPECT_EQ(outcome.output, "") << outcome;
    EXPECT_EQ(outcome.messages.rfind("freepath: error: ", 0), 0U) << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.messages.find(part), std::string::npos) << "no " << part << ": " << outcome;
    }
    EXPECT_EQ(files(), before);
  }

  bool as_process_ = false;

  void expect_render_error(const std::string& options,
                           const std::vector<std::string>& parts) const {
    expect_error("render ball.vdb -o picture.exr --size 8x8 --spp 1 " + options, parts);
  }
};

TEST_F(BadInputTest, TheCommandLineItself) {
  as_process_ = true;
  expect_error("", {"subcommand"});
  expect_error("paint ball.vdb", {"paint"});
  expect_error("render", {"volume"});
  expect_error("render ball.vdb", {"--output"});
  expect_render_error("--colour red", {"--colour"});
  expect_render_error("--seed 1 --seed 2", {"--seed"});
}

TEST_F(BadInputTest, NamesThatAreNearAreSuggested) {
  expect_error("rendr ball.vdb", {"there is no command 'rendr'", "did you mean 'render'"});
  expect_render_error("--sp 4", {"there is no option '--sp'", "did you mean '--spp'"});
  expect_render_error("--albdo=0.5", {"'--albdo'", "did you mean '--albedo'"});
  expect_error("slab --tua 1", {"'--tua'", "did you mean '--tau'"});
  expect_render_error("--quux 1 2", {"there is no option '--quux'"});
  expect_error("trackers extra", {"'extra' is not expected"});
  expect_render_error("--tracker autto", {"autto", "auto"});
  expect_render_error("--tracker nothing-like-it", {"auto"});
}

TEST_F(BadInputTest, NumbersThatAreNone) {
  const auto try_values = [&](const std::vector<std::string>& options,
                              const std::vector<std::string>& values) {
    for (const std::string& option : options) {
      for (const std::string& value : values) {
        std::vector<std::string> arguments = words("render ball.vdb -o picture.exr --size 8x8");
        arguments.push_back(option);
        arguments.push_back(value);
        expect_error(arguments, ::testing::PrintToString(arguments), {option});
      }
    }
  };
  try_values({"--density-scale", "--g", "--fov", "--exposure", "--turbidity", "--time", "--albedo",
              "--sigma-a", "--sigma-s", "--le"},
             {"nan", "", "1,2", "inf", "ten", "1e999", "-inf"});
  try_values({"--seed", "--spp", "--threads"}, {"-1", "1.5", "", "99999999999999999999999"});
}

TEST_F(BadInputTest, NumbersOutOfRange) {
  expect_render_error("--density-scale -1", {"density scale", "negative"});
  expect_render_error("--density-scale 1e39", {"density scale"});
  expect_render_error("--albedo 1.5", {"albedo", "1.5"});
  expect_render_error("--albedo 0.5,0.5,2", {"albedo", "2"});
  expect_render_error("--albedo 0.5 --sigma-s 1", {"--albedo", "--sigma-s"});
  expect_render_error("--sigma-s 1,-1,1", {"sigma_s"});
  expect_render_error("--sigma-s 1,2,3,4", {"--sigma-s", "4 values"});
  expect_render_error("--sigma-s 3e38 --sigma-a 3e38", {"sigma_a + sigma_s"});
  expect_render_error("--sigma-a 1e20 --le 1e20", {"sigma_a · emission"});
  expect_render_error("--le -1", {"emission"});
  expect_render_error("--g 1", {"g", "1"});
  expect_render_error("--fov 0", {"angle of view"});
  expect_render_error("--super-voxel 5", {"super-voxel"});
  expect_render_error("--threads 0", {"--threads"});
  expect_render_error("--time 0", {"--time"});
  expect_render_error("--turbidity 100", {"turbidity"});
  expect_render_error("--sun -5,0", {"sun", "-5"});
  expect_render_error("--environment 1,2", {"--environment"});
  expect_error("render ball.vdb -o picture.exr --spp 0", {"--spp"});
}

TEST_F(BadInputTest, SizesThatAreNone) {
  for (const char* size : {"0x0", "10x", "10x10x10", "99999x1"}) {
    expect_error(std::string("render ball.vdb -o picture.exr --spp 1 --size ") + size, {"--size"});
  }
}

TEST_F(BadInputTest, ChoicesThatThereAreNot) {
  expect_render_error("--tracker magic", {"--tracker", "magic", "weighted-delta"});
  expect_render_error("--tracker delta:speed=2", {"delta", "speed"});
  expect_render_error("--tracker weighted-delta:rate-scale", {"rate-scale", "value"});
  expect_render_error("--tracker weighted-delta:rate-scale=nan", {"rate-scale", "nan"});
  expect_render_error("--transmittance magic", {"--transmittance", "magic", "ratio"});
  expect_render_error("--interpolation cubic", {"--interpolation", "trilinear"});
  expect_render_error("--emission some", {"--emission", "collision"});
  expect_render_error("--up x", {"--up", "y, z"});
  expect_render_error("--negative keep", {"--negative", "clamp"});
  expect_render_error("--simd mmx", {"mmx", "avx2"});
}

TEST_F(BadInputTest, ViewsThatAreNone) {
  expect_render_error("--look-at 1,2", {"--look-at"});
  expect_render_error("--look-at 1,2,3,1,2,3", {"camera"});
  expect_render_error("--look-at 1e300,0,0", {"camera", "position", "1e+300"});
  expect_render_error("--look-at 1,2,3,0,-1e31,0", {"camera", "target", "-1e+31"});
}

TEST_F(BadInputTest, VolumesThatAreNone) {
  std::filesystem::create_directory(path("folder"));
  write_text(path("garbage.vdb"), "this is no volume, whatever its name may say; not at all");
  write_text(path("empty.vdb"), "");
  const std::string rest = " -o picture.exr --size 8x8 --spp 1";
  for (const char* name : {"missing.vdb", "folder", "garbage.vdb", "empty.vdb"}) {
    expect_error(std::string("render ") + name + rest, {name});
  }
  expect_error("info --json garbage.vdb", {"garbage.vdb"});
  for (const double part : {0.1, 0.999}) {
    write_cube(path("cut.vdb"));
    truncate_file(path("cut.vdb"), part);
    expect_error("render cut.vdb" + rest, {"cut.vdb"});
  }
}

TEST_F(BadInputTest, GridsThatThereAreNot) {
  expect_render_error("--grid smoke", {"smoke", "density"});
  expect_render_error("--grid 3", {"3", "density"});
}

TEST_F(BadInputTest, DensitiesThatAreNone) {
  const auto with = [](float odd) {
    return [odd](const Vec3i& p) { return p == Vec3i(1, -2, 3) ? odd : ball(p); };
  };
  const std::string rest = " -o picture.exr --size 8x8 --spp 1";
  const std::vector<std::pair<const char*, float>> cases = {
      {"nan.vdb", std::numeric_limits<float>::quiet_NaN()},
      {"inf.vdb", std::numeric_limits<float>::infinity()},
      {"negative.vdb", -0.5F}};
  for (const auto& [name, value] : cases) {
    write_cube(path(name), with(value));
    expect_error(std::string("render ") + name + " --invalid error" + rest,
                 {name, "density", "1, -2, 3"});
  }
  const Outcome mended = run("render nan.vdb" + rest);
  EXPECT_EQ(mended.status, 0) << mended;
  EXPECT_NE(
      mended.messages.find("freepath: warning: nan.vdb: grid \"density\": 1 value that is NaN"),
      std::string::npos)
      << mended;
  EXPECT_NE(mended.messages.find("the first: voxel (1, -2, 3) is NaN"), std::string::npos)
      << mended;
  const Outcome clamped = run("render negative.vdb --negative clamp" + rest);
  EXPECT_EQ(clamped.status, 0) << clamped;
  EXPECT_NE(clamped.messages.find("freepath: warning: "), std::string::npos) << clamped;
}

TEST_F(BadInputTest, InfoOfAFileWhoseSecondGridCannotBeLoaded) {
  testing_volumes::TestGrid small;
  small.name = "small";
  small.voxels = {{Vec3i(0), 1}};
  testing_volumes::TestGrid vast = small;
  vast.name = "vast";
  vast.tiles = {{Vec3i(4096, 0, -4096), 4096, 0.5}};  // a tile of the root
  testing_volumes::write_vdb_file(path("two.vdb"), {small, vast});
  for (const char* command : {"info two.vdb", "info two.vdb --json"}) {
    const Outcome info = run(command);
    EXPECT_EQ(info.status, 0) << info;
    for (const char* part : {"small", "vast", "the active voxels span"}) {
      EXPECT_NE(info.output.find(part), std::string::npos) << part << info;
    }
  }
  EXPECT_EQ(run("info two.vdb --grid small").status, 0);
  expect_error("render two.vdb --grid vast -o picture.exr", {"two.vdb", "vast", "crop"});
}

TEST_F(BadInputTest, EnvironmentsThatAreNone) {
  write_text(path("text.hdr"), "no picture at all");
  write_environment(path("nan.exr"), 1, std::numeric_limits<float>::quiet_NaN());
  write_environment(path("inf.exr"), 1, std::numeric_limits<float>::infinity());
  write_environment(path("negative.exr"), 1, -1);
  expect_render_error("--environment missing.hdr", {"missing.hdr"});
  expect_render_error("--environment text.hdr", {"text.hdr"});
  for (const char* name : {"nan.exr", "inf.exr", "negative.exr"}) {
    expect_render_error(std::string("--invalid error --environment ") + name, {name, "5", "3"});
  }
  const Outcome mended =
      run("render ball.vdb --environment nan.exr -o picture.exr --size 8x8 --spp 1");
  EXPECT_EQ(mended.status, 0) << mended;
  EXPECT_NE(mended.messages.find("nan.exr: 1 pixel with values that are NaN or infinite was taken "
                                 "as 0; the first: pixel (5, 3) is NaN"),
            std::string::npos)
      << mended;
}

TEST_F(BadInputTest, OutputsThatCannotBe) {
  std::filesystem::create_directory(path("folder.exr"));
  const std::string render = "render ball.vdb --size 8x8 --spp 1 -o ";
  expect_error(render + "missing/picture.exr", {"missing"});
  expect_error(render + "picture.gif", {"picture.gif", ".exr"});
  expect_error(render + "picture", {"picture", ".exr"});
  expect_error(render + "folder.exr", {"folder.exr"});
  expect_error(render + "picture.exr -o missing/picture.png", {"missing"});
  expect_error(render + "picture.exr --stats missing/stats.json", {"missing/stats.json"});
  expect_error(render + "picture.exr --stats folder.exr", {"folder.exr"});
  expect_error(render + "picture.exr --stats picture.exr", {"picture.exr", "--stats"});
  expect_error(render + "picture.exr --stats ball.vdb", {"ball.vdb", "--stats"});
}

TEST_F(BadInputTest, VolumesThatCannotBeGenerated) {
  expect_error("generate tree -o tree.vdb", {"tree", "cloud"});
  expect_error("generate cloud", {"--output"});
  expect_error("generate cloud -o picture.exr", {"picture.exr", ".vdb"});
  // A volume that would take hours: the error comes first.
  expect_error("generate cloud -o missing/cloud.vdb --resolution 2048", {"missing"});
  std::filesystem::create_directory(path("folder.vdb"));
  expect_error("generate cloud -o folder.vdb --resolution 2048", {"folder.vdb", "directory"});
  expect_error("generate cloud -o cloud.vdb --resolution 0", {"resolution", "16"});
  expect_error("generate cloud -o cloud.vdb --seed -1", {"--seed", "-1"});
}

TEST_F(BadInputTest, SlabsThatAreNone) {
  expect_error("slab --tau -1", {"tau", "-1"});
  expect_error("slab --tau nan", {"--tau"});
  expect_error("slab --tau 1e30", {"tau"});
  expect_error("slab --tau 1,inf,2", {"--tau", "1,inf,2", "only the last layer"});
  expect_error("slab --tau inf,", {"--tau", "only the last layer"});
  expect_error("slab --tau 1,,2", {"--tau", "''"});
  expect_error("slab --tau inf --albedo 1", {"half-space", "albedo"});
  expect_error("slab --tau 1,2 --albedo 0.1,0.2,0.3", {"--albedo", "3 values"});
  expect_error("slab", {"--tau", "--thickness"});
  expect_error("slab --tau 1 --mua 1", {"--tau", "--mua"});
  expect_error("slab --mua 1 --mus 1", {"--thickness", "all three"});
  expect_error("slab --mua 1 --mus 1 --thickness 1 --albedo 1", {"--albedo"});
  expect_error("slab --mua 0 --mus 0 --thickness 1", {"layer 1", "--mua 0"});
  expect_error("slab --mua 1 --mus 1 --thickness -2", {"--thickness", "-2"});
  expect_error("slab --tau 1,2 --phase rayleigh --phase rayleigh --phase rayleigh",
               {"--phase", "3 times"});
  expect_error("slab --tau 1 --phase ralyeigh", {"--phase", "ralyeigh"});
}

TEST_F(BadInputTest, OldPicturesSurviveAnError) {
  write_text(path("picture.exr"), "old");
  expect_render_error("--grid smoke", {"smoke"});
  EXPECT_EQ(std::filesystem::file_size(path("picture.exr")), 3U);
}

}  // namespace
}  // namespace freepath::testing
