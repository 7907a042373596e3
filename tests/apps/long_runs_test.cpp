// Runs that are stopped and gone on with, that reach a noise or an error, and what they tell.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/freepath/console.h"
#include "freepath/base/random.h"
#include "freepath/io/image.h"
#include "tests/apps/films.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class LongRunsTest : public FilmsTest {};

TEST_F(LongRunsTest, GoesOnFromAFilm) {
  const std::string render = "render ball.vdb --size 24x18 ";
  expect_done(render + "--spp 11 -o whole.exr");
  expect_done(render + "--spp 3 -o some.exr --checkpoint a.film");
  const Outcome more = run(render + "--spp 11 --threads 1 --resume a.film -o more.exr");
  EXPECT_EQ(more.status, 0) << more;
  EXPECT_NE(more.messages.find("goes on from 3 samples per pixel"), std::string::npos) << more;
  expect_same_pixels("more.exr", "whole.exr");
  expect_done(render + "--spp 3 --resume a.film -o same.exr");
  expect_same_pixels("same.exr", "some.exr");
  expect_refused(render + "--spp 2 --resume a.film -o b.exr",
                 "has 3 samples of a pixel already, and 2 are asked for");
  expect_refused(render + "--spp 9 --g 0.1 --resume a.film -o b.exr", "--g is not given");
  expect_refused(render + "--spp 9 --crop 0,0,2,2 --resume a.film -o b.exr", "24x18 pixels");
  expect_refused(render + "--spp 9 --layers all --resume a.film -o b.exr", "its layers are");
  // The first run of a job that may be repeated.
  expect_done(render + "--spp 11 --checkpoint c.film --resume c.film -o first.exr");
  expect_same_pixels("first.exr", "whole.exr");
}

// Killed at any moment, and gone on with: the same bits, and no torn file.
TEST_F(LongRunsTest, KilledRendersGoOn) {
  // The program itself, and no function of the shell: it is what the signal has to end.
  const std::string render =
      FREEPATH_PROGRAM " render ball.vdb --size 48x36 --spp 3000 --albedo 1 ";
  ASSERT_EQ(shell(render + "-o whole.exr").status, 0);
  RandomStream random(23, 0, 0, 0);
  constexpr int kKilled = 128 + SIGKILL;
  const int wanted = trials(10);
  int kills = 0;
  for (int i = 0; i < 20 * wanted && kills < wanted; ++i) {
    // At any moment after there is a checkpoint, its own or one of those before.
    const Outcome outcome = shell(fmt::format(
        "{}-o a.exr --checkpoint a.film --resume a.film --every 0.02 & p=$!; "
        "while [ ! -e a.film ] && kill -0 $p 2>/dev/null; do sleep 0.01; done; sleep {:.3f}; "
        "kill -KILL $p 2>/dev/null; wait $p; exit $?",
        render, 0.4 * random.uniform()));
    if (outcome.status == 0) {
      expect_same_pixels("a.exr", "whole.exr");
      if (HasFatalFailure()) return;
      fs::remove(path("a.film"));
      fs::remove(path("a.exr"));
      continue;
    }
    ASSERT_EQ(outcome.status, kKilled) << outcome;
    ++kills;
    const Outcome merged = run("merge a.film --partial -o m.exr");
    ASSERT_EQ(merged.status, 0) << merged;
    // What stands under the final name is whole, even where it was killed on its way out.
    if (fs::exists(path("a.exr"))) expect_same_pixels("a.exr", "whole.exr");
    fs::remove(path("a.exr"));
  }
  ASSERT_EQ(kills, wanted);
  const bool has_checkpoint = fs::exists(path("a.film"));
  const Outcome last = shell(render + "-o a.exr --checkpoint a.film --resume a.film");
  EXPECT_EQ(last.status, 0) << last;
  EXPECT_EQ(last.messages.find("a.film: goes on from") != std::string::npos, has_checkpoint)
      << last;
  expect_same_pixels("a.exr", "whole.exr");
}

TEST_F(LongRunsTest, ACheckpointThatCannotBeWrittenIsAWarning) {
  fs::create_directory(path("folder"));
  bool is_ended = false;
  const Outcome outcome = start_in_terminal(
      words("render ball.vdb --size 32x32 --spp 1000000000 -o a.exr --checkpoint folder/a.film "
            "--every 0.05"),
      folder_, [&](const std::string& text, int process) {
        if (samples_shown(text) < 2) return;
        if (fs::exists(path("folder/a.film"))) fs::remove_all(path("folder"));
        if (is_ended || text.find("no checkpoint: ") == std::string::npos) return;
        is_ended = true;
        kill(process, SIGINT);
      });
  EXPECT_EQ(outcome.status, program::kPartialStatus) << outcome;
  EXPECT_NE(outcome.messages.find("rendering goes on"), std::string::npos) << outcome;
  EXPECT_TRUE(fs::exists(path("a.partial.exr")));
}

