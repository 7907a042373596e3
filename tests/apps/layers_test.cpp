// Layers, crops and the denoiser of freepath render, for volumes and scenes.

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "freepath/io/image.h"
#include "tests/apps/program.h"
#include "tests/apps/scene_files.h"

namespace freepath::testing {
namespace {

/// Glowing fog with a diffuse ball and a lamp in it.
constexpr const char* kScene = R"(
Film "FILM" "integer xresolution" 24 "integer yresolution" 16 WINDOW
Sampler "independent" "integer pixelsamples" 5
Integrator "volpath" "integer maxdepth" 20
PixelFilter "box"
LookAt 0 0 6  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [0.5 1 1.5]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [1.5 0.7 0.2]
  "rgb sigma_a" [0.1 0.3 0.1] "rgb Le" [0.4 0.2 0.1]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Shape "sphere" "float radius" 1.3
AttributeEnd
AttributeBegin
  Translate 0.5 0.3 0
  Material "diffuse" "rgb reflectance" [0.8 0.3 0.2]
  Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [3 2 1]
  Translate -0.6 -0.3 0
  Shape "sphere" "float radius" 0.3
AttributeEnd
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

float value(const Image& image, const std::string& channel, std::size_t pixel) {
  return image.values[pixel * image.channels.size() + find_channel(image, channel).value()];
}

/// That a picture is a part of another one, bit for bit.
void expect_part(const Image& part, const Image& whole) {
  ASSERT_EQ(part.channels, whole.channels);
  EXPECT_EQ(part.full_width, whole.width);
  EXPECT_EQ(part.full_height, whole.height);
  for (int row = 0; row < part.height; ++row) {
    const float* const begin = part.pixel(0, row);
    EXPECT_TRUE(std::equal(begin, begin + part.width * part.channels.size(),
                           whole.pixel(part.x, part.y + row)))
        << "row " << row;
  }
}

class LayersTest : public ProgramTest {
 protected:
  LayersTest() {
    write_cube(path("ball.vdb"));
    write_scene("fog.pbrt", "rgb");
  }

