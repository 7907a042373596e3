#pragma once
/// @file Pictures of scenes that are texts, and what tests ask of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/vector.h"
#include "freepath/paths/renderer.h"
#include "freepath/scene/assembly/scene_builder.h"
#include "freepath/scene/pbrt/parser.h"
#include "tests/scene/scenes_in_memory.h"
#include "tests/statistics.h"

namespace freepath::testing {

/// Both ways to render a colour.
inline constexpr ColorMode kColorModes[] = {ColorMode::kRgb, ColorMode::kSpectral};

inline const char* name_of(ColorMode mode) { return mode == ColorMode::kRgb ? "rgb" : "spectral"; }

/// How to render a scene, as far as its text does not say it.
struct PictureOptions {
  ColorMode mode = ColorMode::kRgb;
  uint32_t samples = 64;
  int wavelengths = 4;  ///< Of a path in spectral mode.
  uint64_t seed = 5;
  int threads = 0;
  std::size_t batch = 2048;
  bool near_light_lines = true;
  bool lobe_splitting = true;
  bool light_through_glass = true;
  double time_limit = 0;               ///< [s] by the clock; 0: none.
  std::function<double()> clock = {};  ///< RenderSettings::clock
};

/// A picture and its mean over the film.
struct Picture {
  Image image;
  std::array<double, 3> mean{};
  std::array<double, 3> error{};  ///< Standard errors.
  std::vector<std::string> warnings;
  uint64_t overflows = 0;
  uint64_t bound_violations = 0;
  uint64_t paths = 0;
};

inline RenderSettings settings_of(const BuiltScene& built, const PictureOptions& options) {
  RenderSettings settings;
  settings.samples = options.samples;
  settings.wavelengths = options.wavelengths;
  settings.threads = options.threads;
  settings.buckets = built.picture.buckets;
  settings.batch = options.batch;
  settings.near_light_lines = options.near_light_lines;
  settings.lobe_splitting = options.lobe_splitting;
  settings.light_through_glass = options.light_through_glass;
  settings.time_limit = options.time_limit;
  settings.clock = options.clock;
  settings.max_scatterings = built.picture.max_scatterings;
  settings.walk.seed = options.seed;
  settings.walk.tracker = standard_tracker(built.scene);
  if (!built.picture.tracker.empty()) settings.walk.tracker = built.picture.tracker;
  settings.chooses_transmittance = built.picture.transmittance.empty();
  if (!built.picture.transmittance.empty()) {
    settings.walk.transmittance = built.picture.transmittance;
  }
  return settings;
}

inline Picture picture_of(const RenderResult& result) {
  Picture picture;
  picture.image = result.film.to_image();
  picture.overflows = result.counts.overflows;
  picture.bound_violations = result.counts.statistics().bound_violations;
  picture.paths = result.counts.paths;
  const char* const names[] = {"R", "G", "B"};
  const auto pixels = static_cast<double>(picture.image.pixel_count());
  for (int c = 0; c < 3; ++c) {
    const int value = *find_channel(picture.image, names[c]);
    const int variance = *find_channel(picture.image, std::string("variance.") + names[c]);
    for (int row = 0; row < picture.image.height; ++row) {
      for (int column = 0; column < picture.image.width; ++column) {
        picture.mean[c] += picture.image.pixel(column, row)[value];
        picture.error[c] += picture.image.pixel(column, row)[variance];
      }
    }
    picture.mean[c] /= pixels;
    picture.error[c] = std::sqrt(picture.error[c]) / pixels;
  }
  return picture;
}

inline Picture picture_of(const BuiltScene& built, const PictureOptions& options) {
  return picture_of(render_scene(built.scene, options.mode, settings_of(built, options)));
}

/// Parses, builds and renders a scene.
inline Picture render_text(const std::string& text, const PictureOptions& options = {}) {
  Diagnostics diagnostics;
  const PbrtScene pbrt = parse(text, diagnostics);
  const BuiltScene built = build_scene(pbrt, diagnostics);
  Picture picture = picture_of(built, options);
  picture.warnings = diagnostics.warnings();
  return picture;
}

/// A picture in R, G, B with all layers.
inline Image image_with_layers(const std::string& text, uint32_t samples) {
  Diagnostics diagnostics;
  const BuiltScene built = build_scene(parse(text, diagnostics), diagnostics);
  RenderSettings settings = settings_of(built, {.samples = samples});
  settings.layers = LayerSet::all();
  return render_scene(built.scene, ColorMode::kRgb, settings).film.to_image();
}

/// Values of a channel over all pixels.
inline RunningStatistics statistics_of(const Image& image, std::string_view channel) {
  RunningStatistics statistics;
  const int number = find_channel(image, channel).value();
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    statistics.add(image.values[i * image.channels.size() + number]);
  }
  return statistics;
}