TEST_F(LongRunsTest, AFullDiskIsAWarning) {
  const Outcome outcome = shell(
      "ulimit -f 8; freepath render ball.vdb --size 32x24 --spp 4000 --layers none -o a.png "
      "--checkpoint a.film --every 0.05");
  EXPECT_EQ(outcome.status, 0) << outcome;
  EXPECT_NE(outcome.messages.find("no checkpoint: a.film: can't write it"), std::string::npos)
      << outcome;
  EXPECT_TRUE(fs::exists(path("a.png")));
  EXPECT_EQ(files(), (std::vector<std::string>{"a.png", "ball.vdb"}));
}

TEST_F(LongRunsTest, TheNoiseAskedForIsThatOfThePicture) {
  const std::string render = "render ball.vdb --size 24x18 --environment 1 --albedo 0.5 ";
  const Outcome outcome = run(render + "--noise 0.02 -o a.exr --stats a.json");
  ASSERT_EQ(outcome.status, 0) << outcome;
  const Image image = read_image(path("a.exr"));
  double sum = 0;
  double variance = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const float* const pixel = image.pixel(column, row);
      for (const char* channel : {"R", "G", "B"}) {
        sum += pixel[*find_channel(image, channel)];
        variance += pixel[*find_channel(image, std::string("variance.") + channel)];
      }
    }
  }
  const double values = 3.0 * static_cast<double>(image.pixel_count());
  EXPECT_NEAR(std::sqrt(variance / values) / (sum / values), 0.02, 0.001);
  // It is the picture of as many samples, whatever the pilot was.
  std::ifstream statistics(path("a.json"));
  const int samples = nlohmann::json::parse(statistics)["samples"];
  expect_done(render + "--spp " + std::to_string(samples) + " -o b.exr");
  expect_same_pixels("a.exr", "b.exr");
  // --spp limits it.
  const Outcome limited = run(render + "--noise 0.001 --spp 8 -o c.exr");
  EXPECT_EQ(limited.status, 0) << limited;
  EXPECT_NE(limited.messages.find("the most that --spp allows"), std::string::npos) << limited;
}

TEST_F(LongRunsTest, FluxesHaveAnErrorToReach) {
  const Outcome outcome = run("slab --tau 2 --albedo 0.9 --error 0.001 --json");
  ASSERT_EQ(outcome.status, 0) << outcome;
  const auto json = nlohmann::json::parse(outcome.output);
  double largest = 0;
  for (const char* flux : {"reflectance", "transmittance", "absorptance"}) {
    largest = std::max(largest, json[std::string(flux) + "_error"].get<double>());
  }
  EXPECT_LE(largest, 0.001);
  EXPECT_GT(largest, 0.00095);
  expect_refused("slab --tau 2 --error 0.001 --paths 1e5", "--paths and --error");
  expect_refused("slab --tau 2 --error 2", "--error: '2'");
}

TEST_F(LongRunsTest, ProgressIsLinesOfJsonWhereTheyAreAskedFor) {
  const Outcome outcome = run("render ball.vdb --size 32x32 --spp 2000 -o a.exr --progress json");
  ASSERT_EQ(outcome.status, 0) << outcome;
  EXPECT_EQ(outcome.messages.find("{\"progress\":0."), 0U) << outcome;
  const Outcome none = run("render ball.vdb --size 64x64 --spp 300 -o a.exr --progress none");
  EXPECT_EQ(none.messages.find("progress"), std::string::npos) << none;
}

TEST_F(LongRunsTest, FramesHaveSeedsOfTheirOwnAndFailuresAreReported) {
  fs::copy(path("ball.vdb"), path("s.1.vdb"));
  write_text(path("s.2.vdb"), "no volume");
  fs::copy(path("ball.vdb"), path("s.3.vdb"));
  const std::string render = "render s.%d.vdb --size 12x9 --spp 2 --frames 1-3 ";
  const Outcome outcome = run(render + "-o p.%d.exr");
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("1 frame of 3 failed: --frames 2"), std::string::npos) << outcome;
  ASSERT_TRUE(fs::exists(path("p.3.exr")));
  EXPECT_NE(read_image(path("p.1.exr")).values, read_image(path("p.3.exr")).values);
  expect_done("render ball.vdb --size 12x9 --spp 2 --seed 3 -o third.exr");
  expect_same_pixels("third.exr", "p.3.exr");
  fs::copy_file(path("ball.vdb"), path("s.2.vdb"), fs::copy_options::overwrite_existing);
  const auto written = fs::last_write_time(path("p.1.exr"));
  const Outcome again = run(render + "-o p.%d.exr --skip-existing");
  EXPECT_EQ(again.status, 0) << again;
  EXPECT_NE(again.messages.find("frame 1 (1 of 3): is there already"), std::string::npos) << again;
  EXPECT_EQ(fs::last_write_time(path("p.1.exr")), written);
  EXPECT_TRUE(fs::exists(path("p.2.exr")));
  expect_done(render + "-o q.%d.exr --seed-mode same");
  EXPECT_EQ(read_image(path("q.1.exr")).values, read_image(path("q.3.exr")).values);
}

}  // namespace
}  // namespace freepath::testing