  void write_scene(const std::string& name, const std::string& film,
                   const std::string& window = "") const {
    write_text(path(name), replaced(replaced(kScene, "FILM", film), "WINDOW", window));
  }
  Image render(const std::string& line) const {
    const Outcome outcome = run("render " + line + " -o picture.exr");
    EXPECT_EQ(outcome.status, 0) << line << '\n' << outcome;
    return read_image(path("picture.exr"));
  }
  void expect_refused(const std::string& line, const std::string& message) const {
    const Outcome outcome = run("render " + line + " -o refused.exr");
    EXPECT_NE(outcome.status, 0) << line;
    EXPECT_NE(outcome.messages.find(message), std::string::npos) << line << '\n' << outcome;
    EXPECT_FALSE(std::filesystem::exists(path("refused.exr")));
  }
};

TEST_F(LayersTest, PartsOfTheLightOfASceneAddUp) {
  for (const char* how : {"--color rgb", "--color rgb --tracker delta", "--color spectral",
                          "--color spectral --tracker delta"}) {
    SCOPED_TRACE(how);
    // The shares of pixels would differ, as the noise does.
    const std::string scene = "fog.pbrt --layers all --no-adaptive " + std::string(how);
    const Image all = render(scene);
    const Image single = render(scene + " --max-scatterings 1");
    double indirect = 0;
    for (std::size_t i = 0; i < all.pixel_count(); ++i) {
      for (const std::string c : {"R", "G", "B"}) {
        const float whole = value(all, c, i);
        const float unscattered = value(all, "emission." + c, i) + value(all, "background." + c, i);
        const float once = unscattered + value(all, "direct." + c, i);
        // Wavelengths may have negative colours, which cancel.
        const float tolerance = 1e-4F * std::abs(whole) + 1e-4F;
        EXPECT_NEAR(once + value(all, "indirect." + c, i), whole, tolerance);
        EXPECT_NEAR(once, value(single, c, i), tolerance);
        indirect += value(all, "indirect." + c, i);
      }
    }
    EXPECT_GT(indirect, 1);
  }
}

TEST_F(LayersTest, OfASceneMeanWhatTheyAreCalled) {
  for (const char* how :
       {"--color rgb", "--color spectral --spp 64", "--color rgb --tracker delta"}) {
    SCOPED_TRACE(how);
    const Image image = render("fog.pbrt --layers all " + std::string(how));
    // Beside the fog there is nothing but what is around.
    const float outside[] = {0.5F, 1.0F, 1.5F};
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
      const std::string name = names[c];
      EXPECT_NEAR(value(image, "transmittance." + name, 0), 1, 0.02);
      EXPECT_NEAR(value(image, "background." + name, 0), outside[c], 0.03);
      EXPECT_EQ(value(image, "emission." + name, 0), 0);
      EXPECT_EQ(value(image, "direct." + name, 0), 0);
    }
    EXPECT_NEAR(value(image, "A", 0), 0, 1e-6);
    EXPECT_EQ(value(image, "normal.Z", 0), 0);
    // The middle looks through fog at a ball: things face the camera, in front of its middle.
    const std::size_t middle = 8 * 24 + 13;
    EXPECT_GT(value(image, "normal.Z", middle), 0.3);
    EXPECT_NEAR(value(image, "position.Z", middle), 6 - value(image, "depth.Z", middle), 0.1);
    EXPECT_GT(value(image, "transmittance.B", middle), 0.1);
    EXPECT_LT(value(image, "transmittance.R", middle), 0.9);
  }
}

TEST_F(LayersTest, AreThoseAskedFor) {
  const auto channels = [&](const std::string& line) {
    std::vector<std::string> names = render(line).channels;
    std::sort(names.begin(), names.end());
    return names;
  };
  const std::string ball = "ball.vdb --size 8x4 --spp 1 --layers ";
  EXPECT_EQ(channels(ball + "none"), (std::vector<std::string>{"A", "B", "G", "R"}));
  EXPECT_EQ(channels(ball + "depth,normal"),
            (std::vector<std::string>{"A", "B", "G", "R", "depth.Z", "normal.X", "normal.Y",
                                      "normal.Z"}));
  EXPECT_EQ(channels(ball + "all").size(), 40U);
  expect_refused(ball + "norml", "did you mean 'normal'");
}

TEST_F(LayersTest, AGbufferFilmHasAllOfThem) {
  write_scene("gbuffer.pbrt", "gbuffer");
  EXPECT_EQ(render("gbuffer.pbrt").channels.size(), 40U);
  EXPECT_EQ(render("gbuffer.pbrt --layers none").channels.size(), 4U);
  EXPECT_LT(render("fog.pbrt").channels.size(), 40U);
}

TEST_F(LayersTest, ACropIsThePartOfThePicture) {
  const std::string ball = "ball.vdb --size 24x16 --spp 3 --layers all";
  const Image whole = render(ball);
  for (const char* crop : {"6,4,18,8", "0.25,0.25,0.75,0.5"}) {
    const Image part = render(ball + " --crop " + crop + " -o part.png");
    EXPECT_EQ(part.x, 6);
    EXPECT_EQ(part.y, 4);
    expect_part(part, whole);
    const Image png = read_image(path("part.png"));
    EXPECT_EQ(png.width, 12);
    EXPECT_EQ(png.height, 4);
  }
  expect_refused(ball + " --crop 6,4,18", "--crop");
  expect_refused(ball + " --crop 6,4,6,8", "no pixel");
  expect_refused(ball + " --crop 6,4,25,8", "not within");
  expect_refused(ball + " --crop 0.5,0,2,1", "fractions");
}

TEST_F(LayersTest, ASceneIsCroppedByItsFilmOrByTheOption) {
  for (const char* color : {" --color rgb", " --color spectral"}) {
    const Image whole = render(std::string("fog.pbrt") + color);
    const Image part = render(std::string("fog.pbrt --crop 6,4,18,8") + color);
    expect_part(part, whole);
    write_scene("window.pbrt", "rgb", R"("float cropwindow" [0.25 0.75 0.25 0.5])");
    const Image window = render(std::string("window.pbrt") + color);
    EXPECT_EQ(window.values, part.values);
    EXPECT_EQ(window.x, 6);
    EXPECT_EQ(window.y, 4);
    write_scene("bounds.pbrt", "rgb", R"("integer pixelbounds" [6 18 4 8])");
    EXPECT_EQ(render(std::string("bounds.pbrt") + color).values, part.values);
    EXPECT_EQ(render(std::string("bounds.pbrt --crop 0,0,24,16") + color).values, whole.values);
  }
  write_scene("empty.pbrt", "rgb", R"("float cropwindow" [0.5 0.5 0 1])");
  expect_refused("empty.pbrt", "empty.pbrt:2:");
}

TEST_F(LayersTest, DenoisesTheColourWithAlbedoAndNormal) {
  setenv("LD_LIBRARY_PATH", FREEPATH_FAKE_DENOISER, 1);
  const Outcome outcome =
      start("render ball.vdb --size 12x8 --spp 4 --layers all --denoise -o picture.exr");
  const Outcome plain =
      start("render ball.vdb --size 12x8 --spp 4 --layers none --denoise -o plain.exr");
  unsetenv("LD_LIBRARY_PATH");
  ASSERT_EQ(outcome.status, 0) << outcome;
  ASSERT_EQ(plain.status, 0) << plain;
  const Image image = read_image(path("picture.exr"));
  EXPECT_EQ(image.channels.size(), 43U);
  const char* const colours[] = {"R", "G", "B"};
  const char* const axes[] = {"X", "Y", "Z"};
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const std::string name = colours[c];
      // The background is kept from it.
      const float background = value(image, "background." + name, i);
      const float inside = std::max(0.0F, value(image, "noisy." + name, i) - background);
      const float expected = background + 2 * inside + value(image, "albedo." + name, i) +
                             value(image, std::string("normal.") + axes[c], i);
      EXPECT_NEAR(value(image, name, i), expected, 1e-5F * (1 + expected));
    }
  }
  // What the denoiser looks at is not written unless it is asked for.
  const Image without = read_image(path("plain.exr"));
  EXPECT_EQ(without.channels.size(), 7U);
  EXPECT_EQ(value(without, "R", 40), value(image, "R", 40));
}

