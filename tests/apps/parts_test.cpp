// Parts of pictures: ranges of samples, tiles and crops, merged.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/io/image.h"
#include "tests/apps/films.h"

namespace freepath::testing {
namespace {

namespace fs = std::filesystem;

class PartsTest : public FilmsTest {
 protected:
  void write_scene() const {
    write_text(path("room.pbrt"), R"(
      Film "spectral" "integer xresolution" 24 "integer yresolution" 18 "integer nbuckets" 5
        "string filename" "room.exr"
      Sampler "zsobol" "integer pixelsamples" 17 "integer seed" 3
      LookAt 0 1 6  0 0 0  0 1 0
      Camera "perspective" "float fov" 35
      WorldBegin
      LightSource "distant" "point3 from" [ 2 3 4 ] "rgb L" [ 3 2 1 ]
      LightSource "infinite" "rgb L" [ 0.2 0.4 0.8 ]
      MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 0.9 0.5 0.2 ]
        "rgb sigma_a" [ 0.1 0.1 0.3 ] "float g" 0.5
      AttributeBegin
        MediumInterface "fog" ""
        Material "interface"
        Shape "sphere" "float radius" 1.2
      AttributeEnd
      Translate 0 -1.5 0
      Material "diffuse" "rgb reflectance" [ 0.7 0.4 0.3 ]
      Shape "sphere" "float radius" 0.8
    )");
  }
};

/// Cuts a picture at random: tiles, and ranges of samples of each.
class RandomParts {
 public:
  RandomParts(uint32_t trial, uint32_t samples) : random_(17, trial, 0, 0), samples_(samples) {}

  /// Options of the parts, in any order.
  std::vector<std::string> options() {
    std::vector<std::string> parts;
    const uint32_t tiles = 1 + below(below(2) == 0 ? 2 : 9);
    for (uint32_t tile = 1; tile <= tiles; ++tile) {
      const uint32_t most = 1 + below(samples_);
      for (uint32_t first = 0; first < samples_;) {
        const uint32_t last = std::min(samples_, first + 1 + below(most)) - 1;
        parts.push_back("--tiles " + std::to_string(tile) + "/" + std::to_string(tiles) +
                        " --samples " + std::to_string(first) + "-" + std::to_string(last) + how());
        first = last + 1;
      }
    }
    parts.resize(std::min<std::size_t>(parts.size(), 64));
    for (std::size_t i = parts.size(); i > 1; --i) std::swap(parts[i - 1], parts[below(i)]);
    return parts;
  }

 private:
  uint32_t below(std::size_t end) {
    return std::min(static_cast<uint32_t>(random_.uniform() * end), static_cast<uint32_t>(end - 1));
  }
  /// On what a part runs.
  std::string how() {
    const char* const simd[] = {" --simd sse4", " --simd avx2", " --simd best"};
    const char* const threads[] = {" --threads 1", " --threads 2"};
    return simd[below(3)] + std::string(threads[below(2)]) + " --batch " +
           std::to_string(1 + below(300));
  }

  RandomStream random_;
  uint32_t samples_;
};

TEST_F(PartsTest, AnyPartsMergeToTheBitsOfOneProcess) {
  write_scene();
  struct RenderTarget {
    std::string render;
    uint32_t samples;
  };
  const std::vector<RenderTarget> targets = {
      {"render ball.vdb --size 24x18 --sun 30,60 --albedo 0.9 --g 0.6 --layers all", 13},
      {"render room.pbrt --color rgb --layers all", 17},
      {"render room.pbrt --color spectral --layers default,halves", 17}};
  for (const RenderTarget& target : targets) {
    expect_done(target.render + " --spp " + std::to_string(target.samples) +
                " -o whole.exr -o whole.film");
    for (int trial = 0; trial < trials(3); ++trial) {
      const std::vector<std::string> parts =
          RandomParts(static_cast<uint32_t>(trial), target.samples).options();
      std::string merge = "merge";
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::string name = "part" + std::to_string(i) + ".film";
        expect_done(target.render + " " + parts[i] + " -o " + name);
        merge += " " + name;
      }
      if (parts.size() == 64) merge += " --partial";  // some were left out
      expect_done(merge + " -o merged.exr -o merged.film");
      if (parts.size() == 64) continue;
      expect_same_pixels("merged.exr", "whole.exr");
      if (HasFatalFailure()) return;
    }
  }
}

