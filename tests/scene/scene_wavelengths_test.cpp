// Spectra that are the same at some wavelengths and not at others: what is equal at those of a
// sample says nothing of the rest.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath {
namespace {

/// Constant between 400 and 700 nm and 0 beyond, as the scene language has it.
double band(double wavelength) { return wavelength >= 400 && wavelength <= 700 ? 0.5 : 0; }

/// A small film in front of the unit cube, up to the world's beginning.
std::string in_front(const char* tracker) {
  return testing::film(4) + R"(
    LookAt 0.5 0.5 5  0.5 0.5 0  0 1 0
    Camera "perspective" "float fov" 24
    Integrator "volpath" "integer maxdepth" 100 "string tracker" ")" +
         tracker + "\"\n    WorldBegin\n";
}

TEST(SceneWavelengths, AReflectanceIsNotGreyForBeingEqualAtFour) {
  const std::string text = testing::film(4) + R"(
    LookAt 0 0 5  0 0 0  0 1 0
    Camera "perspective" "float fov" 20
    Integrator "volpath" "integer maxdepth" 10
    WorldBegin
    LightSource "infinite" "rgb L" [ 1 1 1 ]
    Material "diffuse" "spectrum reflectance" [ 400 0.5 700 0.5 ]
    Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]
  )";
  const RgbColorSpace& space = rgb_color_space("srgb");
  const Vec3d expected = space.from_xyz(observe(
      [&](double wavelength) { return band(wavelength) * space.illuminant()(wavelength); }));
  const testing::Picture picture =
      testing::render_text(text, {.mode = ColorMode::kSpectral, .samples = 4096});
  testing::expect_mean("band", picture, {expected.x, expected.y, expected.z},
                       {.absolute = 5e-4, .largest_relative_error = 0.01});
}

TEST(SceneWavelengths, AMediumIsNotGreyForBeingEqualAtFour) {
  // Whatever the wavelengths of the first sample are, which the seed decides.
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const std::string text = testing::film(2) + R"(
      LookAt 0.5 0.5 5  0.5 0.5 0  0 1 0
      Camera "perspective" "float fov" 10
      Integrator "volpath" "integer maxdepth" 10 "string tracker" "delta"
      WorldBegin
      LightSource "infinite" "rgb L" [ 1 1 1 ]
      MakeNamedMedium "band" "string type" "homogeneous" "spectrum sigma_a" [ 300 0 900 0 ]
        "spectrum sigma_s" [ 400 1 700 1 ]
    )" + testing::medium_box("band", Vec3d(0), Vec3d(1));
    const testing::Picture picture =
        testing::render_text(text, {.mode = ColorMode::kSpectral, .samples = 64, .seed = seed});
    testing::expect_sound(picture);
    EXPECT_EQ(picture.paths, 2U * 2 * 64 * 4) << "one for each channel, seed " << seed;
  }
}

TEST(SceneWavelengths, PathsOfChannelsAddUpInOneOrder) {
  const std::string text = in_front("delta") + R"(
    LightSource "infinite" "rgb L" [ 1 1 1 ]
    MakeNamedMedium "red" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.4 0.9 ]
      "rgb sigma_s" [ 4 2 1 ]
    MakeNamedMedium "blue" "string type" "homogeneous" "rgb sigma_a" [ 0.9 0.4 0.1 ]
      "rgb sigma_s" [ 1 2 4 ]
  )" + testing::medium_box("red", Vec3d(0), Vec3d(1, 1, 0.4)) +
                           testing::medium_box("blue", Vec3d(0, 0, 0.5), Vec3d(1));
  for (const ColorMode mode : testing::kColorModes) {
    const testing::Picture one =
        testing::render_text(text, {.mode = mode, .samples = 32, .threads = 1, .batch = 1});
    const testing::Picture many =
        testing::render_text(text, {.mode = mode, .samples = 32, .threads = 2, .batch = 2048});
    EXPECT_EQ(one.image.values, many.image.values) << testing::name_of(mode);
  }
}

