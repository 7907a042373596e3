// freepath diff: how far two images are apart, and whether chance explains it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/freepath/commands.h"
#include "apps/freepath/console.h"
#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/io/image.h"

namespace freepath::program {

namespace {

constexpr const char* kDiffFooter =
    R"(A and B are images of the same size, or B is constant:V or constant:R,G,B.

Measures, over all finite pixels and the channels compared:
  mse                 mean of (a - b)²
  relative_mse        mean of (a - b)² / (b² + 0.01); B is the reference
  mean_ratio          mean of A / mean of B, for each channel
  largest_difference  largest |a - b|
  z                   difference of the means in standard errors, for each channel, where A has a
                      variance.* channel for it, and B too or B is constant
  z_above_3           fraction of pixels that are more than 3 standard errors apart (0.0027 by
                      chance, more where a pixel has few samples)

Exit status: 0, or 1 if a limit is exceeded (with a limit, a NaN or infinite pixel exceeds it too).

Examples:
  freepath diff render.exr reference.exr
  freepath diff furnace.exr constant:1 --max-z 4
  freepath diff a.exr b.exr --channel-prefix albedo --json
  freepath diff a.exr b.exr --channels A,depth.Z)";

constexpr double kRelativeFloor = 0.01;  // keeps the relative error of black pixels finite

struct DiffOptions {
  std::string a, b;
  std::vector<std::string> channels;
  std::string prefix;
  bool json = false;
  std::optional<double> max_relative_mse, max_z;
};

/// One side of the comparison: an image, or the same values in every pixel.
struct Side {
  std::string name;
  std::optional<Image> image;
  std::vector<double> constant;  // one value, or one for each channel
};

struct ChannelDifference {
  std::string name;
  double mean_a = 0, mean_b = 0;
  double mse = 0, relative_mse = 0;
  double largest = 0;
  std::size_t largest_pixel = 0;
  /// Where the variance is known.
  struct Significance {
    double standard_error = 0;  ///< Of the difference of the means.
    double z = 0;
    double z_above_3 = 0;
  };
  std::optional<Significance> significance;
};

struct Difference {
  int width = 0, height = 0;
  std::vector<ChannelDifference> channels;
  std::vector<std::size_t> non_finite;  // pixels that were left out

  std::size_t compared() const {
    return static_cast<std::size_t>(width) * height - non_finite.size();
  }
  double mse() const { return mean(&ChannelDifference::mse); }
  double relative_mse() const { return mean(&ChannelDifference::relative_mse); }
  const ChannelDifference& worst() const {
    return *std::max_element(channels.begin(), channels.end(),
                             [](const auto& x, const auto& y) { return x.largest < y.largest; });
  }
  std::string pixel_text(std::size_t pixel) const {
    return fmt::format("({}, {})", pixel % width, pixel / width);
  }

 private:
  double mean(double ChannelDifference::*part) const {
    double sum = 0;
    for (const ChannelDifference& channel : channels) sum += channel.*part;
    return sum / static_cast<double>(channels.size());
  }
};

/// The values of a channel on one side, and their variances if they are known.
class ChannelView {
 public:
  ChannelView(const Side& side, const std::string& channel, std::size_t number) {
    if (!side.image) {
      constant_ = side.constant[side.constant.size() == 1 ? 0 : number];
      return;
    }
    const Image& image = *side.image;
    const auto found = find_channel(image, channel);
    if (!found) {
      fail("{}: no channel {} among {}", side.name, channel, fmt::join(image.channels, ", "));
    }
    stride_ = image.channels.size();
    values_ = image.values.data() + *found;
    if (const auto variance = find_channel(image, "variance." + channel)) {
      variances_ = image.values.data() + *variance;
    }
  }

