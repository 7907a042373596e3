// What the laboratory writes down.

#include "freepath/study/lab_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "freepath/study/lab_figures.h"
#include "freepath/study/lab_numbers.h"

namespace freepath::testing {
namespace {

const LabResult& small_result() {
  static const LabResult kResult = [] {
    LabOptions options;
    options.settings = {"two-boxes", "fixture-a"};
    options.trackers = {"closed-form", "weighted-delta:rate-scale=0.7",
                        "spectral:collision-probability=max", "auto", "ray-marching:step=0.1"};
    options.paths = 4000;
    return run_lab(options);
  }();
  return kResult;
}

TEST(LabReport, LabelsAndSlugsAreReadable) {
  EXPECT_EQ(lab_label("delta"), "delta");
  EXPECT_EQ(lab_label("spectral"), "spectral, history-average");
  EXPECT_EQ(lab_label("spectral:collision-probability=max,rate-scale=2"),
            "spectral, max,rate-scale=2");
  EXPECT_EQ(lab_slug("weighted-delta:rate-scale=0.7"), "weighted-delta-rate-scale-0.7");
}

TEST(LabReport, JsonHoldsWhatWasMeasured) {
  const auto json = nlohmann::json::parse(lab_json(small_result()));
  ASSERT_EQ(json["settings"].size(), 2U);
  const auto& fixture = json["settings"][1];
  EXPECT_EQ(fixture["name"], "fixture-a");
  EXPECT_EQ(fixture["channels"].size(), 3U);
  ASSERT_EQ(fixture["trackers"].size(), 5U);
  EXPECT_EQ(fixture["trackers"][0]["verdict"], "refuses");
  EXPECT_TRUE(fixture["trackers"][0].contains("refusal"));
  const auto& delta = fixture["trackers"][1];
  const LabMeasurement& measured = small_result().settings[1].trackers[1];
  EXPECT_EQ(delta["variance"].get<double>(), measured.variance);
  EXPECT_EQ(delta["channels"][2]["scattered"].get<std::vector<double>>(),
            measured.channels[2].scattered);
  EXPECT_EQ(fixture["trackers"][3]["stands_for"], "spectral-decomposition");
  EXPECT_TRUE(fixture["trackers"][4]["biased"].get<bool>());
  EXPECT_EQ(fixture["throughput_along_ray"].size(), 2U);  // spectral, and what auto stands for
  EXPECT_TRUE(json["settings"][0]["throughput_along_ray"].empty());
  // Fixture A has one albedo everywhere in its first channel alone: else no mean is known.
  const auto& stage = fixture["throughput_of_scatterings"][0]["stages"][3];
  EXPECT_NEAR(stage["channels"][0]["exact"].get<double>(), std::pow(6 / 6.5, 3), 1e-6);
  EXPECT_TRUE(stage["channels"][2]["exact"].is_null());
}

TEST(LabReport, CsvHasEightFieldsALine) {
  std::istringstream csv(lab_csv(small_result()));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "setting,tracker,channel,quantity,at,value,standard_error,exact");
  std::size_t lines = 0;
  while (std::getline(csv, line)) {
    ++lines;
    // Without the quoted tracker, whose options have commas.
    const std::size_t open = line.find('"');
    if (open != std::string::npos) line.erase(open, line.find('"', open + 1) - open + 1);
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), 7) << line;
    ASSERT_EQ(line.find("nan"), std::string::npos) << line;
  }
  EXPECT_GT(lines, 1000U);
}

TEST(LabReport, FilesHaveNamesOfTheirOwnAndThePageHoldsEveryPlot) {
  const std::vector<LabFile> files = lab_files(small_result());
  std::set<std::string> names;
  for (const LabFile& file : files) EXPECT_TRUE(names.insert(file.name).second) << file.name;
  for (const char* name : {"report.html", "lab.json", "lab.csv", "two-boxes-extinction.svg",
                           "fixture-a-free-paths-spectral-collision-probability-max.svg",
                           "fixture-a-scatterings-largest.svg", "two-boxes-rate-cost.svg"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
  const std::string& page = files[0].content;
  EXPECT_EQ(files[0].name, "report.html");
  for (const LabFile& file : files) {
    if (!file.name.ends_with(".svg")) continue;
    EXPECT_TRUE(file.content.starts_with("<svg") || file.content.starts_with("<?xml"));
    EXPECT_NE(page.find(file.name), std::string::npos) << file.name;
  }
  EXPECT_NE(page.find("0.74584544"), std::string::npos);
}

}  // namespace
}  // namespace freepath::testing
