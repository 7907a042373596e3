// What is said of scenes that cannot be rendered: one error, that begins with its place and names
// the trouble; and of those that are rendered otherwise than their authors may think.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "freepath/base/error.h"
#include "freepath/scene/assembly/scene_builder.h"
#include "tests/io/volume_oddities.h"
#include "tests/scene/scenes_in_memory.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

/// The message of the error that building ends with; empty if there is none.
std::string message_of(const std::string& text) {
  Diagnostics diagnostics;
  try {
    const PbrtScene pbrt = parse(text, diagnostics);
    build_scene(pbrt, diagnostics);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

struct BrokenScene {
  const char* text;
  const char* location;  // line:column
  const char* words;
};

void expect_error(const std::string& text, const std::string& location, const std::string& words) {
  const std::string message = message_of(text);
  const std::string begin = "scene.pbrt:" + location + ": ";
  EXPECT_EQ(message.substr(0, begin.size()), begin) << text << "\n  " << message;
  EXPECT_NE(message.find(words), std::string::npos) << text << "\n  " << message;
  EXPECT_EQ(message.find("scene.pbrt", 1), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// Statements before the world.
const BrokenScene kPictures[] = {
    {R"(Camera "perspectiv")", "1:1", "did you mean 'perspective'?"},
    {R"(Camera "realistic")", "1:1",
     "there is no camera of type 'realistic'; there are: perspective"},
    {R"(Camera "perspective" "float fov" 0)", "1:1", "angle of view is 0"},
    {R"(Camera "perspective" "float fov" 180)", "1:1", "angle of view is 180"},
    {R"(Camera "perspective" "float lensradius" -1)", "1:1", "radius -1"},
    {R"(Camera "perspective" "float lensradius" 1 "float focaldistance" 0)", "1:1", "in focus"},
    {R"(Camera "perspective" "float screenwindow" [ 1 2 3 ])", "1:22", "has 3 values"},
    {R"(Camera "orthographic" "float frameaspectratio" 0)", "1:1", "aspect ratio is 0"},
    {R"(Camera "spherical" "string mapping" "cube")", "1:20", "known are equalarea"},
    {R"(Camera "perspective" "float shutterclose" 0)", "1:22", "opens at 0 and closes at 0"},
    {R"(Film "rgbb")", "1:1", "did you mean 'rgb'?"},
    {R"(Film "rgb" "integer xresolution" -4)", "1:1", "-4 x 720 pixels"},
    {R"(Film "rgb" "integer xresolution" 0)", "1:1", "0 x 720 pixels"},
    {R"(Film "rgb" "integer xresolution" 100000 "integer yresolution" 100000)", "1:1",
     "can't be rendered"},
    {R"(Film "rgb" "float xresolution" 4)", "1:12", "must be of type integer"},
    {R"(Film "rgb" "float iso" -100)", "1:12", "'iso' is -100"},
    {R"(Film "spectral" "integer nbuckets" 0)", "1:17", "'nbuckets' is 0"},
    {R"(Film "spectral" "integer nbuckets" 100000)", "1:17", "1 to 1000"},
    {R"(Film "spectral" "float lambdamin" 700 "float lambdamax" 400)", "1:39", "no interval"},
    {R"(PixelFilter "boxx")", "1:1", "did you mean 'box'?"},
    {R"(PixelFilter "box" "float xradius" 0)", "1:1", "xradius is 0"},
    {R"(PixelFilter "gaussian" "float sigma" -1)", "1:1", "sigma is -1"},
    {R"(Sampler "halten")", "1:1", "did you mean 'halton'?"},
    {R"(Sampler "sobol" "integer pixelsamples" 0)", "1:17", "'pixelsamples' is 0"},
    {R"(Sampler "stratified" "integer xsamples" -2 "integer ysamples" -2)", "1:22",
     "'xsamples' is -2"},
    {R"(Sampler "stratified" "integer xsamples" 99999 "integer ysamples" 99999)", "1:1",
     "9999800001 samples"},
    {R"(Integrator "volpath" "integer maxdepth" -1)", "1:22", "'maxdepth' is -1"},
    {R"(Integrator "volpath" "string tracker" "detla")", "1:22", "no method 'detla'"},
    {R"(Integrator "volpath" "string tracker" "weighted-delta:rate=2")", "1:22", "rate"},
    {R"(Integrator "volpath" "string transmittance" "raito")", "1:22", "no method 'raito'"},
    {R"(Integrator "volpath" "string interpolation" "cubic")", "1:22", "there is no interpolation"},
};

TEST(BuildErrors, OfThePicture) {
  for (const BrokenScene& broken : kPictures) {
    expect_error(std::string(broken.text) + "\nWorldBegin", broken.location, broken.words);
  }
}

/// The type of a medium and its parameters.
const BrokenScene kMedia[] = {
    {R"("homogenous")", "1:1", "did you mean 'homogeneous'?"},
    {R"("cloud" "float wispiness" -1)", "1:43", "may not be negative"},
    {R"("homogeneous" "rgb sigma_a" [ -1 0 0 ])", "1:49", "'sigma_a' is (-1, 0, 0)"},
    {R"("homogeneous" "spectrum sigma_s" [ 400 1 500 -1 ])", "1:49", "has the value -1"},
    {R"("homogeneous" "spectrum sigma_s" "glas-BK7")", "1:49", "'glas-BK7'"},
    {R"("homogeneous" "float sigma_a" 1)", "1:49", "must be of type rgb"},
    {R"("homogeneous" "float scale" -1)", "1:49", "'scale' is -1"},
    {R"("homogeneous" "rgb sigma_a" [ 1e30 1 1 ] "float scale" 1e30)", "1:1", "finite"},
    {R"("homogeneous" "float g" 1)", "1:49", "g must lie between"},
    {R"("homogeneous" "string preset" "skimmilk")", "1:49", "did you mean 'Skimmilk'?"},
    {R"("homogeneous" "string phase" "rayliegh")", "1:49", "did you mean 'rayleigh'?"},
    {R"("homogeneous" "string phase" "rayleigh" "float g" 0)", "1:49", "not both"},
    {R"("homogeneous" "rgb Le" [ 1 1 -1 ])", "1:49", "'Le' is (1, 1, -1)"},
    {R"("homogeneous" "blackbody Le" -5)", "1:49", "not -5"},
    {R"("homogeneous" "float Lescale" -1)", "1:49", "'Lescale' is -1"},
    {R"("uniformgrid")", "1:1", "needs 'density'"},
    {R"("uniformgrid" "integer nx" 2 "float density" [ 1 ])", "1:64", "has 1 value, but"},
    {R"("uniformgrid" "integer nx" 0 "float density" [ 1 ])", "1:49", "'nx' is 0"},
    {R"("uniformgrid" "integer nx" 99999 "integer ny" 99999 "float density" [ 1 ])", "1:1",
     "more than 1e9"},
    {R"("uniformgrid" "integer nx" 2 "float density" [ 1 -1 ])", "1:64", "voxel (1, 0, 0)"},
    {R"("uniformgrid" "point3 p1" [ 1 0 1 ] "float density" [ 1 ])", "1:49", "the same along y"},
    {R"("uniformgrid" "float density" [ 1e38 ] "float scale" 10)", "1:1", "too large"},
    {R"("uniformgrid" "float density" [ 1 ] "float temperature" [ 1 2 ])", "1:71", "has 2 values"},
    {R"("uniformgrid" "float density" 1 "float temperature" 1 "rgb Le" [ 1 1 1 ])", "1:89",
     "not both"},
    {R"("rgbgrid")", "1:1", "needs 'sigma_a' or 'sigma_s'"},
    {R"("rgbgrid" "rgb sigma_s" [ 1 1 1 2 2 2 ])", "1:45", "has 2 values"},
    {R"("rgbgrid" "rgb sigma_s" [ 1 -1 1 ])", "1:45", "in voxel 0"},
    {R"("rgbgrid" "rgb sigma_s" [ 1 1 1 ] "rgb Le" [ 1 1 1 ])", "1:69", "needs 'sigma_a'"},
    {R"("openvdb")", "1:1", "'filename' is missing"},
    {R"("nanovdb" "string filename" "no.nvdb")", "1:45", "there is no file 'no.nvdb'"},
};

TEST(BuildErrors, OfMedia) {
  for (const BrokenScene& broken : kMedia) {
    expect_error(
        R"(MakeNamedMedium "m" "string type" )" + std::string(broken.text) + "\nWorldBegin",
        broken.location, broken.words);
  }
}

const BrokenScene kLights[] = {
    {R"(LightSource "poin")", "2:1", "did you mean 'point'?"},
    {R"(LightSource "point" "rgb I" [ -1 1 1 ])", "2:21", "'I' is (-1, 1, 1)"},
    {R"(LightSource "point" "float scale" -2)", "2:1", "scale is -2"},
    {R"(LightSource "point" "float power" -2)", "2:1", "is -2"},
    {R"(LightSource "distant" "point3 to" [ 0 0 0 ])", "2:1", "directed"},
    {R"(LightSource "spot" "point3 to" [ 0 0 0 ])", "2:1", "directed"},
    {R"(LightSource "spot" "float coneangle" 20 "float conedeltaangle" 30)", "2:1", "edge of 30"},
    {R"(LightSource "infinite" "point3 portal" [ 0 0 0 1 0 0 1 1 0 ])", "2:24", "4 corners, not 3"},
    {R"(LightSource "infinite" "point3 portal" [ 0 0 0 1 0 0 1 1 0 0 3 0 ])", "2:1", "rectangle"},
    {R"(LightSource "infinite" "string filename" "no.exr")", "2:24", "no file 'no.exr'"},
    {R"(LightSource "projection")", "2:1", "needs 'filename'"},
    {"AreaLightSource \"difuse\"\nShape \"sphere\"", "2:1", "did you mean 'diffuse'?"},
    {"AreaLightSource \"diffuse\" \"rgb L\" [ -1 1 1 ]\nShape \"sphere\"", "2:27", "'L' is"},
    {"AreaLightSource \"diffuse\" \"float scale\" -1\nShape \"sphere\"", "2:1", "scale is -1"},
};

TEST(BuildErrors, OfLights) {
  for (const BrokenScene& broken : kLights) {
    expect_error("WorldBegin\n" + std::string(broken.text), broken.location, broken.words);
  }
}

/// An image file, whatever its name.
void write_black_pixels(const std::filesystem::path& path, int width, int height) {
  std::ofstream file(path, std::ios::binary);
  file << "PF\n" << width << " " << height << "\n-1\n";
  file << std::string(std::size_t{12} * width * height, '\0');
}

TEST(BuildErrors, OfImagesOfLights) {
  const TemporaryFile file("wide.pfm");
  const std::string name = file.path().string();
  write_black_pixels(file.path(), 4, 2);
  const std::string begin = "WorldBegin\nLightSource ";
  const std::string filename = R"( "string filename" ")" + name + R"(")";
  expect_error(begin + R"("infinite")" + filename, "2:1", "4 x 2 pixels");
  expect_error(begin + R"("goniometric")" + filename, "2:1", "4 x 2 pixels");
  expect_error(begin + R"("projection")" + filename + R"( "float fov" 0)", "2:1", "0 degrees");
  expect_error(begin + R"("infinite" "rgb L" [ 1 1 1 ])" + filename, "2:24", "not both");
}

const BrokenScene kShapes[] = {
    {R"("sphare")", "2:1", "did you mean 'sphere'?"},
    {R"("sphere" "float radius" 0)", "2:1", "radius is 0"},
    {R"("sphere" "float radius" -1)", "2:1", "radius is -1"},
    {R"("sphere" "float zmin" 2)", "2:1", "range of z"},
    {R"("sphere" "float phimax" 0)", "2:1", "phimax is 0"},
    {R"("disk" "float innerradius" 2)", "2:1", "innerradius is 2"},
    {R"("cylinder" "float zmin" 1)", "2:1", "range of z"},
    {R"("trianglemesh")", "2:1", "'indices' is missing"},
    {R"("trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 3 ])", "2:1",
     "vertex 3"},
    {R"("trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 -1 ])", "2:1",
     "vertex -1"},
    {R"("trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 ])", "2:1",
     "no multiple of 3"},
    {R"("trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "normal N" [ 0 0 1 ])", "2:1", "1 normal;"},
    {R"("trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 ])", "2:22", "a multiple of 3"},
    {R"("bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ])", "2:1", "'indices' is missing"},
    {R"("loopsubdiv" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer levels" 40)", "2:1", "40 levels"},
    {R"("loopsubdiv" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 7 ])", "2:1",
     "vertex 7"},
    {R"("plymesh")", "2:1", "'filename' is missing"},
    {R"("plymesh" "string filename" "no.ply")", "2:17", "there is no file 'no.ply'"},
};