  bool variance_known() const { return values_ == nullptr || variances_ != nullptr; }
  double value(std::size_t pixel) const { return values_ ? values_[pixel * stride_] : constant_; }
  double variance(std::size_t pixel) const { return variances_ ? variances_[pixel * stride_] : 0; }
  bool is_finite(std::size_t pixel) const {
    return std::isfinite(value(pixel)) && std::isfinite(variance(pixel));
  }

 private:
  double constant_ = 0;
  const float* values_ = nullptr;
  const float* variances_ = nullptr;
  std::size_t stride_ = 0;
};

std::vector<double> parse_constant(const std::string& text) {
  std::vector<double> values;
  std::string_view rest = std::string_view(text).substr(text.find(':') + 1);
  while (true) {
    const std::string_view item = rest.substr(0, rest.find(','));
    double value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error != std::errc() || end != item.data() + item.size() || !std::isfinite(value)) {
      fail("{}: \"{}\" is not a number; write constant:V or constant:R,G,B", text, item);
    }
    values.push_back(value);
    if (item.size() == rest.size()) return values;
    rest.remove_prefix(item.size() + 1);
  }
}

Side read_side(const std::string& text) {
  if (text.rfind("constant:", 0) == 0) return {text, {}, parse_constant(text)};
  return {text, read_image(text), {}};
}

/// The names of the channels to compare.
std::vector<std::string> chosen_channels(const DiffOptions& options, const Image& image) {
  if (!options.channels.empty()) return options.channels;
  if (!options.prefix.empty()) {
    return {options.prefix + ".R", options.prefix + ".G", options.prefix + ".B"};
  }
  const std::array<int, 3> colour = colour_channels(image, options.a);
  if (colour[0] == colour[1]) return {image.channels[colour[0]]};
  return {image.channels[colour[0]], image.channels[colour[1]], image.channels[colour[2]]};
}

ChannelDifference compare_channel(const std::string& name, const ChannelView& a,
                                  const ChannelView& b, const std::vector<std::size_t>& pixels) {
  ChannelDifference result;
  result.name = name;
  double sum_a = 0;
  double sum_b = 0;
  double squares = 0;
  double relative_squares = 0;
  double variances = 0;
  std::size_t outliers = 0;
  for (const std::size_t pixel : pixels) {
    const double value_a = a.value(pixel);
    const double value_b = b.value(pixel);
    const double difference = value_a - value_b;
    sum_a += value_a;
    sum_b += value_b;
    squares += difference * difference;
    relative_squares += difference * difference / (value_b * value_b + kRelativeFloor);
    if (std::abs(difference) > result.largest) {
      result.largest = std::abs(difference);
      result.largest_pixel = pixel;
    }
    // Values were rounded to floats, which is all that differs where the variance is nil.
    const double rounding = 0x1p-24 * std::hypot(value_a, value_b);
    const double variance = a.variance(pixel) + b.variance(pixel) + rounding * rounding;
    variances += variance;
    if (difference * difference > 9 * variance) ++outliers;
  }
  const auto count = static_cast<double>(pixels.size());
  result.mean_a = sum_a / count;
  result.mean_b = sum_b / count;
  result.mse = squares / count;
  result.relative_mse = relative_squares / count;
  if (a.variance_known() && b.variance_known()) {
    const double difference = sum_a - sum_b;
    result.significance = {std::sqrt(variances) / count,
                           difference == 0 ? 0 : difference / std::sqrt(variances),
                           static_cast<double>(outliers) / count};
  }
  return result;
}