TEST_F(LayersTest, DenoisesAlphaOfWhatIsTransparent) {
  setenv("LD_LIBRARY_PATH", FREEPATH_FAKE_DENOISER, 1);
  const Outcome outcome =
      start("render ball.vdb --size 12x8 --spp 4 --layers all --denoise --transparent -o a.exr");
  unsetenv("LD_LIBRARY_PATH");
  ASSERT_EQ(outcome.status, 0) << outcome;
  const Image image = read_image(path("a.exr"));
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float red = 2 * std::max(0.0F, value(image, "noisy.R", i)) + value(image, "albedo.R", i) +
                      value(image, "normal.X", i);
    EXPECT_NEAR(value(image, "R", i), red, 1e-5F * (1 + red));
    const float alpha =
        2 * value(image, "noisy.A", i) + value(image, "albedo.R", i) + value(image, "normal.X", i);
    EXPECT_NEAR(value(image, "A", i), std::clamp(alpha, 0.0F, 1.0F), 1e-5F);
  }
}

// Over a plate of the environment's light it is the picture with the environment behind it.
TEST_F(LayersTest, TransparentPicturesAreThoseWithoutABackground) {
  write_scene("fog.pbrt", "rgb");
  for (const std::string render :
       {"render ball.vdb --size 12x8 --spp 4 --environment 1 --sun none --albedo 0.7",
        "render fog.pbrt --spp 4 --environment 1 --color spectral"}) {
    ASSERT_EQ(run(render + " --layers all -o whole.exr").status, 0);
    ASSERT_EQ(run(render + " --layers all --transparent -o over.exr").status, 0);
    const Image whole = read_image(path("whole.exr"));
    const Image over = read_image(path("over.exr"));
    double seen = 0;
    for (std::size_t i = 0; i < over.pixel_count(); ++i) {
      for (const std::string c : {"R", "G", "B"}) {
        const float background = value(whole, "background." + c, i);
        EXPECT_NEAR(value(over, c, i) + background, value(whole, c, i), 1e-5F);
        EXPECT_EQ(value(over, "A", i), value(whole, "A", i));
        // The layer is there for those who want the light back.
        EXPECT_EQ(value(over, "background." + c, i), background);
        seen += background;
      }
      if (render.find("ball") != std::string::npos) {
        EXPECT_NEAR(value(over, "G", i) + (1 - value(over, "A", i)), value(whole, "G", i), 1e-5F);
      }
    }
    EXPECT_GT(seen, 1);
  }
}

