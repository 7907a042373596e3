// freepath lab as a user meets it.

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/program.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class LabCommandTest : public ProgramTest {
 protected:
  std::string content(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void expect_refused(const std::string& line, const std::string& reason) const {
    const Outcome outcome = run(line);
    EXPECT_NE(outcome.status, 0) << line << '\n' << outcome;
    EXPECT_NE(outcome.messages.find(reason), std::string::npos) << line << '\n' << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
    EXPECT_EQ(outcome.output, "") << outcome;
  }
};

TEST_F(LabCommandTest, WritesAReportWithNumbersAndPlots) {
  const Outcome outcome =
      run("lab chromatic-ramp two-boxes -o new/folder --paths 2000 --seed 3 --absorption analog "
          "--trackers spectral:collision-probability=max,rate-scale=1.5,delta,closed-form");
  ASSERT_EQ(outcome.status, 0) << outcome;
  EXPECT_EQ(outcome.messages, "");
  EXPECT_NE(outcome.output.find("spectral:collision-probability=max,rate-scale=1.5"),
            std::string::npos)
      << outcome;
  EXPECT_NE(outcome.output.find("refuses"), std::string::npos) << outcome;
  EXPECT_NE(content("new/folder/report.html").find("chromatic-ramp"), std::string::npos);
  EXPECT_EQ(content("new/folder/lab.csv").find("setting,tracker"), 0U);
  const auto json = nlohmann::json::parse(content("new/folder/lab.json"));
  EXPECT_EQ(json["paths"], 2000);
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["absorption"], "analog");
  EXPECT_EQ(json["settings"][1]["trackers"].size(), 3U);
  std::size_t plots = 0;
  for (const auto& entry : fs::directory_iterator(path("new/folder"))) {
    const std::string name = entry.path().filename();
    EXPECT_FALSE(name.starts_with('.')) << name;
    plots += name.ends_with(".svg") ? 1 : 0;
  }
  EXPECT_GT(plots, 10U);
}

TEST_F(LabCommandTest, ListsTheSettings) {
  const Outcome outcome = run("lab --list");
  EXPECT_EQ(outcome.status, 0) << outcome;
  for (const char* name : {"two-boxes", "ramp", "spike", "noise", "fixture-a", "chromatic-ramp"}) {
    EXPECT_NE(outcome.output.find(name), std::string::npos) << name;
  }
}

TEST_F(LabCommandTest, BadInputIsRefusedInOneLine) {
  std::ofstream(path("file")) << "text";
  expect_refused("lab", "-o is missing");
  expect_refused("lab -o file", "exists and is not a folder");
  expect_refused("lab -o out rampp", "did you mean 'ramp'");
  expect_refused("lab -o out ramp ramp", "named twice");
  expect_refused("lab -o out --trackers delta,deltas", "--trackers: ");
  expect_refused("lab -o out --trackers rate-scale=2", "--trackers: ");
  expect_refused("lab -o out --trackers spectral:rate-scale=zero", "--trackers: ");
  expect_refused("lab -o out --paths 10", "--paths");
  expect_refused("lab -o out --paths many", "--paths");
  expect_refused("lab -o out --absorption none", "--absorption");
  expect_refused("lab -o out --seed -1", "--seed");
  expect_refused("lab -o out --threads 0", "--threads");
  EXPECT_EQ(files(), std::vector<std::string>({"file"}));  // no folder is made for nothing
}

TEST_F(LabCommandTest, AnInterruptLeavesNothingBehind) {
  bool sent = false;
  const Outcome outcome = start_in_terminal(words("lab noise -o out --paths 1e7"), folder_,
                                            [&](const std::string& said, int process) {
                                              if (sent || said.find('%') == std::string::npos)
                                                return;
                                              sent = true;
                                              kill(process, SIGINT);
                                            });
  EXPECT_TRUE(sent);
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("interrupted; nothing was written"), std::string::npos)
      << outcome;
  EXPECT_TRUE(fs::is_empty(path("out")));
}

}  // namespace
}  // namespace freepath::testing
