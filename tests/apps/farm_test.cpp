// The recipes of examples/farm, run as plain processes.

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "freepath/io/image.h"
#include "freepath/paths/film_file.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class FarmTest : public ProgramTest {
 protected:
  FarmTest() {
    write_cube(path("ball.vdb"));
    fs::create_directory(path("bin"));
    fs::create_symlink(FREEPATH_PROGRAM, path("bin/freepath"));
    const Outcome outcome = recipe("freepath render ball.vdb --size 24x18 --spp 13 -o whole.exr");
    EXPECT_EQ(outcome.status, 0) << outcome;
  }

  /// Runs a line with the program on the PATH and the recipes in $farm.
  Outcome recipe(const std::string& line) const {
    return shell(
        "unset -f freepath; unalias freepath 2>/dev/null; export PATH=$PWD/bin:$PATH; farm=" +
        std::string(FREEPATH_FARM_EXAMPLES) + "; " + line);
  }

  void expect_whole(const std::string& picture) const {
    ASSERT_TRUE(fs::exists(path(picture)));
    EXPECT_EQ(read_image(path(picture)).values, read_image(path("whole.exr")).values) << picture;
  }
};

TEST_F(FarmTest, TasksOfAnArrayBecomeOnePicture) {
  const std::string task =
      "SLURM_ARRAY_TASK_MIN=3 SLURM_ARRAY_TASK_COUNT=4 SLURM_CPUS_PER_TASK=1 SLURM_ARRAY_TASK_ID=";
  const std::string script = " $farm/slurm_array.sh ball.vdb a.exr 13 --size 24x18";
  for (const char* number : {"5", "3", "6"}) {
    const Outcome outcome = recipe(fmt::format("{}{}{}", task, number, script));
    EXPECT_EQ(outcome.status, 0) << outcome;
    EXPECT_FALSE(fs::exists(path("a.exr")));
  }
  // A task that is started again has nothing to do.
  EXPECT_EQ(recipe(task + "5" + script).status, 0);
  const Outcome last = recipe(task + "4" + script);
  EXPECT_EQ(last.status, 0) << last;
  expect_whole("a.exr");
}

TEST_F(FarmTest, APreemptedTaskGoesOn) {
  const std::string task =
      "export SLURM_ARRAY_TASK_COUNT=1 SLURM_CPUS_PER_TASK=1 SLURM_ARRAY_TASK_ID=0; ";
  const auto script = [](uint32_t samples) {
    return fmt::format("$farm/slurm_array.sh ball.vdb b.exr {} --size 24x18 --every 0.05", samples);
  };
  // More than anybody waits for. As Slurm does, all of the task's processes are told to end.
  const Outcome preempted = recipe(
      task + "setsid " + script(100'000'000) +
      " & p=$!; while [ ! -e b.parts/0.checkpoint.film ]; do sleep 0.05; done; kill -TERM -- -$p; "
      "while kill -0 -- -$p 2>/dev/null; do sleep 0.05; done");
  EXPECT_NE(preempted.messages.find("interrupted after"), std::string::npos) << preempted;
  EXPECT_FALSE(fs::exists(path("b.parts/0.film")));
  const uint32_t samples = read_film_header(path("b.parts/0.checkpoint.film")).samples.most + 20;
  const Outcome again = recipe(task + script(samples));
  EXPECT_EQ(again.status, 0) << again;
  EXPECT_NE(again.messages.find("goes on from"), std::string::npos) << again;
  const Outcome whole =
      recipe(fmt::format("freepath render ball.vdb --size 24x18 --spp {} -o all.exr", samples));
  ASSERT_EQ(whole.status, 0) << whole;
  EXPECT_EQ(read_image(path("b.exr")).values, read_image(path("all.exr")).values);
}

TEST_F(FarmTest, FramesMayBeStartedAgain) {
  fs::copy(path("ball.vdb"), path("s.01.vdb"));
  fs::copy(path("ball.vdb"), path("s.02.vdb"));
  const std::string line = "$farm/frames.sh 1-2 's.%02d.vdb' 'p.%02d.exr' --size 8x6 --spp 2";
  ASSERT_EQ(recipe(line).status, 0);
  fs::remove(path("p.02.exr"));
  const Outcome again = recipe(line);
  EXPECT_EQ(again.status, 0) << again;
  EXPECT_NE(again.messages.find("frame 1 (1 of 2): is there already"), std::string::npos) << again;
  EXPECT_TRUE(fs::exists(path("p.02.exr")));
}

TEST_F(FarmTest, TilesSideBySideBecomeOnePicture) {
  const Outcome outcome = recipe("$farm/parallel_tiles.sh ball.vdb c.exr 5 --size 24x18 --spp 13");
  EXPECT_EQ(outcome.status, 0) << outcome;
  expect_whole("c.exr");
  const Outcome failed = recipe("$farm/parallel_tiles.sh none.vdb d.exr 5 --size 24x18 --spp 13");
  EXPECT_NE(failed.status, 0) << failed;
  EXPECT_FALSE(fs::exists(path("d.exr")));
}

}  // namespace
}  // namespace freepath::testing
