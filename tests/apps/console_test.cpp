// What the program says, and where nobody takes it: full disks, closed streams, names that are no
// text.

#include "apps/freepath/console.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"
#include "tests/io/volume_files.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class ConsoleTest : public ProgramTest {
 protected:
  ConsoleTest() { write_cube(path("ball.vdb")); }

  /// Fails where a text could do something to a terminal, or is no UTF-8.
  static void expect_harmless(const std::string& text) { EXPECT_EQ(text, printable(text, '\n')); }
};

constexpr const char* kSmall = " --size 8x8 --spp 1 ";

TEST_F(ConsoleTest, ResultsThatCantBeWrittenAreAnError) {
  ASSERT_EQ(run(std::string("render ball.vdb -o a.exr") + kSmall).status, 0);
  for (const std::string command :
       {"info ball.vdb", "info ball.vdb --json", "slab --tau 1 --paths 100",
        "slab --tau 1 --paths 100 --json", "diff a.exr a.exr", "diff a.exr a.exr --json",
        "trackers", "trackers --json", "lab --list", "--help", "render --help", "--version"}) {
    const Outcome outcome = shell("freepath " + command + " >/dev/full");
    EXPECT_EQ(outcome.status, 1) << command << outcome;
    EXPECT_EQ(outcome.messages,
              "freepath: error: can't write to standard output: No space left on device\n")
        << command;
  }
  const Outcome closed = shell("freepath info ball.vdb >&-");
  EXPECT_EQ(closed.status, 1) << closed;
  EXPECT_NE(closed.messages.find("standard output"), std::string::npos) << closed;
  // Where there are no results, nobody misses the stream.
  EXPECT_EQ(shell(std::string("freepath render ball.vdb -o b.exr >&-") + kSmall).status, 0);
}

TEST_F(ConsoleTest, AReaderThatHasGoneEndsACommandWithoutAWord) {
  // The program starts when the reader has gone.
  const Outcome outcome = shell(
      "mkfifo gone gate; (exec 5>gone; read x <gate; freepath trackers >&5; echo $? >status) & "
      "exec 3<gone; exec 3<&-; echo go >gate; wait; cat status");
  EXPECT_EQ(outcome.output, "141\n") << outcome;
  EXPECT_EQ(outcome.messages, "");
}

TEST_F(ConsoleTest, MessagesThatCantBeWrittenCostNoPicture) {
  for (const char* frame : {"s.1.vdb", "s.2.vdb"}) fs::copy(path("ball.vdb"), path(frame));
  const std::string sequence =
      std::string("freepath render s.%d.vdb --frames 1-2 --seed-mode same -o q.%d.exr") + kSmall;
  for (const char* stream : {"2>/dev/full", "2>&-", "<&- >&- 2>&-"}) {
    const Outcome outcome = shell(sequence + stream);
    EXPECT_EQ(outcome.status, 0) << stream << outcome;
    // Had the picture become standard error, there would be messages in it.
    EXPECT_EQ(run("diff q.1.exr q.2.exr --max-relative-mse 0").status, 0) << stream;
    fs::remove(path("q.1.exr"));
    fs::remove(path("q.2.exr"));
  }
  // A reader of messages that goes away.
  const Outcome pipe =
      shell("{ " + sequence + " 2>&1; echo $? >status; } | head -c 1 >/dev/null; cat status");
  EXPECT_EQ(pipe.output, "0\n") << pipe;
  EXPECT_EQ(shell("freepath info missing.vdb 2>&-").status, 1);
  EXPECT_EQ(shell("freepath info missing.vdb 2>/dev/full").status, 1);
}

TEST_F(ConsoleTest, NamesAreShownWithoutTheirControlCharactersAndAsJson) {
  const std::string name = "caf\xe9\033]0;title\a\nfreepath: error: forged";
  const std::string file = "n\xe9\033[31m.vdb";
  testing_volumes::TestGrid grid;
  grid.name = name;
  grid.voxels.push_back({});
  grid.voxels.back().value = 1;
  testing_volumes::write_vdb_file(path(file), {grid});
  const auto call = [&](const std::vector<std::string>& arguments) {
    Outcome outcome = call_program(arguments, folder_);
    expect_harmless(outcome.output);
    expect_harmless(outcome.messages);
    return outcome;
  };
  const Outcome table = call({"info", file});
  EXPECT_EQ(table.status, 0) << table;
  EXPECT_NE(table.output.find("\"caf\\xe9\\x1b]0;title\\x07\\nfreepath: error: forged\"\n"),
            std::string::npos)
      << table;
  const Outcome json = call({"info", file, "--json"});
  EXPECT_EQ(json.status, 0) << json;
  EXPECT_TRUE(nlohmann::json::parse(json.output, nullptr, false).is_object()) << json;

  const Outcome render = call({"render", file, "--grid", "0", "-o", "p\xe9\n.exr", "--stats",
                               "s.json", "--size", "8x8", "--spp", "1"});
  EXPECT_EQ(render.status, 0) << render;
  std::ifstream stats(path("s.json"));
  EXPECT_TRUE(nlohmann::json::parse(stats, nullptr, false).is_object());

  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"info", "no\033[2J\n.vdb"},
           {"info", file, "--grid", "\033[2J"},
           {"render", file, "-o", "a.exr", "--tracker", "d\xe9\033[2J\nelta"},
           {"render", file, "-o", "a\033.jpg"},
           {"\033[2Jinfo"},
           {"info", file, "--\033[2J"}}) {
    const Outcome outcome = call(wrong);
    EXPECT_GT(outcome.status, 0) << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
  }
  write_text(path("s.pbrt"), "Film \"\033[2J\xe9\"\nWorldBegin\n");
  EXPECT_GT(call({"render", "s.pbrt", "-o", "a.exr"}).status, 0);
}

}  // namespace
}  // namespace freepath::testing