TEST_F(PartsTest, ACropIsAPartOfThePicture) {
  const std::string render = "render ball.vdb --size 24x18 ";
  expect_done(render + "--spp 4 -o whole.exr");
  expect_done(render + "--spp 4 --crop 0,0,10,18 -o left.film");
  expect_done(render + "--spp 4 --crop 10,0,24,18 -o right.film");
  expect_done("merge right.film left.film -o merged.exr");
  expect_same_pixels("merged.exr", "whole.exr");
}

TEST_F(PartsTest, PartsThatDoNotFitAreNamed) {
  const std::string render = "render ball.vdb --size 24x18 ";
  expect_done(render + "--samples 0-3 -o a.film");
  expect_done(render + "--samples 4-7 -o b.film");
  expect_done(render + "--samples 2-5 -o overlapping.film");
  expect_done(render + "--samples 6-7 -o late.film");
  expect_done(render + "--samples 4-7 --seed 2 -o seed.film");
  expect_done(render + "--samples 4-7 --g 0.5 -o g.film");
  expect_done(render + "--samples 4-7 --tracker weighted-delta -o tracker.film");
  expect_done(render + "--samples 4-7 --layers all -o layers.film");
  expect_done(render + "--samples 4-7 --tiles 1/2 -o tile.film");
  expect_done("render ball.vdb --size 24x19 --samples 4-7 -o size.film");
  write_cube(path("ball.vdb"), [](const Vec3i& voxel) { return 2 * ball(voxel); });
  expect_done(render + "--samples 4-7 -o content.film");
  expect_refused("merge a.film overlapping.film -o m.exr",
                 "a.film and overlapping.film overlap: both have samples 2 to 3 of pixel (0, 0)");
  expect_refused("merge a.film late.film -o m.exr", "no part has samples 4 to 5 of pixel (0, 0)");
  expect_refused("merge b.film -o m.exr", "no part has samples 0 to 3");
  expect_refused("merge a.film tile.film -o m.exr", "samples 4 to 7 of pixel (0, 9)");
  expect_refused("merge a.film seed.film -o m.exr",
                 "seed.film: is no part of the same picture as "
                 "a.film: its seed is 2 and not 0");
  expect_refused("merge a.film g.film -o m.exr", "--g is 0.5 and not not given");
  expect_refused("merge a.film tracker.film -o m.exr", "tracker is weighted-delta and not delta");
  expect_refused("merge a.film layers.film -o m.exr", "its layers are others");
  expect_refused("merge a.film size.film -o m.exr", "its width and height are others");
  expect_refused("merge a.film content.film -o m.exr", "the content of ball.vdb is");
  expect_refused("merge a.film ball.vdb -o m.exr", "ball.vdb: it is no film");
  expect_refused("merge a.film none.film -o m.exr", "none.film: no such file");
  EXPECT_FALSE(fs::exists(path("m.exr")));
  expect_done("merge a.film late.film -o m.exr --partial");
}

// A sequence is framed from its first frame: parts of a frame may have been seen from elsewhere.
TEST_F(PartsTest, PartsSeenFromElsewhereDoNotFit) {
  write_cube(path("s.1.vdb"), [](const Vec3i& voxel) { return voxel.x < 0 ? ball(voxel) : 0.0F; });
  fs::copy(path("ball.vdb"), path("s.2.vdb"));
  const std::string render = "render s.%d.vdb --size 24x18 --ground 0.2 ";
  expect_done(render + "--frames 1-2 --samples 0-3 -o a.%d.film");
  expect_done(render + "--frames 2 --samples 4-7 -o b.%d.film");
  expect_refused("merge a.2.film b.2.film -o m.exr", "the camera's place is");
}

