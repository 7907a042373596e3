#include "tests/report/sample_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "freepath/base/random.h"
#include "freepath/io/image_encode.h"

namespace freepath::testing {

namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 270;

struct Tracker {
  const char* name;
  double error;    // of a picture of 1 s
  double lookups;  // for each path
};
constexpr std::array<Tracker, 6> kTrackers = {{{"delta", 0.42, 61.2},
                                               {"weighted_delta", 0.63, 58.9},
                                               {"decomposition", 0.142, 14.6},
                                               {"residual_ratio", 0.21, 22.3},
                                               {"spectral_mis", 0.34, 48.1},
                                               {"regular", 0.97, 131.0}}};

/// Uniform in [0, 1), a pure function of its arguments.
double noise(uint32_t a, uint32_t b, uint32_t c) {
  return philox({a, b, c, 0}, {7, 11}, kPhiloxRounds)[0] / 4294967296.0;
}

Rgb grey(double red, double green, double blue) {
  const auto byte = [](double value) {
    return static_cast<int>(std::lround(255 * std::pow(std::clamp(value, 0.0, 1.0), 1 / 2.2)));
  };
  return {byte(red), byte(green), byte(blue)};
}

/// A lit puff before a sky, with so much noise.
PngBytes puff(uint32_t seed, double error) {
  return make_png(kWidth, kHeight, [&](int column, int row) {
    const double x = (column + 0.5 - 0.5 * kWidth) / (0.4 * kHeight);
    const double y = (row + 0.5 - 0.52 * kHeight) / (0.4 * kHeight);
    const double ripple = 0.09 * std::sin(7 * x + 3 * y) + 0.07 * std::sin(11 * y - 5 * x);
    const double depth = std::max(0.0, 1 - x * x / 2.1 - y * y + ripple);
    const double cover = 1 - std::exp(-6 * depth);
    const double light = 0.25 + 0.6 * std::clamp(0.5 - 0.55 * y + 0.3 * x + ripple, 0.0, 1.0);
    const double sky = 0.32 + 0.2 * row / kHeight;
    const double spread =
        1 + error * cover *
                (noise(static_cast<uint32_t>(column), static_cast<uint32_t>(row), seed) - 0.5) * 3;
    const auto mix = [&](double cloud, double background) {
      return (cover * cloud * light + (1 - cover) * background * sky) * spread;
    };
    return grey(mix(1.3, 0.75), mix(1.24, 1.05), mix(1.18, 1.65));
  });
}

/// Dark violet, red, yellow.
Rgb heat(double value) {
  const double t = std::clamp(value, 0.0, 1.0);
  return {static_cast<int>(255 * std::min(1.0, 0.1 + 1.6 * t)),
          static_cast<int>(255 * t * t * 0.95),
          static_cast<int>(255 * (0.35 - 0.35 * t + 0.25 * std::sin(3.14 * t)))};
}

PngBytes error_map(uint32_t seed, double error) {
  return make_png(kWidth / 2, kHeight / 2, [&](int column, int row) {
    const double x = (2.0 * column - 0.5 * kWidth) / (0.4 * kHeight);
    const double y = (2.0 * row - 0.52 * kHeight) / (0.4 * kHeight);
    const double depth = std::max(0.0, 1 - x * x / 2.1 - y * y);
    return heat(
        1.4 * error * (1 - std::exp(-4 * depth)) *
        (0.6 + 0.8 * noise(static_cast<uint32_t>(column), static_cast<uint32_t>(row), seed)));
  });
}

PageTable sample_table() {
  PageTable table;
  table.columns = {{"tracker", "", false},
                   {"error", "Root of the mean square of relative errors"},
                   {"bias", "Mean of the relative errors, with its interval of 95 %"},
                   {"variance", "Of one path"},
                   {"time [s]", "Wall time of all passes"},
                   {"paths", "Paths in all"},
                   {"paths/s", ""},
                   {"lookups/path", "Values of the density that a path asks for"},
                   {"null/real", "Null collisions for each real one"},
                   {"efficiency", "1 / (variance · time), of delta tracking"},
                   {"worst pixel", ""},
                   {"median", ""},
                   {"time to 1 %", "How long it would take to an error of 1 %"},
                   {"verdict", "", false}};
  table.caption =
      "Six trackers on one scene, 60 s each on four threads. Intervals hold the true value in 95 "
      "of "
      "100 repetitions.";
  for (const Tracker& tracker : kTrackers) {
    const bool is_best = tracker.error < 0.15;
    const bool is_bad = tracker.error > 0.9;
    const double efficiency = std::pow(0.42 / tracker.error, 2);
    const auto number = [](const char* format, double value) {
      return PageCell{fmt::format(fmt::runtime(format), value), value};
    };
    PageCell error = number("{:.3f}", tracker.error);
    error.note = fmt::format("{:.3f}–{:.3f}", 0.94 * tracker.error, 1.07 * tracker.error);
    PageCell gain = number("{:.2f}", efficiency);
    gain.note = fmt::format("{:.2f}–{:.2f}", 0.9 * efficiency, 1.1 * efficiency);
    if (is_best) error.tone = gain.tone = PageCell::Tone::kBest;
    PageCell bias = number("{:+.4f}", 0.002 * (tracker.error - 0.4));
    bias.note = "±0.0011";
    if (is_bad) bias.tone = PageCell::Tone::kBad;
    table.rows.push_back(
        {{tracker.name},
         error,
         bias,
         number("{:.3g}", tracker.error * tracker.error * 4.1),
         number("{:.1f}", 60 + tracker.error),
         number("{:.3g} M", 18 / tracker.lookups * 61),
         number("{:.0f} k", 305 / tracker.lookups * 61),
         number("{:.1f}", tracker.lookups),
         number("{:.2f}", tracker.lookups / 14),
         gain,
         number("{:.1f}", 7 * tracker.error),
         number("{:.3f}", 0.61 * tracker.error),
         {is_bad ? "–" : fmt::format("{:.0f} s", 1e4 * tracker.error * tracker.error),
          is_bad ? std::nan("") : 1e4 * tracker.error * tracker.error, "",
          is_bad ? PageCell::Tone::kFaint : PageCell::Tone::kPlain},
         {is_bad ? "biased" : "passes", 0, "",
          is_bad ? PageCell::Tone::kBad : PageCell::Tone::kGood}});
  }
  return table;
}

Chart sample_histogram() {
  Chart chart{"Lengths of free paths", {"t [m]"}, {"density [1/m]"}, {}};
  ChartSeries bins{"delta", {}, {}};
  bins.mark = ChartMark::kSteps;
  ChartSeries exact{"exp(−t)", {}, {}};
  exact.is_reference = true;
  for (uint32_t i = 0; i < 30; ++i) {
    const double value = std::exp(-0.1 * i - 0.05) + 0.06 * (noise(i, 0, 3) - 0.5);
    bins.x.push_back(0.1 * i);
    bins.y.push_back(value);
    bins.low.push_back(value - 0.03);
    bins.high.push_back(value + 0.03);
    exact.x.push_back(0.1 * i);
    exact.y.push_back(std::exp(-0.1 * i));
  }
  bins.x.push_back(3.0);
  chart.series = {bins, exact};
  chart.width = 1120;
  chart.height = 380;
  return chart;
}

}  // namespace

