// Errors that pictures of wavelengths state, against how far pictures of many seeds spread: pixels
// share neither wavelengths nor the noise that comes with them.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "tests/counted_clock.h"
#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {
namespace {

/// A unit cube of something under a light, as seen by a small film, by independent samples.
std::string lit_cube(const std::string& light, const std::string& medium, int size = 8) {
  return film(size) + R"(
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
std::string coloured_cloud(int size = 8) {
  return lit_cube(R"("rgb L" [ 0.4 0.7 1 ])",
                  R"("rgb sigma_a" [ 0.1 0.4 0.9 ] "rgb sigma_s" [ 3 2 1 ])", size);
}

/// All wavelengths share walkers, but what a path meets first takes its colour apart.
std::string ball_in_fog(int size = 8) {
  return lit_cube(R"("spectrum L" "stdillum-F11")",
                  R"("spectrum sigma_a" [ 300 0.5 900 0.5 ] "spectrum sigma_s" [ 300 3 900 3 ])",
                  size) +
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

/// @param options all but the seeds of pictures and what `begin` sets
Spread spread_of(const std::string& text, PictureOptions options, int pictures,
                 const std::function<void(int picture, PictureOptions&)>& begin = {},
                 const std::function<void(const Picture&)>& end = {}) {
  Diagnostics diagnostics;
  const PbrtScene pbrt = parse(text, diagnostics);
  const BuiltScene built = build_scene(pbrt, diagnostics);
  Spread spread;
  spread.pictures = pictures;
  Picture last;
  for (int i = 0; i < pictures; ++i) {
    options.mode = ColorMode::kSpectral;
    options.seed = 1000 + static_cast<uint64_t>(i);
    if (begin) begin(i, options);
    Picture picture = picture_of(built, options);
    expect_sound(picture);
    if (end) end(picture);
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
void expect_not_more_than_stated(const Spread& spread) {
  EXPECT_LT(spread.largest_z, 4.5);
  for (int c = 0; c < 3; ++c) {
    SCOPED_TRACE(c);
    EXPECT_GT(spread.p_value(c), 1e-3) << spread.ratio(c);
    EXPECT_GT(spread.ratio(c), 0.25);
    // Of pixels; with 0.03 for what 63 times 64 of them leave to chance.
    EXPECT_LT(spread.differences[c], 1.1 * spread.variances[c]);
  }
}

TEST(SpectralErrors, OfMeansAreNotMoreThanStated) {
  for (const uint32_t samples : {3U, 16U}) {
    for (const std::string& text : {coloured_cloud(), ball_in_fog()}) {
      SCOPED_TRACE(samples);
      expect_not_more_than_stated(spread_of(text, {.samples = samples}, 64));
    }
  }
}

/// A clock that goes on by a tick whenever it is asked, and by far more after so many ticks: the
/// machine seems to stand still for a while.
std::function<double()> jumping_clock(uint64_t ticks) {
  const auto asked = std::make_shared<std::atomic<uint64_t>>(0);
  return [asked, ticks] {
    const uint64_t count = (*asked)++;
    return kCountedTick * static_cast<double>(count) + (count < ticks ? 0 : 2);
  };
}

/// The fewest and the most samples of a pixel.
std::pair<float, float> samples_of(const Picture& picture) {
  const int channel = *find_channel(picture.image, "samples");
  std::pair<float, float> range(1e9F, 0);
  for (int i = 0; i < picture.image.width * picture.image.height; ++i) {
    const float samples =
        picture.image.pixel(i % picture.image.width, i / picture.image.width)[channel];
    range = {std::min(range.first, samples), std::max(range.second, samples)};
  }
  return range;
}

// Time ends pictures in the midst of a pass: some pixels have its samples, and others not.
TEST(SpectralErrors, OfPicturesThatTimeEndsAreNotMoreThanStated) {
  constexpr int kSize = 64;  // for several jobs in a pass
  for (const std::string& text : {coloured_cloud(kSize), ball_in_fog(kSize)}) {
    int broken_off = 0;
    const auto begin = [](int picture, PictureOptions& options) {
      options.clock = jumping_clock(120 + 2 * static_cast<uint64_t>(picture));
    };
    const auto end = [&](const Picture& picture) {
      const auto [fewest, most] = samples_of(picture);
      EXPECT_GE(fewest, 2);
      broken_off += fewest < most ? 1 : 0;
    };
    const PictureOptions options{.samples = 0, .threads = 1, .time_limit = 1};
    expect_not_more_than_stated(spread_of(text, options, 24, begin, end));
    EXPECT_GT(broken_off, 8);
  }
}

// Where paths make the noise, errors are what is stated, of pixels and of means.
TEST(SpectralErrors, AreAsStatedWhereNoiseIsNotOfColour) {
  const Spread spread =
      spread_of(lit_cube(R"("rgb L" [ 0.4 0.7 1 ])",
                         R"("rgb sigma_a" [ 2.7 3 3.3 ] "rgb sigma_s" [ 0.5 0.5 0.5 ])"),
                {.samples = 32}, 64);
  const int green = 1;
  EXPECT_GT(spread.p_value(green), 1e-3) << spread.ratio(green);
  EXPECT_LT(spread.p_value(green), 1 - 1e-3) << spread.ratio(green);
  EXPECT_NEAR(spread.differences[green] / spread.variances[green], 1, 0.1);
}

}  // namespace
}  // namespace freepath::testing