TEST_F(PartsTest, OptionsThatContradictEachOtherAreRefused) {
  const std::string render = "render ball.vdb --size 8x6 -o a.film ";
  expect_refused(render + "--samples 0-3 --spp 4", "--samples and --spp");
  expect_refused(render + "--samples 3-1", "--samples: '3-1'");
  expect_refused(render + "--samples 3", "--samples: '3'");
  expect_refused(render + "--tiles 0/2", "--tiles: '0/2'");
  expect_refused(render + "--tiles 3/2", "--tiles: '3/2'");
  expect_refused(render + "--tiles 1/7", "7 tiles of 6 rows");
  expect_refused(render + "--noise 0.1 --tiles 1/2", "--noise and --tiles");
  expect_refused(render + "--checkpoint a.exr", "has not the extension of a film");
  expect_refused(render + "--every 3", "--checkpoint FILE.film");
  expect_refused(render + "--resume none.film", "none.film: no such file");
  expect_refused(render + "--checkpoint none/a.film", "the folder none does not exist");
}

// The mean of all samples, and its variance, as if they were of one picture.
TEST_F(PartsTest, AveragesOfSeedsHaveTheirWeightsAndVariances) {
  const std::string render = "render ball.vdb --size 12x9 --sun 30,60 ";
  expect_done(render + "--spp 64 --seed 1 -o a.exr -o a.film");
  expect_done(render + "--spp 192 --seed 2 -o b.exr -o b.film");
  expect_refused("merge a.film b.film -o m.exr", "its seed is 2 and not 1");
  expect_done("merge a.film b.film --average -o m.exr");
  const Image a = read_image(path("a.exr"));
  const Image b = read_image(path("b.exr"));
  const Image m = read_image(path("m.exr"));
  const auto value = [](const Image& image, int i, const char* channel) {
    return double{image.pixel(i % 12, i / 12)[*find_channel(image, channel)]};
  };
  for (int i = 0; i < 12 * 9; ++i) {
    const double of_a = value(a, i, "samples");
    const double of_b = value(b, i, "samples");
    const double of_both = of_a + of_b;
    EXPECT_EQ(value(m, i, "samples"), of_both);
    EXPECT_NEAR(value(m, i, "G"), (of_a * value(a, i, "G") + of_b * value(b, i, "G")) / of_both,
                1e-6);
    // Sums of squares about each mean, and between the means.
    const double within = value(a, i, "variance.G") * of_a * (of_a - 1) +
                          value(b, i, "variance.G") * of_b * (of_b - 1);
    const double apart = value(a, i, "G") - value(b, i, "G");
    const double expected =
        (within + of_a * of_b / of_both * apart * apart) / (of_both - 1) / of_both;
    EXPECT_NEAR(value(m, i, "variance.G"), expected, 1e-4 * expected + 1e-12);
  }
}

TEST_F(PartsTest, ADamagedFilmIsAnErrorWhereverItIsDamaged) {
  expect_done("render ball.vdb --size 5x4 --spp 2 --layers all -o a.film");
  std::string bytes;
  {
    std::ifstream stream(path("a.film"), std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
  }
  const auto check = [&](const std::string& damaged, const std::string& how) {
    write_text(path("b.film"), damaged);
    const Outcome outcome = run("merge b.film -o m.exr");
    EXPECT_EQ(outcome.status, 1) << how << outcome;
    EXPECT_NE(outcome.messages.find("b.film: "), std::string::npos) << how << outcome;
  };
  for (std::size_t size = 0; size < bytes.size(); size += size < 64 ? 1 : 37) {
    check(bytes.substr(0, size), "cut at " + std::to_string(size));
  }
  for (std::size_t at = 0; at < bytes.size(); at += at < 64 ? 1 : 29) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
    check(damaged, "changed at " + std::to_string(at));
  }
  check(bytes + "x", "longer");
  EXPECT_FALSE(fs::exists(path("m.exr")));
}

}  // namespace
}  // namespace freepath::testing
