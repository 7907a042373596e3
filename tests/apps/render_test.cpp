// freepath render: what it writes, that it is right, and that nothing but inputs and seed matters.

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/freepath/console.h"
#include "freepath/io/image.h"
#include "freepath/transport/kernels.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"
#include "tests/counted_clock.h"

namespace freepath::testing {
namespace {

using nlohmann::json;

class RenderTest : public ProgramTest {
 protected:
  RenderTest() { write_cube(path("ball.vdb")); }

  /// Renders the ball to a picture and reads it back.
  Image render(const std::string& options, const std::string& output = "picture.exr") const {
    const bool counted = options.find("--spp") != std::string::npos;
    const Outcome outcome = run("render ball.vdb --size 24x16 " + options +
                                (counted ? " -o " : " --spp 4 -o ") + output);
    EXPECT_EQ(outcome.status, 0) << options << '\n' << outcome;
    return read_image(path(output));
  }

  json read_json(const std::string& name) const {
    std::ifstream stream(path(name));
    return json::parse(stream);
  }

  json compare(const std::string& a, const std::string& b) const {
    const Outcome outcome = run("diff " + a + " " + b + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome;
    return json::parse(outcome.output);
  }

  /// That the mean of a picture is 1 in each channel, within 4.5 standard errors.
  static void expect_mean_one(const Image& image, const std::string& options) {
    for (const std::string channel : {"R", "G", "B"}) {
      const int value = find_channel(image, channel).value();
      const int variance = find_channel(image, "variance." + channel).value();
      double sum = 0;
      double variances = 0;
      for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
          sum += image.pixel(column, row)[value];
          variances += image.pixel(column, row)[variance];
        }
      }
      const auto count = static_cast<double>(image.pixel_count());
      EXPECT_NEAR(sum / count, 1, 4.5 * std::sqrt(variances) / count + 1e-5)
          << options << ", channel " << channel;
    }
  }
};

std::optional<MetadataValue> metadata(const Image& image, const std::string& name) {
  for (const auto& [key, value] : image.metadata) {
    if (key == name) return value;
  }
  return std::nullopt;
}

TEST_F(RenderTest, WritesEveryPictureAskedForAndNothingElse) {
  render("-o picture.png -o second.exr");
  EXPECT_EQ(files(),
            (std::vector<std::string>{"ball.vdb", "picture.exr", "picture.png", "second.exr"}));
  const Image png = read_image(path("picture.png"));
  EXPECT_EQ(png.width, 24);
  EXPECT_EQ(png.height, 16);
  EXPECT_EQ(read_image(path("second.exr")).values, read_image(path("picture.exr")).values);
}

TEST_F(RenderTest, AnExrHasTheColourAndTheLayersThatCostNothing) {
  std::vector<std::string> channels = render("").channels;
  std::sort(channels.begin(), channels.end());
  EXPECT_EQ(channels, (std::vector<std::string>{"A", "B", "G", "R", "albedo.B", "albedo.G",
                                                "albedo.R", "depth.Z", "lookups", "samples",
                                                "variance.B", "variance.G", "variance.R"}));
}

TEST_F(RenderTest, AovsMeanWhatTheyAreCalled) {
  const Image image = render(
      "--albedo 0.25,0.5,0.75 --density-scale 1000 --look-at 0,0,5,0,0,0 "
      "--interpolation nearest");
  const auto value = [&](const char* channel, int column, int row) {
    return image.pixel(column, row)[find_channel(image, channel).value()];
  };
  // The ball's surface is near z = 1 in front of the camera, and opaque; beside it there is
  // nothing.
  EXPECT_NEAR(value("A", 12, 8), 1, 1e-3);
  EXPECT_NEAR(value("depth.Z", 12, 8), 4, 0.3);
  EXPECT_NEAR(value("albedo.R", 12, 8), 0.25, 1e-3);
  EXPECT_NEAR(value("albedo.B", 12, 8), 0.75, 1e-3);
  EXPECT_GT(value("lookups", 12, 8), 0);
  EXPECT_EQ(value("A", 0, 0), 0);
  EXPECT_EQ(value("lookups", 0, 0), 0);
}

TEST_F(RenderTest, AnExrSaysHowItWasMade) {
  const Image image = render("--seed 7 --tracker weighted-delta:rate-scale=1.1");
  EXPECT_EQ(metadata(image, "freepath:seed"), MetadataValue(int64_t{7}));
  EXPECT_EQ(metadata(image, "freepath:samples"), MetadataValue(int64_t{4}));
  EXPECT_EQ(metadata(image, "freepath:tracker"),
            MetadataValue(std::string("weighted-delta:rate-scale=1.1")));
  for (const char* name : {"freepath:version", "DateTime", "freepath:seconds", "freepath:paths",
                           "freepath:tentative_collisions", "freepath:lookups"}) {
    EXPECT_TRUE(metadata(image, name)) << name;
  }
}

TEST_F(RenderTest, StatisticsAreWholeAndConsistent) {
  render("--stats stats.json --seed 11 --threads 2");
  const json stats = read_json("stats.json");
  for (const char* key :
       {"paths", "tentative_collisions", "null_collisions", "real_collisions", "most_samples",
        "pixels_without_samples", "control_collisions", "lookups", "super_voxel_steps",
        "bound_violations", "negative_weights", "largest_weight", "peak_memory_bytes"}) {
    ASSERT_TRUE(stats.contains(key)) << key;
    EXPECT_TRUE(stats[key].is_number()) << key;
  }
  for (const char* key : {"load", "build", "render"}) {
    ASSERT_TRUE(stats["seconds"].contains(key)) << key;
    EXPECT_GE(stats["seconds"][key].get<double>(), 0) << key;
  }
  EXPECT_EQ(stats["tentative_collisions"].get<uint64_t>(),
            stats["null_collisions"].get<uint64_t>() + stats["real_collisions"].get<uint64_t>());
  EXPECT_GT(stats["real_collisions"].get<uint64_t>(), 0U);
  EXPECT_GE(stats["lookups"], stats["tentative_collisions"]);
  EXPECT_EQ(stats["paths"], 24 * 16 * 4);
  EXPECT_EQ(stats["bound_violations"], 0);
  EXPECT_EQ(stats["negative_weights"], 0);
  EXPECT_GT(stats["peak_memory_bytes"].get<double>(), 1e6);
  EXPECT_EQ(stats["tracker"], "delta");
  EXPECT_EQ(stats["seed"], 11);
  EXPECT_EQ(stats["threads"], 2);
  EXPECT_TRUE(stats["version"].is_string());
}

TEST_F(RenderTest, FurnaceIsOneWithEveryMethod) {
  // Radiance 1 from everywhere and no absorption: radiance 1 everywhere [white furnace].
  for (const std::string tracker : {"delta", "weighted-delta:rate-scale=1.3"}) {
    for (const std::string estimators : {"--transmittance ratio --interpolation nearest",
                                         "--transmittance delta --interpolation trilinear",
                                         "--transmittance ratio --interpolation stochastic"}) {
      std::string options = "--albedo 1 --environment 1 --g 0.5 --spp 64 --tracker ";
      options += tracker;
      options += ' ' + estimators;
      expect_mean_one(render(options), options);
    }
  }
}

TEST_F(RenderTest, FurnaceThatAbsorbsAndEmitsIsOneWithEveryMethod) {
  // Where the medium emits what it would see, absorption makes no difference.
  for (const std::string methods :
       {"--tracker delta --absorption analog --emission analog",
        "--tracker delta --absorption weighted --emission collision",
        "--tracker weighted-delta --absorption weighted --emission analog",
        "--tracker weighted-delta --absorption analog --emission collision"}) {
    for (const std::string optics : {"--albedo 0.5", "--sigma-a 0.5,1,0 --sigma-s 1,0.5,0.25"}) {
      std::string options = "--environment 1 --le 1 --spp 64 ";
      options += optics;
      options += ' ' + methods;
      expect_mean_one(render(options), options);
    }
  }
}

TEST_F(RenderTest, FurnaceIsOneFromInsideTheMedium) {
  const std::string options = "--albedo 1 --environment 1 --look-at 0.1,0.2,0.3 --density-scale 3";
  expect_mean_one(render(options + " --spp 64"), options);
  for (const auto& z : compare("picture.exr", "constant:1")["z"]) {
    EXPECT_LT(std::abs(z.get<double>()), 4.5);
  }
}

TEST_F(RenderTest, ThreadsBatchAndInstructionsChangeNoBit) {
  const Image reference = render("--threads 1 --simd best");
  for (const char* options : {"--threads 2", "--batch 1", "--threads 2 --batch 333"}) {
    EXPECT_EQ(render(options).values, reference.values) << options;
  }
  for (const Simd simd : available_simd()) {
    const std::string name(to_string(simd));
    EXPECT_EQ(render("--simd " + name).values, reference.values) << name;
  }
}

TEST_F(RenderTest, AChromaticPictureIsTheSameOnAnyThreadsToo) {
  const std::string optics = "--sigma-s 4,1,0.25 --sigma-a 0.02,0.2,1 ";
  const Image reference = render(optics + "--threads 1");
  EXPECT_EQ(render(optics + "--threads 2 --batch 64").values, reference.values);
}

TEST_F(RenderTest, SeedsMakeOtherPicturesOfTheSameMean) {
  EXPECT_NE(render("--seed 1 --spp 32", "a.exr").values,
            render("--seed 2 --spp 32", "b.exr").values);
  const json difference = compare("a.exr", "b.exr");
  for (const auto& z : difference["z"]) EXPECT_LT(std::abs(z.get<double>()), 4.5);
}

TEST_F(RenderTest, MoreSamplesContinueTheSameSequence) {
  EXPECT_EQ(render("--spp 5").values, render("--spp 5 --time 1000").values);
}

TEST_F(RenderTest, TakesTheOptionsOfCameraAndLight) {
  write_environment(path("sky.exr"), 1, 2);
  for (const char* options :
       {"--up z --environment sky.exr --fov 90", "--look-at 3,2,1 --environment sky --sun none",
        "--look-at 0,9,0,0,0,0 --environment 1,2,3 --sun 30,100 --grid density",
        "--turbidity 5 --sun 10,20 --exposure -2 --grid 0 --negative clamp --super-voxel 8"}) {
    for (const float value : render(options).values) ASSERT_TRUE(std::isfinite(value)) << options;
  }
}

TEST_F(RenderTest, UpTurnsTheFramedView) {
  EXPECT_NE(render("--up y").values, render("--up z").values);
}

TEST_F(RenderTest, AVolumeFarAwayIsFramedAndRenderedAsOneNearby) {
  write_cube(path("far.vdb"), ball, eighths() * Matrix4d().setTranslation(Vec3d(1e9, -1e9, 1e6)));
  for (const char* files : {"ball.vdb -o ball.exr", "far.vdb -o far.exr"}) {
    const Outcome outcome =
        run(std::string("render --size 24x16 --spp 64 --density-scale 2 ") + files);
    EXPECT_EQ(outcome.status, 0) << outcome;
  }
  const Image near = read_image(path("ball.exr"));
  const Image far = read_image(path("far.exr"));
  const int alpha = find_channel(near, "A").value();
  double sums[2] = {};
  for (std::size_t i = alpha; i < near.values.size(); i += near.channels.size()) {
    sums[0] += near.values[i];
    sums[1] += far.values[i];
  }
  EXPECT_GT(sums[0], 30);
  EXPECT_NEAR(sums[1], sums[0], 1e-3 * sums[0]);
  for (const auto& z : compare("ball.exr", "far.exr")["z"]) {
    EXPECT_LT(std::abs(z.get<double>()), 4.5);
  }
}

TEST_F(RenderTest, TimeEndsIt) {
  const Outcome outcome = run(
      "render ball.vdb -o picture.exr --size 16x16 --time 1 --stats stats.json", counted_clock());
  EXPECT_EQ(outcome.status, 0) << outcome;
  EXPECT_GT(read_json("stats.json")["samples"], 1);
  EXPECT_NEAR(read_json("stats.json")["seconds"]["render"], 1, 0.3);
  for (const float value : read_image(path("picture.exr")).values) {
    ASSERT_TRUE(std::isfinite(value));
  }
}

TEST_F(RenderTest, ALimitOfScatteringsThatMattersIsTold) {
  const std::string all = "render ball.vdb -o picture.exr --spp 1 --size 32x32 --albedo 1";
  const Outcome limited = run(all + " --max-scatterings 1 --stats stats.json");
  EXPECT_EQ(limited.status, 0) << limited;
  EXPECT_NE(limited.messages.find("1 sample per pixel in "), std::string::npos) << limited;
  EXPECT_NE(limited.messages.find("note: "), std::string::npos) << limited;
  EXPECT_NE(limited.messages.find("at the limit of 1 scattering,"), std::string::npos) << limited;
  EXPECT_NE(limited.messages.find("--max-scatterings 100"), std::string::npos) << limited;
  EXPECT_GT(read_json("stats.json")["cut_share"].get<double>(), 0.005);
  const Outcome whole = run(all);
  EXPECT_EQ(whole.messages.find("note: "), std::string::npos) << whole;
}

/// Options under which paths that meet the ball take minutes.
constexpr const char* kThick = " --albedo 1 --density-scale 1e5 ";

TEST_F(RenderTest, TimeEndsAPictureWithoutAllItsPixelsAndSaysSo) {
  const Outcome outcome = run(std::string("render ball.vdb -o picture.exr --stats stats.json") +
                                  kThick + "--size 300x300 --time 1 --environment 1",
                              counted_clock(0.05));
  EXPECT_EQ(outcome.status, program::kPartialStatus) << outcome;
  EXPECT_EQ(files(),
            (std::vector<std::string>{"ball.vdb", "picture.partial.exr", "stats.partial.json"}));
  const json stats = read_json("stats.partial.json");
  const auto missing = stats["pixels_without_samples"].get<int64_t>();
  EXPECT_GT(missing, 0);
  EXPECT_EQ(stats["samples"], 0);
  EXPECT_EQ(stats["most_samples"], 1);
  EXPECT_NE(outcome.messages.find("warning: " + std::to_string(missing) +
                                  " of 90000 pixels have no sample"),
            std::string::npos)
      << outcome;
  const Image image = read_image(path("picture.partial.exr"));
  EXPECT_EQ(metadata(image, "freepath:pixels_without_samples"), MetadataValue(missing));
  EXPECT_EQ(metadata(image, "freepath:samples"), MetadataValue(int64_t{0}));
  // Every pixel that has a sample sees light.
  const int red = find_channel(image, "R").value();
  int64_t black = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      black += image.pixel(column, row)[red] == 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(black, missing);
}

// A camera in the midst: no path ends in years.
TEST_F(RenderTest, APictureWithoutAnySampleIsNotWritten) {
  write_text(path("picture.exr"), "an older picture");
  const Outcome outcome = run(std::string("render ball.vdb -o picture.exr --stats stats.json") +
                                  kThick + "--size 8x8 --time 0.5 --look-at 0,0,0,1,0,0",
                              counted_clock(0.02));
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("--time"), std::string::npos) << outcome;
  EXPECT_EQ(files(), (std::vector<std::string>{"ball.vdb", "picture.exr"}));
  EXPECT_EQ(std::filesystem::file_size(path("picture.exr")), 16U);
}

