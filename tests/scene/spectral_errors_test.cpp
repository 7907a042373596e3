// Errors that pictures of wavelengths state, against how far pictures of many seeds spread: pixels
// share neither wavelengths nor the noise that comes with them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// A unit cube of something under a light, as seen by a small film, by independent samples.
std::string lit_cube(const std::string& light, const std::string& medium) {
  return film(8) + R"(
    LookAt 0.5 0.5 5  0.5 0.5 0  0 1 0
    Camera "perspective" "float fov" 20
    Sampler "independent"
    Integrator "volpath" "integer maxdepth" 100 "string tracker" "spectral"
    WorldBegin
    LightSource "infinite" )" +
         light + "\nMakeNamedMedium \"cube\" \"string type\" \"homogeneous\" " + medium + "\n" +
         medium_box("cube", Vec3d(0), Vec3d(1));
}

/// Its walkers depend on wavelengths.
std::string coloured_cloud() {
  return lit_cube(R"("rgb L" [ 0.4 0.7 1 ])",
                  R"("rgb sigma_a" [ 0.1 0.4 0.9 ] "rgb sigma_s" [ 3 2 1 ])");
}

/// All wavelengths share walkers, but what a path meets first takes its colour apart.
std::string ball_in_fog() {
  return lit_cube(R"("spectrum L" "stdillum-F11")",
                  R"("spectrum sigma_a" [ 300 0.5 900 0.5 ] "spectrum sigma_s" [ 300 3 900 3 ])") +
         R"(Material "diffuse" "rgb reflectance" [ 0.2 0.5 0.7 ]
            Translate 0.5 0.5 0.5 Shape "sphere" "float radius" 0.3)";
}

/// Of pictures of many seeds.
struct Spread {
  int pictures = 0;
  RunningStatistics means[3];
  double stated[3] = {};  ///< Mean square of the errors that pictures state of their means.
  double differences[3] = {}, variances[3] = {};  ///< Of pixels of twins; of both variances. Sums.
  double largest_z = 0;                           ///< Of the means of twins.

  /// Real over stated error of the mean of a picture.
  double ratio(int c) const { return std::sqrt(means[c].variance() / stated[c]); }
  /// Probability of a spread as large by chance, if errors are as stated.
  double p_value(int c) const {
    const double freedom = pictures - 1;
    return upper_gamma(0.5 * freedom, 0.5 * freedom * means[c].variance() / stated[c]);
  }
};

void compare_twins(const Picture& a, const Picture& b, Spread& spread) {
  for (int c = 0; c < 3; ++c) {
    const double error = std::hypot(a.error[c], b.error[c]);
    spread.largest_z = std::max(spread.largest_z, std::abs(a.mean[c] - b.mean[c]) / error);
    const int value = *find_channel(a.image, std::string(1, "RGB"[c]));
    const int variance = *find_channel(a.image, std::string("variance.") + "RGB"[c]);
    for (int i = 0; i < a.image.width * a.image.height; ++i) {
      const float* const first = a.image.pixel(i % a.image.width, i / a.image.width);
      const float* const second = b.image.pixel(i % a.image.width, i / a.image.width);
      const double apart = first[value] - second[value];
      spread.differences[c] += apart * apart;
      spread.variances[c] += first[variance] + second[variance];
    }
  }
}

Spread spread_of(const std::string& text, uint32_t samples, int pictures) {
  Diagnostics diagnostics;
  const PbrtScene pbrt = parse(text, diagnostics);
  const BuiltScene built = build_scene(pbrt, diagnostics);
  Spread spread;
  spread.pictures = pictures;
  Picture last;
  for (int i = 0; i < pictures; ++i) {
    const uint64_t seed = 1000 + static_cast<uint64_t>(i);
    Picture picture =
        picture_of(built, {.mode = ColorMode::kSpectral, .samples = samples, .seed = seed});
    expect_sound(picture);
    for (int c = 0; c < 3; ++c) {
      spread.means[c].add(picture.mean[c]);
      spread.stated[c] += picture.error[c] * picture.error[c] / pictures;
    }
    if (i > 0) compare_twins(last, picture, spread);
    last = std::move(picture);
  }
  return spread;
}

/// Samples of a pixel stratify the spectrum, for which its variance does not allow: errors may be
/// less than stated where noise of colour leads, but never more.
TEST(SpectralErrors, OfMeansAreNotMoreThanStated) {
  for (const uint32_t samples : {3U, 16U}) {
    for (const std::string& text : {coloured_cloud(), ball_in_fog()}) {
      const Spread spread = spread_of(text, samples, 64);
      EXPECT_LT(spread.largest_z, 4.5);
      for (int c = 0; c < 3; ++c) {
        SCOPED_TRACE(c);
        EXPECT_GT(spread.p_value(c), 1e-3) << spread.ratio(c) << " with " << samples;
        EXPECT_GT(spread.ratio(c), 0.25) << samples;
        // Of pixels; with 0.03 for what 63 times 64 of them leave to chance.
        EXPECT_LT(spread.differences[c], 1.1 * spread.variances[c]) << samples;
      }
    }
  }
}

// Where paths make the noise, errors are what is stated, of pixels and of means.
TEST(SpectralErrors, AreAsStatedWhereNoiseIsNotOfColour) {
  const Spread spread =
      spread_of(lit_cube(R"("rgb L" [ 0.4 0.7 1 ])",
                         R"("rgb sigma_a" [ 0.9 1 1.1 ] "rgb sigma_s" [ 9 9 9 ])"),
                32, 64);
  const int green = 1;
  EXPECT_GT(spread.p_value(green), 1e-3) << spread.ratio(green);
  EXPECT_LT(spread.p_value(green), 1 - 1e-3) << spread.ratio(green);
  EXPECT_NEAR(spread.differences[green] / spread.variances[green], 1, 0.1);
}

}  // namespace
}  // namespace freepath::testing