// As many as a path carries: the picture is the same in expectation, and nothing is lost where a
// path has fewer channels than a picture.
TEST(SceneWavelengths, AnyNumberOfThemGivesTheSamePicture) {
  const auto text = [](const char* tracker) {
    return in_front(tracker) + R"(
    LightSource "infinite" "rgb L" [ 0.4 0.7 1 ]
    LightSource "distant" "point3 from" [ 1 2 1 ] "rgb L" [ 2 1.5 1 ]
    MakeNamedMedium "grey" "string type" "homogeneous" "spectrum sigma_a" [ 300 0.1 900 0.1 ]
      "spectrum sigma_s" [ 300 2 900 2 ]
    MakeNamedMedium "red" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.4 0.9 ]
      "rgb sigma_s" [ 3 2 1 ] "rgb Le" [ 0.3 0.2 0.1 ]
  )" + testing::medium_box("grey", Vec3d(0), Vec3d(1, 1, 0.4)) +
           testing::medium_box("red", Vec3d(0, 0, 0.5), Vec3d(1));
  };
  const testing::Picture expected = testing::render_text(
      text("spectral"), {.mode = ColorMode::kSpectral, .samples = 4096, .seed = 99});
  for (const char* const tracker : {"spectral", "hero-wavelength", "delta"}) {
    for (const int wavelengths : {1, 2, 3, 5, 8}) {
      const testing::Picture picture =
          testing::render_text(text(tracker), {.mode = ColorMode::kSpectral,
                                               .samples = 1024,
                                               .wavelengths = wavelengths,
                                               .seed = static_cast<uint64_t>(wavelengths)});
      testing::expect_sound(picture);
      for (int c = 0; c < 3; ++c) {
        // The errors of few wavelengths are overestimated: samples stratify the spectrum.
        const double error = std::hypot(picture.error[c], expected.error[c]);
        EXPECT_NEAR(picture.mean[c], expected.mean[c],
                    std::min(4.5 * error, 0.02 * expected.mean[c]))
            << tracker << ", " << wavelengths << " wavelengths, channel " << c;
      }
    }
  }
}

TEST(SceneWavelengths, EightOfThemFitIntoAGridOfSpectra) {
  const std::string text = in_front("delta") + R"(
    LightSource "infinite" "rgb L" [ 0.4 0.7 1 ]
    MakeNamedMedium "grid" "string type" "rgbgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1
      "rgb sigma_a" [ 0.1 0.4 0.9  0.9 0.4 0.1 ] "rgb sigma_s" [ 3 2 1  1 2 3 ]
  )" + testing::medium_box("grid", Vec3d(0), Vec3d(1));
  const testing::Picture four =
      testing::render_text(text, {.mode = ColorMode::kSpectral, .samples = 1024, .seed = 1});
  const testing::Picture eight = testing::render_text(
      text, {.mode = ColorMode::kSpectral, .samples = 1024, .wavelengths = 8, .seed = 2});
  for (int c = 0; c < 3; ++c) {
    const double error = std::hypot(four.error[c], eight.error[c]);
    EXPECT_NEAR(eight.mean[c], four.mean[c], 4.5 * error);
    EXPECT_LT(4.5 * error, 0.03 * four.mean[c]);
  }
}

TEST(SceneWavelengths, AreRefusedWhereAPathCannotCarryThem) {
  const std::string text = testing::film(2) + R"(
    Camera "perspective"
    WorldBegin
    LightSource "infinite" "rgb L" [ 1 1 1 ]
  )";
  for (const int wavelengths : {-1, 0, 9}) {
    EXPECT_THROW(
        testing::render_text(text, {.mode = ColorMode::kSpectral, .wavelengths = wavelengths}),
        Error);
  }
}

}  // namespace
}  // namespace freepath