TEST_F(RenderTest, CtrlCEndsPathsThatWouldTakeYears) {
  bool interrupted = false;
  const Outcome outcome =
      start_in_terminal(words(std::string("render ball.vdb -o picture.exr") + kThick +
                              "--size 8x8 --look-at 0,0,0,1,0,0"),
                        folder_, [&](const std::string& text, int process) {
                          if (interrupted || text.find("samples/s") == std::string::npos) return;
                          interrupted = true;
                          kill(process, SIGINT);
                        });
  ASSERT_TRUE(interrupted) << outcome;
  EXPECT_EQ(outcome.status, 1) << outcome;
  EXPECT_NE(outcome.messages.find("interrupted"), std::string::npos) << outcome;
  EXPECT_EQ(files(), (std::vector<std::string>{"ball.vdb"}));
}

TEST_F(RenderTest, AProgressBarIsForTerminalsAlone) {
  const Outcome outcome = run("render ball.vdb -o picture.exr --size 64x64 --spp 64");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.messages.find('\r'), std::string::npos) << outcome.messages;
  EXPECT_EQ(outcome.messages.find('\x1b'), std::string::npos) << outcome.messages;
  EXPECT_NE(outcome.messages.find("wrote picture.exr"), std::string::npos) << outcome.messages;
}

TEST_F(RenderTest, CtrlCEndsItAndStillWrites) {
  bool interrupted = false;
  const Outcome outcome = start_in_terminal(
      words("render ball.vdb -o picture.exr --stats stats.json --size 64x64 --spp 100000000 "
            "--albedo 1 --environment 1"),
      folder_, [&](const std::string& text, int process) {
        if (interrupted || samples_shown(text) < 2) return;  // from 2 on, each pixel has one
        interrupted = true;
        kill(process, SIGINT);
      });
  EXPECT_TRUE(interrupted) << outcome;
  EXPECT_EQ(outcome.status, program::kPartialStatus) << outcome;
  EXPECT_NE(outcome.messages.find("interrupted after"), std::string::npos) << outcome;
  EXPECT_EQ(files(),
            (std::vector<std::string>{"ball.vdb", "picture.partial.exr", "stats.partial.json"}));
  EXPECT_GE(read_json("stats.partial.json")["samples"], 0);
  const Image image = read_image(path("picture.partial.exr"));
  for (const float value : image.values) ASSERT_TRUE(std::isfinite(value));
  expect_mean_one(image, "interrupted");
}

}  // namespace
}  // namespace freepath::testing