PngBytes encode_png(int width, int height, const std::vector<uint8_t>& pixels) {
  PngBytes bytes;
  const std::string reason = encode_png_pixels(width, height, pixels.data(), bytes);
  if (!reason.empty()) throw std::runtime_error(reason);
  return bytes;
}

Chart sample_chart() {
  Chart chart{"Error over time", {"time [s]", true}, {"relative RMSE", true}, {}};
  for (uint32_t k = 0; k < kTrackers.size(); ++k) {
    ChartSeries series{kTrackers[k].name, {}, {}};
    series.mark = ChartMark::kBoth;
    for (uint32_t i = 0; i < 9; ++i) {
      const double time = 0.13 * std::pow(2.0, i) * (1 + 0.17 * k);
      const double error =
          kTrackers[k].error / std::sqrt(time) * std::exp(0.2 * (noise(i, k, 5) - 0.5));
      series.x.push_back(time);
      series.y.push_back(error);
      series.low.push_back(0.88 * error);
      series.high.push_back(1.14 * error);
    }
    chart.series.push_back(series);
  }
  ChartSeries slope{"slope −1/2", {0.1, 100}, {1.6, 1.6 / std::sqrt(1000.0)}};
  slope.is_reference = true;
  chart.series.push_back(slope);
  return chart;
}

BarChart sample_bars() {
  BarChart chart{"Efficiency, delta tracking is 1", {"times as efficient"}, {}};
  for (const Tracker& tracker : kTrackers) {
    const double value = std::pow(0.42 / tracker.error, 2);
    chart.bars.push_back({tracker.name, value, 0.9 * value, 1.1 * value, tracker.error < 0.15});
  }
  chart.mark_at = 1;
  chart.height = 420;
  return chart;
}

Page sample_page() {
  Page page{"Six trackers in one cloud", "disney_cloud.pbrt, 480 × 270 pixels, 60 s for each", {}};
  const auto add = [&](PageBlock block) { page.blocks.push_back(std::move(block)); };
  add(
      PageText{"Decomposition tracking reaches the same error as delta tracking in a ninth of the "
               "time. All trackers but one agree with the reference within their intervals.\n\n"
               "Times are of one machine with four threads; a < b & c are compared by \"error\"."});
  add(
      PageCode{"freepath compare scenes/cloud.pbrt --trackers all --seconds 60 --reference "
               "reference.exr --report report.html"});
  add(PageHeading{"Results"});
  add(sample_table());
  add(PageHeading{"Convergence"});
  add(PageFigure{to_svg(sample_chart()), "convergence.svg",
                 "Bands are intervals of 95 %. Both axes are logarithmic."});
  add(PageFigure{to_svg(sample_bars()), "efficiency.svg", "Longer is better."});
  add(PageFigure{to_svg(sample_histogram()), "free_paths.svg", "Steps around the closed form.",
                 true});
  add(PageHeading{"Pictures"});
  PagePictures pictures{{}, kWidth, kHeight, "Equal time: 60 s each."};
  pictures.pictures.push_back({"reference", puff(1, 0)});
  PageMaps maps{{}, {}, "0", "0.5", "1 and more", "Relative error of each pixel."};
  uint32_t seed = 2;
  for (const Tracker& tracker : kTrackers) {
    pictures.pictures.push_back({tracker.name, puff(seed, tracker.error)});
    maps.maps.push_back({tracker.name, error_map(seed, tracker.error)});
    ++seed;
  }
  maps.scale = make_png(256, 1, [](int column, int) { return heat(column / 255.0); });
  add(pictures);
  add(PageHeading{"Maps of the error"});
  add(maps);
  return page;
}

}  // namespace freepath::testing