Difference compare(const DiffOptions& options) {
  const Side a = read_side(options.a);
  const Side b = read_side(options.b);
  if (!a.image) fail("{}: A must be an image; only B may be constant", options.a);
  Difference result;
  result.width = a.image->width;
  result.height = a.image->height;
  if (b.image && (b.image->width != result.width || b.image->height != result.height)) {
    fail("{} has {}x{} pixels and {} has {}x{}; only images of one size can be compared", a.name,
         result.width, result.height, b.name, b.image->width, b.image->height);
  }
  if (b.image && !are_same(a.image->chromaticities.value_or(RgbChromaticities()),
                           b.image->chromaticities.value_or(RgbChromaticities()))) {
    fail(
        "{} and {} have R, G and B of different colour spaces (their chromaticities differ); "
        "convert one of them first",
        a.name, b.name);
  }
  const std::vector<std::string> names = chosen_channels(options, *a.image);
  if (!b.image && b.constant.size() != 1 && b.constant.size() != names.size()) {
    fail("{} has {}, but {} compared: {}", b.name, counted(b.constant.size(), "value"),
         counted(names.size(), "channel is", "channels are"), fmt::join(names, ", "));
  }
  std::vector<ChannelView> views_a;
  std::vector<ChannelView> views_b;
  for (std::size_t i = 0; i < names.size(); ++i) {
    views_a.emplace_back(a, names[i], i);
    views_b.emplace_back(b, names[i], i);
  }
  std::vector<std::size_t> finite;
  for (std::size_t pixel = 0; pixel < a.image->pixel_count(); ++pixel) {
    const auto is_finite = [&](const ChannelView& view) { return view.is_finite(pixel); };
    const bool all = std::all_of(views_a.begin(), views_a.end(), is_finite) &&
                     std::all_of(views_b.begin(), views_b.end(), is_finite);
    (all ? finite : result.non_finite).push_back(pixel);
  }
  if (finite.empty()) fail("{} and {} have no pixel that is finite in both", a.name, b.name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    result.channels.push_back(compare_channel(names[i], views_a[i], views_b[i], finite));
  }
  return result;
}

constexpr std::size_t kNamedPixels = 5;  // of those that are not finite

void print_json(const Difference& difference) {
  using Json = nlohmann::ordered_json;
  nlohmann::ordered_json json = {{"mse", difference.mse()},
                                 {"relative_mse", difference.relative_mse()},
                                 {"mean_ratio", Json::array()},
                                 {"largest_difference", difference.worst().largest}};
  for (const char* key : {"z", "z_above_3", "standard_error", "mean_a", "mean_b", "channels"}) {
    json[key] = Json::array();
  }
  for (const ChannelDifference& channel : difference.channels) {
    // What is unknown or infinite becomes null.
    json["mean_ratio"].push_back(channel.mean_a / channel.mean_b);
    const auto& significance = channel.significance;
    const auto known = [&](double ChannelDifference::Significance::*part) {
      return significance ? Json((*significance).*part) : Json();
    };
    json["z"].push_back(known(&ChannelDifference::Significance::z));
    json["z_above_3"].push_back(known(&ChannelDifference::Significance::z_above_3));
    json["standard_error"].push_back(known(&ChannelDifference::Significance::standard_error));
    json["mean_a"].push_back(channel.mean_a);
    json["mean_b"].push_back(channel.mean_b);
    json["channels"].push_back(channel.name);
  }
  json["pixels"] = difference.compared();
  json["non_finite_pixels"] = difference.non_finite.size();
  json["first_non_finite"] = Json::array();
  for (std::size_t i = 0; i < std::min(kNamedPixels, difference.non_finite.size()); ++i) {
    const std::size_t pixel = difference.non_finite[i];
    json["first_non_finite"].push_back({pixel % difference.width, pixel / difference.width});
  }
  print_json_text(json);
}

