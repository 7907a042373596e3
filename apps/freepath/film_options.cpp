#include "apps/freepath/film_options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "apps/freepath/parse.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath::program {
namespace {

/// "0,0,320,180", or "0.0,0.0,0.5,0.5": a point in any of the numbers makes them fractions.
Crop parse_crop(const std::string& text) {
  const std::vector<double> numbers = parse_numbers(text, "--crop");
  if (numbers.size() != 4) {
    fail("--crop: '{}' has {}; give X0,Y0,X1,Y1, the last two of which are outside", text,
         counted(numbers.size(), "value"));
  }
  const Crop crop{numbers[0], numbers[1], numbers[2], numbers[3],
                  text.find('.') != std::string::npos};
  for (const double number : numbers) {
    if (number != std::floor(number) && !crop.fractions) {
      fail("--crop: '{}' has a number of pixels that is not whole", text);
    }
    if (crop.fractions && (number < 0 || number > 1)) {
      fail(
          "--crop: '{}' has a point and so is meant in fractions, from 0.0 to 1.0; pixels are "
          "written without",
          text);
    }
  }
  if (!(crop.x0 < crop.x1 && crop.y0 < crop.y1)) {
    fail("--crop: '{}' has no pixel; give X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1", text);
  }
  return crop;
}

/// "half,dwaa:45": a precision, a compression, or both, in any order.
ExrFormat parse_exr(const std::string& text) {
  struct Word {
    std::string_view name;
    std::optional<ExrPrecision> precision;
    std::optional<ExrCompression> compression;
  };
  using enum ExrCompression;
  const std::array words{Word{"float", ExrPrecision::kFloat, {}},
                         Word{"half", ExrPrecision::kHalf, {}},
                         Word{"none", {}, kNone},
                         Word{"zip", {}, kZip},
                         Word{"zips", {}, kZips},
                         Word{"piz", {}, kPiz},
                         Word{"dwaa", {}, kDwaa},
                         Word{"dwab", {}, kDwab}};
  ExrFormat format;
  std::string_view rest = text;
  while (true) {
    const std::string_view item = rest.substr(0, rest.find(','));
    const std::size_t colon = item.find(':');
    const std::string_view name = item.substr(0, colon);
    const auto* const word = std::find_if(words.begin(), words.end(),
                                          [&](const Word& known) { return known.name == name; });
    if (word == words.end()) {
      fail("--exr: '{}' is none of float, half, none, zip, zips, piz, dwaa:LEVEL, dwab:LEVEL",
           name);
    }
    if (word->precision) format.precision = *word->precision;
    if (word->compression) format.compression = *word->compression;
    if (colon != std::string_view::npos) {
      const std::vector<double> level = parse_numbers(std::string(item.substr(colon + 1)), "--exr");
      const bool is_dwa = word->compression == kDwaa || word->compression == kDwab;
      if (!is_dwa || level.size() != 1 || !(level[0] >= 0 && level[0] <= 1e5)) {
        fail("--exr: '{}' has a level; dwaa and dwab alone have one, of 0 to 100000", item);
      }
      format.dwa_level = static_cast<float>(level[0]);
    }
    if (rest.size() == item.size()) return format;
    rest.remove_prefix(item.size() + 1);
  }
}

}  // namespace

void add_exr_option(CLI::App& command, std::string& text) {
  command
      .add_option("--exr", text,
                  "Form of an .exr: float or half, and none, zip, zips, piz, dwaa:LEVEL or "
                  "dwab:LEVEL, as in half,dwaa:45 [float,zip]")
      ->group("Picture");
}

void add_film_options(CLI::App& command, FilmOptions& o) {
  command
      .add_option("--layers", o.layers,
                  "Layers of an .exr: all, none, or a list of default, albedo, depth, lookups, "
                  "variance, samples (these are the default), normal, position, transmittance, "
                  "emission, background, direct, indirect, halves")
      ->group("Picture");
  command
      .add_option("--crop", o.crop,
                  "Render a part alone, X0,Y0,X1,Y1 from the top left, the last two outside: in "
                  "pixels, or where any has a point in fractions, as in 0.0,0.5,1.0,1.0")
      ->group("Picture");
  add_exr_option(command, o.exr);
  command
      .add_flag(
          "--transparent", o.transparent,
          "Let light from outside, environment and sun, light the scene but not be seen behind "
          "it: R, G and B are without a background, premultiplied by A")
      ->group("Picture");
  command
      .add_flag("--denoise", o.denoise,
                "Denoise the colour by Open Image Denoise, where that is installed; the layer "
                "noisy keeps what was rendered")
      ->group("Picture");
  command
      .add_option("--display", o.display,
                  "HOST:PORT of a running tev, which shows the picture as it grows [port 14158]")
      ->group("Picture");
}

FilmPlan read_film_options(const FilmOptions& options) {
  FilmPlan plan;
  if (!options.layers.empty()) {
    plan.layers = read_option("--layers", [&] { return parse_layers(options.layers); });
  }
  if (!options.crop.empty()) plan.crop = parse_crop(options.crop);
  if (!options.exr.empty()) plan.exr = parse_exr(options.exr);
  plan.transparent = options.transparent;
  if (!options.display.empty()) plan.display = parse_display(options.display);
  if (options.denoise) plan.denoiser = Denoiser::load();
  return plan;
}

ViewTransform read_view(const std::string& text) {
  constexpr std::array kViews{Choice<ViewTransform>{"standard", ViewTransform::kStandard},
                              Choice<ViewTransform>{"neutral", ViewTransform::kNeutral}};
  return parse_choice(text, "--view", kViews);
}

void check_memory(const PixelWindow& window, const FilmPlan& plan,
                  const WavelengthBuckets& buckets) {
  constexpr double kGigabyte = 1e9;
  // The sums of samples, and the picture made of them, which is written from a copy.
  std::size_t channels = 4 + buckets.count + channels_of(plan.written()).size();
  if (plan.denoiser) channels += 20;  // its inputs and output, and the noisy picture
  const auto bytes = static_cast<double>(Film::bytes_per_pixel(plan.recorded(), buckets) +
                                         channels * sizeof(float));
  const double needed = bytes * window.width * window.height;
  const double present = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
  if (needed > 0.8 * present) {
    fail(
        "--size: a picture of {}x{} needs {:.0f} GB of memory, and this machine has {:.0f} GB; "
        "choose a smaller one, or fewer --layers",
        window.width, window.height, needed / kGigabyte, present / kGigabyte);
  }
}

std::shared_ptr<TevDisplay> show_passes(const FilmPlan& plan, const std::string& name,
                                        RenderSettings& settings) {
  if (!plan.display) return nullptr;
  auto display = std::make_shared<TevDisplay>(*plan.display, name);
  settings.on_pass = [display](const Film& film) { display->show(film); };
  return display;
}

}  // namespace freepath::program