TEST(BuildErrors, OfShapes) {
  for (const BrokenScene& broken : kShapes) {
    expect_error("WorldBegin\nShape " + std::string(broken.text), broken.location, broken.words);
  }
}

TEST(BuildErrors, OfFilesThatAreSomethingElse) {
  const TemporaryFile file("text.vdb");
  const std::string name = file.path().string();
  write_black_pixels(file.path(), 1, 1);
  expect_error(
      "WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"openvdb\" \"string filename\" \"" +
          name + R"(")",
      "2:1", "volume file");
  expect_error("WorldBegin\nShape \"plymesh\" \"string filename\" \"" + name + R"(")", "2:17",
               "PLY");
}

TEST(BuildErrors, InvalidVoxelsAreZeroWithAWarningOrRefusedAndEmptyGridsAreMedia) {
  const TemporaryFile file("odd.vdb");
  const std::string text =
      "WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"openvdb\" \"string filename\" \"" +
      file.path().string() + R"(")";
  const auto warning_of = [&](InvalidPolicy invalid) {
    Diagnostics diagnostics;
    build_scene(parse(text, diagnostics), diagnostics, {.invalid = invalid});
    return diagnostics.warnings().empty() ? std::string() : diagnostics.warnings().front();
  };
  testing_volumes::write_vdb_inactive(file.path(), 0, true);
  const std::string warning = warning_of(InvalidPolicy::kZero);
  EXPECT_NE(warning.find("2:1"), std::string::npos) << warning;
  EXPECT_NE(warning.find("(-8, 0, 7) is NaN"), std::string::npos) << warning;
  EXPECT_THROW(warning_of(InvalidPolicy::kError), Error);
  testing_volumes::write_vdb_empty(file.path());
  EXPECT_NE(warning_of(InvalidPolicy::kError).find("it is empty"), std::string::npos);
}

