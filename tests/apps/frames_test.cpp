// freepath render --frames: names, numbers, what is checked before the first frame, and the
// pictures of a sequence.

#include "apps/freepath/frames.h"
#include "apps/freepath/console.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"
#include "tests/io/volume_oddities.h"

namespace freepath::testing {
namespace {

using program::format_frames;
using program::FrameName;
using program::parse_frames;
using Names = std::vector<std::string>;

std::vector<int> frames(const std::string& text) { return parse_frames(text, "--frames"); }

TEST(Frames, RangesStepsAndListsAreNumbersInTheirOrder) {
  EXPECT_EQ(frames("7"), (std::vector{7}));
  EXPECT_EQ(frames("0007"), (std::vector{7}));
  EXPECT_EQ(frames("0-3"), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(frames("1-8x3"), (std::vector{1, 4, 7}));
  EXPECT_EQ(frames("9-12,1,5"), (std::vector{9, 10, 11, 12, 1, 5}));
  EXPECT_EQ(frames("999999998-999999999x999999999"), (std::vector{999999998}));
}

TEST(Frames, WhatIsNoneIsNamed) {
  for (const char* text : {"",
                           "a",
                           "-1",
                           "1-",
                           "1--2",
                           "1-2-3",
                           "1,",
                           ",1",
                           "1 2",
                           "1-2x",
                           "1-2x0",
                           "1x2",
                           "1-9x-1",
                           "1.5",
                           "+1",
                           "1000000000",
                           "99999999999999999999",
                           "4-1",
                           "1,1",
                           "1-5,3",
                           "0-999999999"}) {
    try {
      frames(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("--frames: ", 0), 0U) << error.what();
    }
  }
}

TEST(Frames, FewWordsAreReadAsTheSameNumbers) {
  const std::vector<std::pair<std::vector<int>, std::string>> cases = {
      {{}, ""},
      {{7}, "7"},
      {{1, 2, 3}, "1-3"},
      {{1, 3}, "1,3"},
      {{1, 3, 5}, "1-5x2"},
      {{1, 2, 3, 5, 8, 11, 14, 15}, "1-3,5-14x3,15"},
      {{3, 2, 1}, "3,2,1"},
  };
  for (const auto& [numbers, text] : cases) {
    EXPECT_EQ(format_frames(numbers), text);
    if (!text.empty()) {
      EXPECT_EQ(frames(text), numbers);
    }
  }
}

TEST(FrameNames, TheNumberTakesItsPlace) {
  const auto name = [](const char* text) { return FrameName(text).in_frame(42); };
  EXPECT_EQ(name("smoke.%d.vdb"), "smoke.42.vdb");
  EXPECT_EQ(name("%04d"), "0042");
  EXPECT_EQ(name("a%01d"), "a42");
  EXPECT_EQ(name("smoke.####.vdb"), "smoke.0042.vdb");
  EXPECT_EQ(name("##"), "42");
  EXPECT_EQ(name("take#2.vdb"), "take#2.vdb");
  EXPECT_EQ(name("50%%_%d{}.vdb"), "50%_42{}.vdb");
  EXPECT_EQ(name("%%d"), "%d");
  EXPECT_EQ(FrameName("%02d").in_frame(12345), "12345");
  EXPECT_TRUE(FrameName("a%d").has_number());
  EXPECT_FALSE(FrameName("a%%d").has_number());
}

TEST(FrameNames, WhatIsNoPlaceIsRefused) {
  for (const char* name : {"%", "100%.vdb", "%s", "%n", "%4d", "%00d", "%0d", "%021d", "%-4d",
                           "%04x", "%d%d", "%d.####", "##.##", "%%%"}) {
    EXPECT_THROW(FrameName{name}, Error) << name;
  }
}

class FramesTest : public ProgramTest {
 protected:
  /// Three frames of a ball that grows denser.
  FramesTest() {
    for (int frame = 1; frame <= 3; ++frame) write_frame(frame);
  }

  void write_frame(int frame) const {
    write_cube(path("smoke.000" + std::to_string(frame) + ".vdb"),
               [frame](const Vec3i& voxel) { return static_cast<float>(frame) * ball(voxel); });
  }

  /// Renders with few samples; more options may follow.
  Outcome render(const std::string& options) const {
    return run("render --size 24x16 --spp 4 " + options);
  }

  void expect_error(const std::string& options, const Names& parts) const {
    const Names before = files();
    const Outcome outcome = render(options);
    SCOPED_TRACE(options);
    EXPECT_EQ(outcome.status, 1) << outcome;
    EXPECT_EQ(outcome.messages.rfind("freepath: error: ", 0), 0U) << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.messages.find(part), std::string::npos) << "no " << part << ": " << outcome;
    }
    EXPECT_EQ(files(), before);
  }

