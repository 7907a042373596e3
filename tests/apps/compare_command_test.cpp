// freepath compare and freepath plan as a user meets them.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"
#include "tests/report/browser.h"

namespace freepath::testing {
namespace {

class CompareCommandTest : public ProgramTest {
 protected:
  void SetUp() override { write_cube(path("ball.vdb")); }

  /// A short comparison; options are added at the end.
  Outcome compare(const std::string& options) const {
    const bool says_samples = options.find("--spp") != std::string::npos;
    const bool makes_reference = options.find("--reference ") == std::string::npos;
    return run("compare ball.vdb -o report --size 48x32 --environment 1 " +
               std::string(makes_reference ? "--reference-spp 32 --cache kept " : "") +
               std::string(says_samples ? "" : "--spp 16 --repeats 2 ") + options);
  }
  nlohmann::json report() const {
    std::ifstream file(path("report/compare.json"));
    return nlohmann::json::parse(file);
  }
};

TEST_F(CompareCommandTest, WritesAReport) {
  const Outcome outcome = compare("--trackers delta,decomposition");
  ASSERT_EQ(outcome.status, 0) << outcome;
  EXPECT_NE(outcome.output.find("decomposition"), std::string::npos) << outcome;
  for (const char* name : {"report.html", "compare.json", "compare.csv", "efficiency.svg",
                           "convergence.svg", "reference.exr", "delta.exr"}) {
    EXPECT_TRUE(std::filesystem::exists(path(std::string("report/") + name))) << name;
  }
  const nlohmann::json json = report();
  EXPECT_EQ(json["configurations"].size(), 2U);
  EXPECT_EQ(json["configurations"][0]["samples"]["value"], 8);
  EXPECT_EQ(json["command"].get<std::string>().rfind("freepath compare ball.vdb", 0), 0U);
  EXPECT_EQ(read_image(path("report/reference.exr")).width, 48);
  // Nothing is left aside.
  for (const auto& entry : std::filesystem::directory_iterator(path("report"))) {
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
  }
}

TEST_F(CompareCommandTest, FindsItsReferenceAgainWhileThePictureIsTheSame) {
  const auto origin = [&](const std::string& options) {
    EXPECT_EQ(compare("--trackers delta " + options).status, 0);
    return report()["references"][0]["origin"].get<std::string>().substr(0, 5);
  };
  EXPECT_EQ(origin(""), "made ");
  EXPECT_EQ(origin("--seed 5 --threads 1 --super-voxel 8"), "found");
  EXPECT_EQ(origin("--albedo 0.5"), "made ");
  EXPECT_EQ(origin("--fov 30"), "made ");
  write_text(path("table.txt"), "0 1\n180 1\n");
  EXPECT_EQ(origin("--phase tabulated:table.txt"), "made ");
  EXPECT_EQ(origin("--phase tabulated:table.txt"), "found");
  write_text(path("table.txt"), "0 2\n180 1\n");
  EXPECT_EQ(origin("--phase tabulated:table.txt"), "made ");
  // A damaged one is made again.
  for (const auto& entry : std::filesystem::directory_iterator(path("kept"))) {
    write_text(entry.path(), "damaged");
  }
  EXPECT_EQ(origin(""), "made ");
  write_cube(path("ball.vdb"), [](const Vec3i& voxel) { return 0.5F * ball(voxel); });
  EXPECT_EQ(origin(""), "made ");
}

TEST_F(CompareCommandTest, RunsAllCombinations) {
  ASSERT_EQ(compare("--trackers delta,weighted-delta:rate-scale=2 --transmittance ratio,delta "
                    "--interpolation nearest,stochastic")
                .status,
            0);
  const nlohmann::json json = report();
  EXPECT_EQ(json["configurations"].size(), 8U);
  EXPECT_EQ(json["references"].size(), 2U);
  EXPECT_EQ(json["configurations"][4]["name"], "weighted-delta:rate-scale=2 · ratio · nearest");
}

TEST_F(CompareCommandTest, ChecksOnDemand) {
  // March in steps as long as the ball, compared with methods that are right.
  const Outcome biased =
      compare("--trackers delta,ray-marching:step=1 --density-scale 4 --spp 200 --check");
  EXPECT_EQ(biased.status, 0) << biased;
  EXPECT_NE(biased.output.find("BIASED"), std::string::npos) << biased;
  // A reference of something else: whoever claims to be unbiased fails.
  ASSERT_EQ(run("render ball.vdb -o other.exr --size 48x32 --spp 64 --environment 2").status, 0);
  const Outcome wrong = compare("--trackers delta --reference other.exr --check");
  EXPECT_EQ(wrong.status, 1) << wrong;
}

TEST_F(CompareCommandTest, SaysWhatIsWrong) {
  const auto expect_error = [&](const std::string& options, const std::string& part) {
    const Outcome outcome = compare(options);
    EXPECT_NE(outcome.status, 0) << options << '\n' << outcome;
    EXPECT_NE(outcome.messages.find(part), std::string::npos) << options << '\n' << outcome;
    EXPECT_EQ(std::count(outcome.messages.begin(), outcome.messages.end(), '\n'), 1) << outcome;
    EXPECT_FALSE(std::filesystem::exists(path("report/report.html"))) << options;
  };
  expect_error("--trackers delta,nonsense", "nonsense");
  expect_error("--trackers delta,,spectral", "--trackers");
  expect_error("--trackers delta,delta", "given twice");
  expect_error("--trackers closed-form", "closed-form");
  expect_error("--trackers delta --reference nowhere.exr", "nowhere.exr");
  expect_error("--trackers delta --interpolation cubic", "cubic");
  expect_error("--trackers ray-marching --interpolation stochastic", "ray-marching");
  expect_error("--trackers delta --spp 4 --repeats 0", "--repeats");
  expect_error("--trackers delta --reference r.exr --cache kept", "--cache is for references");
  expect_error("--trackers delta --spp 3 --repeats 2", "each needs two");
  write_text(path("taken"), "a file");
  const Outcome taken = run("compare ball.vdb -o taken --spp 1");
  EXPECT_NE(taken.messages.find("is not a folder"), std::string::npos) << taken;
}

TEST_F(CompareCommandTest, TakesScenes) {
  write_text(path("fog.pbrt"), R"(
    LookAt 0 0 5  0 0 0  0 1 0
    Camera "perspective" "float fov" 40
    Film "rgb" "integer xresolution" 32 "integer yresolution" 24
    WorldBegin
    LightSource "infinite" "rgb L" [ 1 1 1 ]
    MakeNamedMedium "fog" "string type" "homogeneous"
      "rgb sigma_a" [ 0.1 0.2 0.3 ] "rgb sigma_s" [ 1 0.5 0.25 ]
    AttributeBegin
      MediumInterface "fog" ""
      Material "interface"
      Shape "sphere" "float radius" 1
    AttributeEnd)");
  const Outcome outcome =
      run("compare fog.pbrt -o report --spp 32 --repeats 2 --reference-spp 64 --cache none "
          "--trackers delta,spectral --color rgb");
  ASSERT_EQ(outcome.status, 0) << outcome;
  const nlohmann::json json = report();
  for (const auto& configuration : json["configurations"]) {
    EXPECT_TRUE(configuration["bias_test"]["passes"]) << configuration["name"];
  }
}

// The report as a reader sees it, light and dark.
TEST_F(CompareCommandTest, MakesAReportThatBrowsersShow) {
  const auto program = Browser::find();
  if (!program) GTEST_SKIP() << "no chromium, chromium-browser or google-chrome in the path";
  ASSERT_EQ(compare("--trackers delta,decomposition").status, 0);
  const Browser browser(*program, folder_);
  const std::string page = path("report/report.html");
  const std::string document = browser.document(page);
  EXPECT_NE(document.find("data-ready=\"yes\""), std::string::npos);
  EXPECT_NE(document.find("data-errors=\"0\""), std::string::npos);
  const Screenshot light = browser.screenshot(page + "?theme=light", 1200, 3000);
  const Screenshot dark = browser.screenshot(page + "?theme=dark", 1200, 3000);
  EXPECT_GT(light.colour_count(), 500U);  // pictures and maps are there
  EXPECT_GT(dark.colour_count(), 500U);
  EXPECT_GT(light.count_near("#f7f7f5"), dark.count_near("#f7f7f5") + 100000);
}

TEST_F(CompareCommandTest, PlansAPicture) {
  const Outcome outcome =
      run("plan ball.vdb --size 96x64 --environment 1 --pilot-time 0.1 --json --noise 0.02");
  ASSERT_EQ(outcome.status, 0) << outcome;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["super_voxels"].size(), 5U);
  EXPECT_TRUE(json["best"].is_string());
  bool refused = false;
  for (const auto& entry : json["trackers"]) {
    if (entry.contains("refusal")) {
      refused = true;
      continue;
    }
    EXPECT_GT(entry["lookups_per_path"], 0) << entry;
    EXPECT_GT(entry["seconds"], 0) << entry;
  }
  EXPECT_TRUE(refused);  // closed-form, for one
  const Outcome text = run("plan ball.vdb --size 32x24 --environment 1 --pilot-time 0.05");
  EXPECT_NE(text.output.find("Take --tracker"), std::string::npos) << text;
  EXPECT_NE(run("plan nowhere.vdb").status, 0);
}

}  // namespace
}  // namespace freepath::testing
