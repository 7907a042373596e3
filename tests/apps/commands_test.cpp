// The other subcommands as a user meets them, and the help of all.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {
namespace {

using nlohmann::json;

class CommandsTest : public ProgramTest {
 protected:
  /// Runs a command that must succeed and print one JSON object and nothing else.
  json run_json(const std::string& line) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 0) << line << '\n' << outcome;
    json object = json::parse(outcome.output, nullptr, false);
    EXPECT_TRUE(object.is_object()) << line << '\n' << outcome;
    return object;
  }

  static void expect_keys(const json& object, const std::vector<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(object.contains(key)) << key << ": " << object;
  }
};

TEST_F(CommandsTest, InfoTellsOfEachGrid) {
  write_cube(path("ball.vdb"));
  const json info = run_json("info ball.vdb --json");
  expect_keys(info, {"file", "grids"});
  ASSERT_EQ(info["grids"].size(), 1U);
  const json& grid = info["grids"][0];
  expect_keys(grid, {"name", "type", "index_to_world", "minimum", "maximum", "active_voxels",
                     "memory_bytes", "super_voxels"});
  EXPECT_EQ(grid["name"], "density");
  EXPECT_EQ(grid["type"], "float");
  int active = 0;
  for (int x = -8; x < 8; ++x) {
    for (int y = -8; y < 8; ++y) {
      for (int z = -8; z < 8; ++z) active += ball(Vec3i(x, y, z)) > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(grid["active_voxels"], active);
  EXPECT_EQ(grid["maximum"].get<float>(), ball(Vec3i(0)));
  const Outcome text = start("info ball.vdb");
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.output.find("density"), std::string::npos);
}

TEST_F(CommandsTest, GenerateWritesWhatRenderReads) {
  for (const std::string kind : {"cloud", "smoke", "fireball"}) {
    const Outcome outcome = start("generate " + kind + " -o made.vdb --resolution 32");
    EXPECT_EQ(outcome.status, 0) << kind << '\n' << outcome;
    const json info = run_json("info made.vdb --json");
    std::vector<std::string> names;
    for (const json& grid : info["grids"]) names.push_back(grid["name"]);
    EXPECT_EQ(names, kind == "fireball" ? std::vector<std::string>({"density", "temperature"})
                                        : std::vector<std::string>({"density"}));
    const Outcome rendered = run("render made.vdb -o picture.exr --size 8x8 --spp 1");
    EXPECT_EQ(rendered.status, 0) << rendered;
  }
}

TEST_F(CommandsTest, GenerateDependsOnItsSeedAlone) {
  const auto bytes = [&](const std::string& options, const std::string& name) {
    const Outcome outcome = run("generate cloud --resolution 24 " + options + " -o " + name);
    EXPECT_EQ(outcome.status, 0) << outcome;
    const json grid = run_json("info " + name + " --json")["grids"][0];
    return grid["active_voxels"].dump() + ' ' + grid["maximum"].dump();
  };
  EXPECT_EQ(bytes("--seed 1", "a.vdb"), bytes("--seed 1", "b.vdb"));
  EXPECT_NE(bytes("--seed 1", "a.vdb"), bytes("--seed 2", "c.vdb"));
}

TEST_F(CommandsTest, SlabAgreesWithThePublishedValue) {
  const json slab = run_json("slab --tau 1 --albedo 1 --g 0.75 --paths 200000 --json");
  expect_keys(slab, {"reflectance", "reflectance_error", "transmittance", "transmittance_error",
                     "unscattered", "absorptance", "absorptance_error", "paths", "tracker"});
  EXPECT_NEAR(slab["absorptance"].get<double>(), 0, 1e-6);
  // Reflectance 0.07874 of a slab of optical thickness 1 [vandeHulst80, table 37].
  EXPECT_NEAR(slab["reflectance"].get<double>(), 0.07874,
              4.5 * slab["reflectance_error"].get<double>() + 5e-6);
  EXPECT_NEAR(slab["unscattered"].get<double>(), std::exp(-1.0), 0.01);
  EXPECT_EQ(slab["paths"], 200000);
  EXPECT_EQ(slab["tracker"], "delta");
}

TEST_F(CommandsTest, SlabTakesCoefficientsAndPhaseFunctions) {
  const std::string run = " --paths 20000 --json";
  const json optical = run_json("slab --tau 2,4 --albedo 0.75,0.5 --g 0.5" + run);
  const json physical = run_json(
      "slab --mua 0.5,1 --mus 1.5,1 --thickness 1,2 --phase henyey-greenstein:g=0.5" + run);
  EXPECT_EQ(optical, physical);
}

TEST_F(CommandsTest, SlabThatNoPathPassesHasALimitInPlaceOfAnError) {
  const json slab = run_json("slab --tau 4.9 --albedo 0 --paths 10 --json");
  EXPECT_TRUE(slab["transmittance_error"].is_null());
  EXPECT_NEAR(slab["transmittance_upper"].get<double>(), 0.2589, 1e-4);
  EXPECT_FALSE(slab.contains("reflectance_upper"));
}

TEST_F(CommandsTest, MoreThreadsThanTheMachineHasAreFine) {
  write_cube(path("ball.vdb"));
  const std::string threads =
      " --threads " + std::to_string(std::thread::hardware_concurrency() + 3);
  const Outcome slab = start("slab --tau 1 --paths 100000" + threads);
  EXPECT_EQ(slab.status, 0) << slab;
  EXPECT_EQ(slab.messages, "");
  const Outcome render = start("render ball.vdb -o picture.exr --size 99x99 --spp 1" + threads);
  EXPECT_EQ(render.status, 0) << render;
  // Five lines of a summary, and no warning.
  EXPECT_EQ(std::count(render.messages.begin(), render.messages.end(), '\n'), 5) << render;
  EXPECT_EQ(render.messages.find("arning"), std::string::npos) << render;
}

TEST_F(CommandsTest, DiffMeasures) {
  write_environment(path("a.exr"), 1, 1);
  write_environment(path("b.exr"), 2, 2);
  const json difference = run_json("diff a.exr b.exr --json");
  expect_keys(difference, {"mse", "relative_mse", "mean_ratio", "largest_difference"});
  EXPECT_DOUBLE_EQ(difference["mse"], 1);
  EXPECT_EQ(difference["mean_ratio"], json({0.5, 0.5, 0.5}));
  EXPECT_DOUBLE_EQ(difference["largest_difference"], 1);
  EXPECT_EQ(start("diff a.exr a.exr").status, 0);
  EXPECT_EQ(start("diff a.exr b.exr --max-relative-mse 0.001").status, 1);
}

TEST_F(CommandsTest, VersionAndHelpSucceed) {
  EXPECT_EQ(start("--version").status, 0);
  const Outcome help = start("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* command : {"render", "info", "generate", "convert", "slab", "diff", "merge"}) {
    EXPECT_NE(help.output.find(command), std::string::npos) << command;
  }
}

/// The command lines among the examples of a help text.
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  std::istringstream stream(help.substr(std::min(help.find("Examples:"), help.size())));
  for (std::string line; std::getline(stream, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    if (first == std::string::npos || line.rfind("freepath ", first) != first) continue;
    line = line.substr(first + 9);
    examples.push_back(line.substr(0, line.find('(')));
  }
  return examples;
}

/// The command line with the value of an option replaced, or with the option added.
std::string with_option(const std::string& line, const std::string& option,
                        const std::string& value) {
  std::string result;
  bool skip = false;
  for (const std::string& word : words(line)) {
    if (!skip && word != option) result += word + ' ';
    skip = word == option;
  }
  return result + option + ' ' + value;
}

TEST_F(CommandsTest, ExamplesOfTheHelpAreAccepted) {
  for (const std::string command :
       {"render", "info", "generate", "convert", "slab", "diff", "merge"}) {
    const Outcome help = run(command + " --help");
    EXPECT_EQ(help.status, 0) << help;
    const std::vector<std::string> examples = examples_in(help.output);
    EXPECT_GE(examples.size(), 2U) << help;
    for (std::string example : examples) {
      const bool has_error = example.find("--error") != std::string::npos;
      if (command == "slab" && !has_error) example = with_option(example, "--paths", "1000");
      if (command == "generate") example = with_option(example, "--resolution", "16");
      const Outcome outcome = run(example);
      if (command == "slab" || command == "generate") {
        EXPECT_EQ(outcome.status, 0) << example << '\n' << outcome;
        continue;
      }
      // The files are not there: that, and nothing else, is what may be wrong with the line.
      EXPECT_EQ(outcome.status, 1) << example << '\n' << outcome;
      bool names_file = false;
      for (const char* ending : {".vdb: ", ".nvdb: ", ".vti: ", ".nii.gz: ", ".nc: ", ".raw: ",
                                 ".hdr: ", ".exr: ", ".pbrt: ", ".film: "}) {
        names_file |= outcome.messages.find(ending) != std::string::npos;
      }
      EXPECT_TRUE(names_file) << example << '\n' << outcome;
    }
    // What generate wrote must not become the input of other examples.
    for (const std::string& file : files()) std::filesystem::remove(path(file));
  }
}

}  // namespace
}  // namespace freepath::testing