TEST(BuildErrors, InvalidPixelsAreZeroWithAWarningOrRefused) {
  const TemporaryFile file("odd.pfm");
  {
    std::ofstream pixels(file.path(), std::ios::binary);
    pixels << "PF\n2 2\n-1\n";
    std::array<float, 12> values{};
    values[4] = std::numeric_limits<float>::infinity();  // of the last row, which comes first
    values[9] = std::numeric_limits<float>::quiet_NaN();
    pixels.write(reinterpret_cast<const char*>(values.data()), sizeof(values));
  }
  const std::string name = fmt::format(R"("string filename" "{}")", file.path().string());
  for (const std::string statement :
       {R"(Texture "t" "spectrum" "imagemap")", R"(Texture "t" "float" "imagemap")",
        R"(LightSource "infinite")", R"(LightSource "projection")", R"(LightSource "goniometric")",
        R"(AreaLightSource "diffuse")"}) {
    SCOPED_TRACE(statement);
    const std::string text = fmt::format("WorldBegin\n{} {}\nShape \"sphere\"", statement, name);
    Diagnostics diagnostics;
    build_scene(parse(text, diagnostics), diagnostics);
    ASSERT_EQ(diagnostics.warnings().size(), 1U);
    const std::string warning = diagnostics.warnings().front();
    EXPECT_EQ(warning.substr(0, 13), "scene.pbrt:2:") << warning;
    EXPECT_NE(warning.find("2 pixels"), std::string::npos) << warning;
    EXPECT_NE(warning.find("pixel (1, 0) is NaN"), std::string::npos) << warning;
    EXPECT_THROW(
        build_scene(parse(text, diagnostics), diagnostics, {.invalid = InvalidPolicy::kError}),
        Error);
  }
}