  std::vector<float> values(const std::string& name) const { return read_image(path(name)).values; }
};

constexpr const char* kSequence = "smoke.%04d.vdb -o p.%d.exr --seed-mode same ";

TEST_F(FramesTest, EveryFrameIsThePictureOfItsVolume) {
  // All frames have the same extent, so that the camera framed from any is the same.
  const Outcome outcome =
      render(std::string(kSequence) + "-o p.##.png --frames 1-3x2 --stats s.%d.json");
  EXPECT_EQ(outcome.status, 0) << outcome;
  EXPECT_EQ(files(), (Names{"p.01.png", "p.03.png", "p.1.exr", "p.3.exr", "s.1.json", "s.3.json",
                            "smoke.0001.vdb", "smoke.0002.vdb", "smoke.0003.vdb"}));
  EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 2) << outcome;
  EXPECT_NE(outcome.messages.find("frame 1 (1 of 2): 4 samples per pixel"), std::string::npos)
      << outcome;
  EXPECT_NE(outcome.messages.find("frame 3 (2 of 2): "), std::string::npos) << outcome;
  EXPECT_NE(outcome.messages.find("wrote p.3.exr, p.03.png\n"), std::string::npos) << outcome;
  ASSERT_EQ(render("smoke.0003.vdb -o alone.exr").status, 0);
  EXPECT_EQ(values("p.3.exr"), values("alone.exr"));
  EXPECT_NE(values("p.1.exr"), values("alone.exr"));
  std::ifstream stream(path("s.3.json"));
  EXPECT_EQ(nlohmann::json::parse(stream)["frame"], 3);
}

TEST_F(FramesTest, TheCameraIsFramedOnceFromTheFirstFrame) {
  write_cube(path("smoke.0004.vdb"), ball, eighths() * Matrix4d().setTranslation(Vec3d(9, 0, 0)));
  const auto covered = [&](const std::string& name) {
    const Image image = read_image(path(name));
    const int alpha = find_channel(image, "A").value();
    double sum = 0;
    for (std::size_t i = alpha; i < image.values.size(); i += image.channels.size()) {
      sum += image.values[i];
    }
    return sum;
  };
  // Each ball is far beside the view of the other.
  ASSERT_EQ(render(std::string(kSequence) + "--frames 1,4").status, 0);
  EXPECT_GT(covered("p.1.exr"), 1);
  EXPECT_EQ(covered("p.4.exr"), 0);
  ASSERT_EQ(render(std::string(kSequence) + "--frames 4,1").status, 0);
  EXPECT_GT(covered("p.4.exr"), 1);
  EXPECT_EQ(covered("p.1.exr"), 0);
  // With a place of its own the camera is the same in any order.
  const std::string placed = std::string(kSequence) + "--look-at 0,0,9,0,0,0 --frames ";
  ASSERT_EQ(render(placed + "4,1").status, 0);
  const std::vector<float> first = values("p.1.exr");
  EXPECT_GT(covered("p.1.exr"), 1);
  ASSERT_EQ(render(placed + "1,4").status, 0);
  EXPECT_EQ(values("p.1.exr"), first);
}

TEST_F(FramesTest, EmptyFramesAreBackgroundAndTheCameraIsThatOfTheFirstOther) {
  testing_volumes::write_vdb_empty(path("some.0001.vdb"));
  write_cube(path("some.0002.vdb"));
  const Outcome outcome = render("some.%04d.vdb --frames 1-2 -o e.%d.exr --seed-mode same");
  ASSERT_EQ(outcome.status, 0) << outcome;
  EXPECT_NE(outcome.messages.find("some.0001.vdb: grid \"density\": it has no active voxels: it is "
                                  "empty"),
            std::string::npos)
      << outcome;
  ASSERT_EQ(render("some.0002.vdb -o alone.exr").status, 0);
  EXPECT_EQ(values("e.2.exr"), values("alone.exr"));
  const Image image = read_image(path("e.1.exr"));
  const int alpha = find_channel(image, "A").value();
  for (std::size_t i = alpha; i < image.values.size(); i += image.channels.size()) {
    ASSERT_EQ(image.values[i], 0);
  }
  // One of several volumes, before or behind, is as if it weren't there.
  ASSERT_EQ(render("some.0001.vdb some.0002.vdb -o both.exr").status, 0);
  EXPECT_EQ(values("both.exr"), values("alone.exr"));
  const Outcome info = run("info some.0001.vdb");
  EXPECT_EQ(info.status, 0) << info;
  EXPECT_NE(info.output.find("it is empty"), std::string::npos) << info;
}

TEST_F(FramesTest, VolumesWithoutAPlaceStayTheSame) {
  write_cube(path("still.vdb"), ball, turned());
  ASSERT_EQ(render(std::string("still.vdb ") + kSequence + "--frames 1-2").status, 0);
  ASSERT_EQ(render("still.vdb smoke.0002.vdb --look-at 0,0,9,0,0,0 -o a.exr").status, 0);
  ASSERT_EQ(render(std::string("still.vdb ") + kSequence +
                   "--frames 1-2 --look-at 0,0,9,0,0,0 --grid density")
                .status,
            0);
  EXPECT_EQ(values("p.2.exr"), values("a.exr"));
}