/// A film of some pixels, without a filter that reaches into other pixels.
inline std::string film(int size = 16) {
  return R"(Film "rgb" "integer xresolution" )" + std::to_string(size) +
         R"( "integer yresolution" )" + std::to_string(size) + "\nPixelFilter \"box\"\n";
}

inline const std::string kWhiteSky = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";

/// As many scatterings as it takes.
inline const std::string kUnlimited = "Integrator \"volpath\" \"integer maxdepth\" 100000\n";

/// A closed box as twelve triangles whose normals point out of it.
inline std::string box_shape(const Vec3d& low, const Vec3d& high) {
  std::string points;
  for (int corner = 0; corner < 8; ++corner) {
    points += fmt::format("{} {} {}  ", (corner & 1) != 0 ? high.x : low.x,
                          (corner & 2) != 0 ? high.y : low.y, (corner & 4) != 0 ? high.z : low.z);
  }
  return R"(Shape "trianglemesh" "point3 P" [ )" + points +
         R"(] "integer indices" [ 0 2 3 0 3 1  4 5 7 4 7 6  0 1 5 0 5 4  2 6 7 2 7 3  )"
         "0 4 6 0 6 2  1 3 7 1 7 5 ]\n";
}

/// A box filled with a medium, of which nothing else is seen.
inline std::string medium_box(const std::string& medium, const Vec3d& low, const Vec3d& high,
                              const std::string& around = "") {
  return "AttributeBegin\nMaterial \"interface\"\nMediumInterface \"" + medium + R"(" ")" + around +
         "\"\n" + box_shape(low, high) + "AttributeEnd\n";
}

/// What no picture may have.
inline void expect_sound(const Picture& picture) {
  EXPECT_TRUE(picture.warnings.empty()) << picture.warnings.front();
  EXPECT_EQ(picture.overflows, 0U);
  EXPECT_EQ(picture.bound_violations, 0U);
}

/// Each channel's mean is as expected, within 4 standard errors, of at most a third of a percent
/// where nothing else is said.
inline void expect_mean(const std::string& name, const Picture& picture,
                        const std::array<double, 3>& expected,
                        const MeanTolerance& tolerance = {.absolute = 2e-5,
                                                          .largest_relative_error = 0.0034}) {
  expect_sound(picture);
  for (int c = 0; c < 3; ++c) {
    EXPECT_TRUE(check_mean(name + " " + "RGB"[c], picture.mean[c], picture.error[c], picture.paths,
                           expected[c], tolerance));
  }
}

/// Two pictures have the same mean, within 4 combined standard errors.
inline void expect_alike(const std::string& name, const Picture& a, const Picture& b,
                         const MeanTolerance& tolerance = {.absolute = 2e-5,
                                                           .largest_relative_error = 0.005}) {
  expect_sound(a);
  expect_sound(b);
  for (int c = 0; c < 3; ++c) {
    EXPECT_TRUE(check_mean(name + " " + "RGB"[c], a.mean[c], std::hypot(a.error[c], b.error[c]),
                           a.paths, b.mean[c], tolerance));
  }
}

}  // namespace freepath::testing
