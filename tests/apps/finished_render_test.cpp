// A picture whose rendering took its time is written, whatever the surroundings are.

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "apps/freepath/console.h"
#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class FinishedRenderTest : public ProgramTest {
 protected:
  FinishedRenderTest() { write_cube(path("ball.vdb")); }

  /// Renders until something is done to it, which is when every pixel has a sample.
  Outcome render_until(const std::string& outputs,
                       const std::function<void(int process)>& happen) const {
    bool happened = false;
    return start_in_terminal(words("render ball.vdb --size 32x32 --spp 1000000000 " + outputs),
                             folder_, [&](const std::string& text, int process) {
                               if (happened || samples_shown(text) < 2) return;
                               happened = true;
                               happen(process);
                             });
  }
};

TEST_F(FinishedRenderTest, SignalsOfAnEndSaveWhatThereIs) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    const Outcome outcome = render_until("-o a.exr", [&](int process) { kill(process, signal); });
    EXPECT_EQ(outcome.status, program::kPartialStatus) << signal << outcome;
    EXPECT_NE(outcome.messages.find("interrupted after"), std::string::npos) << outcome;
    EXPECT_FALSE(fs::exists(path("a.exr")));
    EXPECT_EQ(read_image(path("a.partial.exr")).width, 32);
    fs::remove(path("a.partial.exr"));
  }
  EXPECT_EQ(files(), std::vector<std::string>({"ball.vdb"}));
}

TEST_F(FinishedRenderTest, FilesThatFailKeepNoneOfTheOthersAndThePictureIsKept) {
  fs::create_directory(path("temporary"));
  setenv("TMPDIR", path("temporary").c_str(), 1);
  const auto block = [&](int process) {
    fs::create_directories(path("a.partial.exr") / fs::path("inner"));
    kill(process, SIGINT);
  };
  const Outcome outcome = render_until("-o a.exr -o b.png --stats s.json", block);
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("a.partial.exr: is a directory"), std::string::npos) << outcome;
  EXPECT_NE(outcome.messages.find("the picture is kept in " + path("temporary")), std::string::npos)
      << outcome;
  EXPECT_TRUE(fs::exists(path("b.partial.png")));
  EXPECT_TRUE(fs::exists(path("s.partial.json")));
  for (const auto& kept : fs::directory_iterator(path("temporary"))) {
    EXPECT_EQ(read_image(kept.path()).width, 32);
    fs::remove(kept.path());
  }
  fs::remove_all(path("a.partial.exr"));

  // One file with all layers is enough.
  const Outcome two = render_until("-o a.exr -o c.exr", block);
  unsetenv("TMPDIR");
  EXPECT_EQ(two.status, 1) << two;
  EXPECT_EQ(read_image(path("c.partial.exr")).width, 32);
  EXPECT_TRUE(fs::is_empty(path("temporary")));
}

TEST_F(FinishedRenderTest, ALimitOfFileSizesIsAnError) {
  const Outcome outcome =
      shell("(ulimit -f 4; freepath render ball.vdb -o a.exr -o b.exr --size 64x64 --spp 1)");
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("a.exr: can't write it"), std::string::npos) << outcome;
  EXPECT_NE(outcome.messages.find("b.exr: can't write it"), std::string::npos) << outcome;
  EXPECT_EQ(shell("(ulimit -f 1; freepath generate cloud -o c.vdb --resolution 32)").status, 1);
  EXPECT_EQ(files(), std::vector<std::string>({"ball.vdb"}));
}

TEST_F(FinishedRenderTest, PlacesThatCannotBeWrittenAreToldBeforeRendering) {
  const std::string render = "freepath render ball.vdb --size 8x8 --spp 1000000000 -o ";
  for (const char* line : {
           "mkdir a.exr; $render a.exr",
           "mkfifo b.exr; $render b.exr",
           "touch c.exr; chmod a-w c.exr; $render c.exr",
           "$render none/d.exr",
           "ln -s none/d.exr e.exr; $render e.exr",
           "ln -s f.exr f.exr; $render f.exr",
           "ln -s /dev/full g.exr; $render g.exr",
           "$render /dev/stdout",
           "$render h.exr --stats /dev/stdout",
           "$render h.exr --stats /dev/full",
           "$render $(printf 'a%.0s' {1..252}).exr",
       }) {
    const Outcome outcome = shell("render='" + render + "'; " + line);
    EXPECT_EQ(outcome.status, 1) << line << outcome;
    EXPECT_EQ(outcome.messages.rfind("freepath: error: ", 0), 0U) << line << outcome;
  }
  EXPECT_EQ(
      shell("freepath render ball.vdb --size 8x8 --spp 1 -o $(printf 'a%.0s' {1..245}).exr").status,
      0);
}

TEST_F(FinishedRenderTest, WhereThereAreFewThreadsFewerAreTaken) {
  fs::permissions(folder_, fs::perms::all);
  // Limits of processes do not bind root.
  const std::string user =
      geteuid() == 0 ? "setpriv --reuid=64321 --regid=64321 --clear-groups " : "";
  write_text(path("s.pbrt"), "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n");
  fs::permissions(path("s.pbrt"), fs::perms::all);
  const std::string program = FREEPATH_PROGRAM;
  // OpenVDB's logging takes four threads before the program begins.
  const Outcome none = shell("prlimit --nproc=1 " + user + program + " --version");
  EXPECT_EQ(none.status, geteuid() == 0 ? 1 : none.status) << none;
  EXPECT_EQ(none.messages.find("terminate"), std::string::npos) << none;
  for (const char* limit : {"7", "10"}) {
    for (const char* input : {"ball.vdb", "s.pbrt"}) {
      const Outcome outcome =
          shell(fmt::format("prlimit --nproc={} {}{} render {} -o a.exr -o b.png --size 64x64 "
                            "--spp 1 --threads 8",
                            limit, user, program, input));
      EXPECT_EQ(outcome.status, 0) << limit << input << outcome;
      EXPECT_EQ(read_image(path("a.exr")).width, 64);
    }
  }
}

}  // namespace
}  // namespace freepath::testing