/// A scene of which one thing is said, but that is rendered.
struct DoubtfulScene {
  const char* text;
  const char* location;
  const char* words;
};

const DoubtfulScene kDoubtful[] = {
    {"Camera \"perspective\" \"float fow\" 2\nWorldBegin", "1:22", "did you mean 'fov'?"},
    {"Film \"rgb\" \"string filenam\" \"x\"\nWorldBegin", "1:12", "did you mean 'filename'?"},
    {"Film \"rgb\" \"float cropwindow\" [ 0 2 0 1 ]\nWorldBegin", "1:12",
     "'cropwindow' reaches beyond the film"},
    {"Film \"rgb\" \"float maxcomponentvalue\" 10\nWorldBegin", "1:12", "would bias"},
    {"Film \"rgb\" \"string sensor\" \"canon_eos_100d\"\nWorldBegin", "1:12", "an ideal camera"},
    {"Sampler \"pmj02bn\"\nWorldBegin", "1:1", "padded Sobol' points"},
    {"Sampler \"sobol\" \"integer pixelsample\" 3\nWorldBegin", "1:17", "'pixelsamples'?"},
    {"PixelFilter \"box\" \"float radius\" 3\nWorldBegin", "1:19", "did you mean 'xradius'?"},
    {"Integrator \"bdpt\"\nWorldBegin", "1:1", "is 'volpath' here"},
    {"Integrator \"volpath\" \"bool regularize\" true\nWorldBegin", "1:22", "would bias"},
    {"Integrator \"volpath\" \"string traker\" \"delta\"\nWorldBegin", "1:22", "'tracker'?"},
    {"Option \"bool disablepixeljitter\" true\nWorldBegin", "1:8", "is left out"},
    {"ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nCamera \"perspective\" "
     "WorldBegin",
     "2:1", "a moving camera"},
    {"WorldBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nShape \"sphere\"",
     "2:1", "moving shapes"},
    {"WorldBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\nLightSource "
     R"("point")",
     "2:1", "moving lights"},
    {"WorldBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n"
     R"(MakeNamedMedium "m" "string type" "homogeneous")",
     "2:1", "moving media"},
    {"WorldBegin\nLightSource \"point\" \"rgb L\" [ 1 1 1 ]", "2:21", "did you mean 'I'?"},
    {"WorldBegin\nAreaLightSource \"diffuse\" \"bool twosides\" true Shape \"sphere\"", "2:27",
     "'twosided'?"},
    {"WorldBegin\nAreaLightSource \"diffuse\" Material \"interface\"\nShape \"sphere\"", "3:1",
     "stays dark"},
    {"WorldBegin\nObjectBegin \"o\" AreaLightSource \"diffuse\"\nShape \"sphere\" ObjectEnd", "3:1",
     "stays dark"},
    {"WorldBegin\nShape \"sphere\" \"float radios\" 2", "2:16", "did you mean 'radius'?"},
    {"WorldBegin\nMaterial \"diffuse\" \"float roughness\" 2", "2:20", "'roughness'"},
    {"WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [ 2 1 1 ]", "2:20", "clipped to 1"},
    {"WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float G\" .5", "2:49",
     "did you mean 'g'?"},
};

