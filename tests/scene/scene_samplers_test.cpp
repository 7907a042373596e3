// Pixel filters, samplers and films: what a picture is made of.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// A profile of a filter, on any scale; 0 beyond the radius.
using Profile = std::function<double(double x)>;

struct FilterCase {
  const char* text;
  double radius;
  Profile profile;
};

double sinc(double x) {
  return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

double gaussian(double x, double sigma) { return std::exp(-x * x / (2 * sigma * sigma)); }

/// [Mitchell88, Eq. 8]
double mitchell(double x, double b, double c) {
  x = std::abs(x);
  if (x < 1) {
    return (12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b);
  }
  return (-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x +
         (8 * b + 24 * c);
}

const FilterCase kFilters[] = {
    {R"("box" "float xradius" .8)", 0.8, [](double) { return 1.0; }},
    {R"("triangle" "float xradius" 1.5)", 1.5, [](double x) { return 1.5 - std::abs(x); }},
    {R"("gaussian" "float xradius" 2 "float sigma" .7)", 2,
     [](double x) { return gaussian(x, 0.7) - gaussian(2, 0.7); }},
    {R"("mitchell" "float B" .2 "float C" .4)", 2, [](double x) { return mitchell(x, 0.2, 0.4); }},
    {R"("sinc" "float xradius" 3 "float tau" 2.5)", 3,
     [](double x) { return sinc(x) * sinc(x / 2.5); }},
};

/// The part of a filter's integral beyond x.
double part_beyond(const FilterCase& filter, double x) {
  constexpr int kSteps = 20'000;
  double all = 0;
  double beyond = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double at = filter.radius * (2 * (i + 0.5) / kSteps - 1);
    const double value = filter.profile(at);
    all += value;
    if (at > x) beyond += value;
  }
  return beyond / all;
}

// A light that begins at x = 0.3 of the middle pixel; a pixel of the film is 1 wide.
TEST(SceneFilter, EveryFilterShowsAnEdgeAsItsIntegral) {
  for (const FilterCase& filter : kFilters) {
    const std::string scene =
        R"(Film "rgb" "integer xresolution" 7 "integer yresolution" 33 )"
        "PixelFilter " +
        std::string(filter.text) +
        "\nCamera \"orthographic\" \"float screenwindow\" [ -3.5 3.5 -16.5 16.5 ]\nWorldBegin\n"
        R"(AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true )"
        "Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ .3 -90 4  90 -90 4  .3 90 4  90 90 4 ]\n";
    const Picture picture = render_text(scene, {.samples = 1024});
    expect_sound(picture);
    const int red = *find_channel(picture.image, "R");
    for (int column = 0; column < 7; ++column) {
      // Points of Sobol' are better than the variance of a pixel tells; rows are independent.
      RunningStatistics rows;
      for (int row = 0; row < 33; ++row) rows.add(picture.image.pixel(column, row)[red]);
      EXPECT_TRUE(check_mean(fmt::format("{}, column {}", filter.text, column), rows,
                             part_beyond(filter, 0.3 - (column - 3)), {.absolute = 2e-4}));
      EXPECT_LT(rows.standard_error(), 0.0025);
    }
  }
}

/// A scene whose mean is known: a plane below a disk that shines.
std::string lit_plane(const std::string& before) {
  return "Integrator \"volpath\" \"integer maxdepth\" 1\nPixelFilter \"box\"\n" + before + R"(
      LookAt 0 0 .5  0 0 0  0 1 0
      Camera "orthographic" "float screenwindow" [ -1e-4 1e-4 -1e-4 1e-4 ]
      WorldBegin
      Material "diffuse" "rgb reflectance" [ .5 .5 .5 ]
      Shape "bilinearmesh" "point3 P" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]
      AreaLightSource "diffuse" "rgb L" [ 2 4 1 ]
      Translate 0 0 2 ReverseOrientation Shape "disk" "float radius" 1.5)";
}

const double kForm = 0.5 * 1.5 * 1.5 / (1.5 * 1.5 + 2 * 2);

const std::string kSmallFilm = R"(Film "{}" "integer xresolution" 8 "integer yresolution" 8 {} )";

/// Renders with the samples and the seed of the scene's own.
Picture render_as_told(const std::string& text, ColorMode mode) {
  Diagnostics diagnostics;
  const BuiltScene built = build_scene(parse(text, diagnostics), diagnostics);
  return picture_of(built,
                    {.mode = mode, .samples = built.picture.samples, .seed = built.picture.seed});
}

TEST(SceneSampler, EverySamplerFindsTheSameMean) {
  for (const std::string sampler :
       {R"("independent" "integer pixelsamples" 1024)", R"("halton" "integer pixelsamples" 1024)",
        R"("sobol" "integer pixelsamples" 1024)", R"("paddedsobol" "integer pixelsamples" 1024)",
        R"("zsobol" "integer pixelsamples" 1024)", R"("pmj02bn" "integer pixelsamples" 1024)",
        R"("stratified" "integer xsamples" 32 "integer ysamples" 32)"}) {
    const std::string scene =
        lit_plane(fmt::format(fmt::runtime(kSmallFilm), "rgb", "") + "Sampler " + sampler);
    const Picture picture = render_as_told(scene, ColorMode::kRgb);
    EXPECT_EQ(picture.paths, 64U * 1024);
    expect_mean(sampler, picture, {2 * kForm, 4 * kForm, kForm},
                {.absolute = 1e-4 * kForm, .largest_relative_error = 0.0025});
  }
}

TEST(SceneSampler, SeedsOfOptionAndSamplerAreOne) {
  const std::string film_text = fmt::format(fmt::runtime(kSmallFilm), "rgb", "");
  const std::string sampler = R"(Sampler "independent" "integer pixelsamples" 4 )";
  const auto pixels = [&](const std::string& before) {
    return render_as_told(lit_plane(film_text + before), ColorMode::kRgb).image.values;
  };
  const auto expected = pixels(sampler + "\"integer seed\" 7 ");
  EXPECT_EQ(pixels(sampler + "Option \"integer seed\" 7 "), expected);
  EXPECT_NE(pixels(sampler + "\"integer seed\" 8 "), expected);
}

// The films differ in what they store, not in what they measure.
TEST(SceneFilm, AllFilmsHaveTheSameColours) {
  const std::string sampler = R"(Sampler "sobol" "integer pixelsamples" 1024 )";
  for (const ColorMode mode : kColorModes) {
    const auto picture = [&](const std::string& type) {
      return render_as_told(lit_plane(fmt::format(fmt::runtime(kSmallFilm), type, "") + sampler),
                            mode);
    };
    const Picture rgb = picture("rgb");
    expect_mean("film", rgb, {2 * kForm, 4 * kForm, kForm},
                {.absolute = 4e-4 * kForm, .largest_relative_error = 0.005});
    const Picture gbuffer = picture("gbuffer");
    for (int c = 0; c < 3; ++c) EXPECT_EQ(gbuffer.mean[c], rgb.mean[c]);
    // Its paths see lights by wavelengths even where R, G, B would do.
    expect_mean("spectral", picture("spectral"), {2 * kForm, 4 * kForm, kForm},
                {.absolute = 4e-4 * kForm, .largest_relative_error = 0.005});
  }
}

}  // namespace
}  // namespace freepath::testing