TEST_F(LayersTest, WritesTheFormsOfExrThatAreAskedFor) {
  const std::string render = "render ball.vdb --size 32x24 --spp 4 --layers all -o ";
  ASSERT_EQ(run(render + "a.exr").status, 0);
  const Image exact = read_image(path("a.exr"));
  for (const std::string form :
       {"half", "float,piz", "zips,half", "half,dwaa:20", "dwab", "none"}) {
    ASSERT_EQ(run(fmt::format("{}b.exr --exr {}", render, form)).status, 0) << form;
    const Image image = read_image(path("b.exr"));
    ASSERT_EQ(image.channels, exact.channels) << form;
    const bool is_exact = form == "float,piz" || form == "none";
    EXPECT_EQ(image.values == exact.values, is_exact) << form;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      const std::string& channel = image.channels[i % image.channels.size()];
      const bool is_kept = channel == "depth.Z" || channel.starts_with("position.") ||
                           channel.starts_with("variance.") || channel == "samples";
      // Lossy compression is for 16 and 32 bits alike, but for channels that aren't colours.
      const float tolerance = form.find("dwa") == std::string::npos ? 0.001F : 0.1F;
      if (is_kept && tolerance < 0.01F) {
        EXPECT_EQ(image.values[i], exact.values[i]) << form << channel;
      }
      EXPECT_NEAR(image.values[i], exact.values[i], tolerance * (0.1F + std::abs(exact.values[i])))
          << form << channel;
    }
  }
  for (const std::string wrong : {"quarter", "half:3", "dwaa:x", "half,", "dwaa:-1"}) {
    const Outcome outcome = run(fmt::format("{}c.exr --exr {}", render, wrong));
    EXPECT_EQ(outcome.status, 1) << wrong << outcome;
    EXPECT_NE(outcome.messages.find("--exr"), std::string::npos) << wrong << outcome;
  }
}

TEST_F(LayersTest, SaysHowToGetADenoiserBeforeRendering) {
  for (const char* name : {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                           "libOpenImageDenoise.so.0", "libOpenImageDenoise.so"}) {
    if (dlopen(name, RTLD_NOW) != nullptr) GTEST_SKIP() << name << " is installed";
  }
  for (const char* input : {"ball.vdb --size 4096x4096", "fog.pbrt"}) {
    expect_refused(std::string(input) + " --denoise", "pip install --no-deps pyoidn");
  }
}

TEST_F(LayersTest, FindsADenoiserWhereTheEnvironmentSays) {
  namespace fs = std::filesystem;
  const std::string library = "libOpenImageDenoise.so.2";
  const std::string inside = "env/lib/python3.11/site-packages/pyoidn/oidn/lib/";
  fs::create_directories(path(inside));
  fs::copy(fs::path(FREEPATH_FAKE_DENOISER) / library, path(inside + library));
  const std::string render =
      " freepath render ball.vdb --size 4x4 --spp 1 --denoise -o picture.exr";
  for (const std::string options :
       {"FREEPATH_OIDN=env", "FREEPATH_OIDN=$PWD/env", "VIRTUAL_ENV=$PWD/env"}) {
    EXPECT_EQ(shell(options + render).status, 0) << options;
  }
  EXPECT_EQ(shell("FREEPATH_OIDN=" + inside + library + render).status, 0);
  EXPECT_EQ(shell("FREEPATH_OIDN=" + inside + render).status, 0);
  for (const char* wrong : {"none", "env/lib", "ball.vdb"}) {
    const Outcome outcome = shell(std::string("FREEPATH_OIDN=") + wrong + render);
    EXPECT_EQ(outcome.status, 1) << wrong;
    EXPECT_NE(outcome.messages.find(std::string("FREEPATH_OIDN is ") + wrong), std::string::npos)
        << outcome;
  }
}

// With the real library, where the environment names one.
TEST_F(LayersTest, DenoisesByTheRealLibrary) {
  const char* const library = getenv("FREEPATH_TEST_OIDN");
  if (library == nullptr) GTEST_SKIP() << "FREEPATH_TEST_OIDN names no Open Image Denoise";
  setenv("FREEPATH_OIDN", library, 1);
  const auto noise = [&](const char* options) {
    const Outcome outcome =
        start(std::string("render ball.vdb --size 64x64 --spp 4 -o picture.exr ") + options);
    EXPECT_EQ(outcome.status, 0) << outcome;
    const Outcome reference = start("render ball.vdb --size 64x64 --spp 512 --seed 1 -o many.exr");
    EXPECT_EQ(reference.status, 0) << reference;
    const Outcome difference = start("diff picture.exr many.exr --json");
    return nlohmann::json::parse(difference.output)["mse"].get<double>();
  };
  const double noisy = noise("");
  EXPECT_LT(noise("--denoise"), 0.5 * noisy);
}

}  // namespace
}  // namespace freepath::testing