TEST(BuildWarnings, NameThePlaceAndTheTrouble) {
  for (const DoubtfulScene& doubtful : kDoubtful) {
    Diagnostics diagnostics;
    build_scene(parse(doubtful.text, diagnostics), diagnostics);
    const auto warnings = diagnostics.warnings();
    ASSERT_EQ(warnings.size(), 1U) << doubtful.text;
    const std::string begin = "scene.pbrt:" + std::string(doubtful.location) + ": ";
    EXPECT_EQ(warnings[0].substr(0, begin.size()), begin) << doubtful.text << "\n  " << warnings[0];
    EXPECT_NE(warnings[0].find(doubtful.words), std::string::npos) << warnings[0];
  }
}

// Parameters that mean something to other renderers, or nothing for these values.
TEST(BuildWarnings, NothingIsSaidOfWhatChangesNothing) {
  for (const char* const text :
       {"Film \"gbuffer\" \"bool savefp16\" true \"float diagonal\" 3\nWorldBegin",
        "Sampler \"independent\" \"integer seed\" 3\nWorldBegin",
        "Accelerator \"bvh\" \"integer maxnodeprims\" 4\nWorldBegin",
        "Integrator \"volpath\" \"string lightsampler\" \"power\"\nWorldBegin",
        "Integrator \"volpath\" \"string tracker\" \"auto\"\nWorldBegin",
        R"(WorldBegin Shape "sphere" "float alpha" 1 Shape "sphere" "float alpha" 0.5)",
        R"(WorldBegin Attribute "shape" "float levels" 2 Shape "disk")"}) {
    Diagnostics diagnostics;
    build_scene(parse(text, diagnostics), diagnostics);
    EXPECT_TRUE(diagnostics.warnings().empty()) << text << "\n  " << diagnostics.warnings()[0];
  }
}

// The shutter scales the picture even where no film is described.
TEST(BuildPicture, ExposureIsShutterTimesIso) {
  const auto exposure = [](const std::string& text) {
    Diagnostics diagnostics;
    return build_scene(parse(text + " WorldBegin", diagnostics), diagnostics).scene.exposure_scale;
  };
  EXPECT_FLOAT_EQ(exposure(""), 1);
  EXPECT_FLOAT_EQ(exposure(R"(Camera "perspective" "float shutterclose" 0.25)"), 0.25F);
  EXPECT_FLOAT_EQ(exposure(R"(Film "rgb" "float iso" 300)"), 3);
  EXPECT_FLOAT_EQ(exposure(R"(Film "rgb" "float iso" 300 "float exposuretime" 0.5)"), 1.5F);
  EXPECT_FLOAT_EQ(exposure(R"(Film "rgb" "float iso" 300 "float imagingratio" 0.125)"), 0.125F);
  EXPECT_FLOAT_EQ(exposure(R"(Camera "perspective" "float shutteropen" 0.5 Film "rgb" )"
                           R"("float iso" 400)"),
                  2);
}

}  // namespace
}  // namespace freepath::testing