void print_table(const Difference& difference) {
  const auto number = [](double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-";
  };
  constexpr const char* kRow = "{:<12}{:>12}{:>12}{:>11}{:>12}{:>12}{:>12}{:>11}{:>10}\n";
  print(kRow, "channel", "mean A", "mean B", "ratio", "MSE", "rel. MSE", "largest", "z", "|z| > 3");
  for (const ChannelDifference& channel : difference.channels) {
    const auto& significance = channel.significance;
    print(kRow, channel.name, number(channel.mean_a, 6), number(channel.mean_b, 6),
          number(channel.mean_a / channel.mean_b, 6), number(channel.mse, 4),
          number(channel.relative_mse, 4), number(channel.largest, 4),
          significance ? number(significance->z, 3) : "-",
          significance ? fmt::format("{:.2f}%", 100 * significance->z_above_3) : "-");
  }
  const ChannelDifference& worst = difference.worst();
  print("all: MSE {:.6g}, relative MSE {:.6g}, largest difference {:.6g}", difference.mse(),
        difference.relative_mse(), worst.largest);
  if (worst.largest > 0) {
    print(" in {} at pixel {}", worst.name, difference.pixel_text(worst.largest_pixel));
  }
  print("\n{} of {}x{} pixels compared\n", difference.compared(), difference.width,
        difference.height);
  if (difference.non_finite.empty()) return;
  print("not finite, left out: {}:", counted(difference.non_finite.size(), "pixel"));
  for (std::size_t i = 0; i < std::min(kNamedPixels, difference.non_finite.size()); ++i) {
    print(" {}", difference.pixel_text(difference.non_finite[i]));
  }
  print("{}\n", difference.non_finite.size() > kNamedPixels ? " ..." : "");
}

/// Whether every limit holds; says on standard error which does not.
bool within_limits(const DiffOptions& options, const Difference& difference) {
  bool within = true;
  const auto exceeded = [&](const std::string& what) {
    tell("freepath: {}\n", what);
    within = false;
  };
  if (options.max_relative_mse && !(difference.relative_mse() <= *options.max_relative_mse)) {
    exceeded(fmt::format("the relative MSE {:.6g} exceeds {:.6g}", difference.relative_mse(),
                         *options.max_relative_mse));
  }
  for (const ChannelDifference& channel : difference.channels) {
    if (!options.max_z) break;
    if (!channel.significance) {
      fail(
          "--max-z: the variance of channel {} is not known; A, and B if it is an image, need a "
          "channel variance.{}",
          channel.name, channel.name);
    }
    if (!(std::abs(channel.significance->z) <= *options.max_z)) {
      exceeded(fmt::format("|z| of channel {} is {:.3g} and exceeds {:.6g}", channel.name,
                           std::abs(channel.significance->z), *options.max_z));
    }
  }
  if ((options.max_relative_mse || options.max_z) && !difference.non_finite.empty()) {
    exceeded(counted(difference.non_finite.size(), "pixel is not finite", "pixels are not finite"));
  }
  return within;
}

void run(const DiffOptions& options) {
  const Difference difference = compare(options);
  if (options.json) {
    print_json(difference);
  } else {
    print_table(difference);
  }
  if (!within_limits(options, difference)) throw CLI::RuntimeError(1);
}

}  // namespace

void add_diff_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("diff", "Compare two images, with statistics");
  const auto options = std::make_shared<DiffOptions>();
  command->add_option("A", options->a, "Image")->required();
  command->add_option("B", options->b, "Image, constant:V or constant:R,G,B")->required();
  auto* channels = command
                       ->add_option("--channels", options->channels,
                                    "Channels to compare, NAME,NAME,... (default: the colour)")
                       ->delimiter(',')
                       ->type_name("NAME");
  command
      ->add_option("--channel-prefix", options->prefix, "Compare PREFIX.R, PREFIX.G and PREFIX.B")
      ->type_name("PREFIX")
      ->excludes(channels);
  command->add_flag("--json", options->json, "Print one JSON object instead of a table");
  command
      ->add_option("--max-relative-mse", options->max_relative_mse,
                   "Exit with 1 if the relative MSE is larger")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--max-z", options->max_z, "Exit with 1 if a channel's |z| is larger")
      ->check(CLI::NonNegativeNumber);
  command->footer(kDiffFooter);
  command->callback([options] { run(*options); });
}

}  // namespace freepath::program