TEST_F(FramesTest, OneFrameNeedsNoPlaceInItsPicture) {
  ASSERT_EQ(render("smoke.####.vdb -o picture.exr --frames 2 --seed-mode same").status, 0);
  ASSERT_EQ(render("smoke.0002.vdb -o alone.exr").status, 0);
  EXPECT_EQ(values("picture.exr"), values("alone.exr"));
}

TEST_F(FramesTest, WhatCannotBeIsSaidBeforeTheFirstFrame) {
  expect_error(std::string(kSequence) + "--frames 1-5", {"frame 4", "smoke.0004.vdb", "exist"});
  expect_error(std::string(kSequence) + "--frames 1-x", {"--frames", "1-x"});
  expect_error(kSequence, {"smoke.%04d.vdb", "--frames"});
  expect_error("smoke.####.vdb -o p.exr", {"smoke.####.vdb", "--frames"});
  expect_error("smoke.0001.vdb -o p.%d.exr", {"p.%d.exr", "--frames"});
  expect_error("smoke.0001.vdb -o p.exr --stats s.%d.json", {"s.%d.json", "--frames"});
  expect_error("smoke.%04d.vdb -o p.exr --frames 1-2", {"p.exr", "overwrite"});
  expect_error(std::string(kSequence) + "-o q.png --frames 1-2", {"q.png", "overwrite"});
  expect_error(std::string(kSequence) + "--stats s.json --frames 1-2", {"s.json", "overwrite"});
  expect_error("smoke.0001.vdb -o p.%d.exr --frames 1-2", {"no volume"});
  expect_error("smoke.%04d.vdb missing.vdb -o p.%d.exr --frames 1-2", {"missing.vdb", "exist"});
  expect_error("smoke.%04d.vdb -o missing/p.%d.exr --frames 1-2", {"missing"});
  expect_error("smoke.%04d.vdb -o p.%d.gif --frames 1-2", {"p.1.gif", ".exr"});
  expect_error("smoke.%4d.vdb -o p.%d.exr --frames 1-2", {"smoke.%4d.vdb", "%04d"});
  expect_error(std::string(kSequence) + "--stats smoke.%04d.vdb --frames 1-2", {"smoke.0001.vdb"});
  for (int frame = 2; frame <= 12; ++frame) {
    std::filesystem::copy_file(path("smoke.0001.vdb"), path("s" + std::to_string(frame) + ".vdb"));
  }
  expect_error("s%d.vdb -o p1%d.exr -o p%d.exr --frames 2,12", {"p12.exr", "2", "12"});
}

TEST_F(FramesTest, AFrameThatFailsIsNamedAndTheOthersAreRendered) {
  write_text(path("smoke.0002.vdb"), "no volume");
  const Outcome outcome = render(std::string(kSequence) + "--frames 1-3");
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("freepath: error: frame 2: smoke.0002.vdb"), std::string::npos)
      << outcome;
  EXPECT_NE(outcome.messages.find("--frames 1,3 are done; to render the others, give --frames 2"),
            std::string::npos)
      << outcome;
  EXPECT_NE(outcome.messages.find("1 frame of 3 failed: --frames 2"), std::string::npos) << outcome;
  EXPECT_EQ(files(),
            (Names{"p.1.exr", "p.3.exr", "smoke.0001.vdb", "smoke.0002.vdb", "smoke.0003.vdb"}));
}

TEST_F(FramesTest, CtrlCWritesTheFrameAndSaysWhichAreDone) {
  // In the first frame there is next to nothing; the second would take a thousand times as long.
  write_cube(path("smoke.0001.vdb"), [](const Vec3i& voxel) { return 1e-9F * ball(voxel); });
  int frames_begun = 0;
  std::size_t looked_at = 0;
  const Outcome outcome = start_in_terminal(
      words(std::string("render ") + kSequence +
            "--frames 1-3 --size 32x32 --spp 4000 --albedo 1 --density-scale 200"),
      folder_, [&](const std::string& text, int process) {
        // The first frame is complete; the second is interrupted.
        if (frames_begun == 0 && text.find("frame 1 (1 of 3)") != std::string::npos) {
          frames_begun = 1;
          looked_at = text.size();
        }
        if (frames_begun != 1 || samples_shown(text.substr(looked_at)) < 2) return;
        frames_begun = 2;
        kill(process, SIGINT);
      });
  EXPECT_EQ(frames_begun, 2) << outcome;
  EXPECT_EQ(outcome.status, program::kPartialStatus) << outcome;
  EXPECT_NE(outcome.messages.find("frame 2 (2 of 3): interrupted after"), std::string::npos)
      << outcome;
  EXPECT_NE(outcome.messages.find("--frames 1 are done; to render the others, give --frames 2-3"),
            std::string::npos)
      << outcome;
  EXPECT_EQ(files(), (Names{"p.1.exr", "p.2.partial.exr", "smoke.0001.vdb", "smoke.0002.vdb",
                            "smoke.0003.vdb"}));
}

}  // namespace
}  // namespace freepath::testing
