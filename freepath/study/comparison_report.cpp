#include "freepath/study/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "freepath/base/counted.h"
#include "freepath/study/comparison_charts.h"
#include "freepath/study/comparison_figures.h"
#include "freepath/study/heat_map.h"

namespace freepath {
namespace {

using Tone = PageCell::Tone;

std::string interval_note(const Interval& interval, int digits) {
  if (!interval.low) return {};
  return fmt::format("{} to {}", number_text(*interval.low, digits),
                     number_text(*interval.high, digits));
}

PageCell cell_of(const Interval& interval) {
  constexpr int kDigits = 3;
  return {.text = number_text(interval.value, kDigits),
          .number = interval.value,
          .note = interval_note(interval, kDigits)};
}

PageCell efficiency_cell(const ConfigurationResult& result, bool is_best) {
  if (!result.efficiency) return {.text = "-", .note = "below the reference's noise"};
  PageCell cell = cell_of(*result.efficiency);
  cell.text += "×";
  if (is_best) cell.tone = Tone::kBest;
  return cell;
}

PageCell bias_cell(const ConfigurationResult& result) {
  const double worst = result.bias.worst();
  PageCell cell{.text = std::string(to_string(result.verdict)),
                .number = worst,
                .note = fmt::format("|z| up to {:.2f}", worst),
                .tone = Tone::kGood};
  if (result.verdict == BiasVerdict::kFails) {
    cell.text = "BIASED";
    cell.tone = Tone::kBad;
  }
  if (result.verdict == BiasVerdict::kUndecided) {
    cell.note += result.bias.is_heavy_tailed ? ", heavy tails" : ", shared noise";
    cell.tone = Tone::kFaint;
  }
  if (result.is_biased) cell.note += ", biased by design";
  return cell;
}

/// The most efficient one that is to be trusted.
std::optional<std::size_t> best_of(const Comparison& comparison) {
  const std::vector<ConfigurationResult>& all = comparison.configurations;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].is_trusted() || !all[i].efficiency) continue;
    if (!best || all[i].efficiency->value > all[*best].efficiency->value) best = i;
  }
  return best;
}

/// Places of the configurations, the most efficient first.
std::vector<std::size_t> by_efficiency(const Comparison& comparison) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < comparison.configurations.size(); ++i) order.push_back(i);
  const auto efficiency = [&](std::size_t i) {
    const auto& known = comparison.configurations[i].efficiency;
    return known ? known->value : 0;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return efficiency(a) > efficiency(b); });
  return order;
}

/// Those figures that are errors, or the others.
PageTable table_of(const Comparison& comparison, bool errors) {
  constexpr std::size_t kErrorFigures = 6;  // of comparison_figures(), the first
  const std::vector<ComparisonFigure>& figures = comparison_figures();
  const std::size_t begin = errors ? 0 : kErrorFigures;
  const std::size_t end = errors ? kErrorFigures : figures.size();
  PageTable table;
  table.columns.push_back({.name = "method", .meaning = {}, .is_numeric = false});
  if (errors) {
    table.columns.push_back(
        {.name = "efficiency",
         .meaning = fmt::format("1/(MSE · CPU time) over that of {}, round by round",
                                comparison.configurations[comparison.baseline].name)});
    table.columns.push_back({.name = "bias test",
                             .meaning = "whether the distance from the reference is explained by "
                                        "chance, for the mean and for blocks of 16×16 pixels"});
  }
  for (std::size_t i = begin; i < end; ++i) {
    table.columns.push_back(
        {.name = std::string(figures[i].name), .meaning = std::string(figures[i].meaning)});
  }
  const std::optional<std::size_t> best = best_of(comparison);
  for (const std::size_t which : by_efficiency(comparison)) {
    const ConfigurationResult& result = comparison.configurations[which];
    std::vector<PageCell>& row = table.rows.emplace_back();
    row.push_back({.text = result.name, .tone = which == best ? Tone::kBest : Tone::kPlain});
    if (errors) {
      row.push_back(efficiency_cell(result, which == best));
      row.push_back(bias_cell(result));
    }
    for (std::size_t i = begin; i < end; ++i) {
      row.push_back(cell_of(result.over_runs(figures[i].of_run)));
    }
  }
  table.caption = fmt::format(
      "Means of {}; below them the interval that holds the true value with a probability of "
      "{:.0f} %, given the reference.",
      counted(comparison.configurations.front().runs.size(), "run"), 100 * kConfidence);
  return table;
}

PngBytes png_of(const PixelEstimates& estimates, double exposure) {
  return encode_png(to_image(estimates), {.exposure = exposure}, "a picture of the report");
}

PagePictures pictures_of(const Comparison& comparison, const ReportContext& context) {
  const Reference& first = comparison.references.front();
  PagePictures pictures;
  pictures.width = first.estimates.width;
  pictures.height = first.estimates.height;
  pictures.pictures.push_back({"reference", png_of(first.estimates, context.exposure)});
  if (comparison.references.size() > 1) {
    pictures.pictures.push_back({"reference of the other interpolation",
                                 png_of(comparison.references[1].estimates, context.exposure)});
  }
  for (const ConfigurationResult& result : comparison.configurations) {
    pictures.pictures.push_back({result.name, png_of(result.first, context.exposure)});
  }
  pictures.caption = "The first run of each method beside the reference.";
  return pictures;
}

/// Maps of one kind, one for each configuration, on one scale.
PageMaps maps_of(const Comparison& comparison, const std::vector<std::vector<float>>& values,
                 const ColorScale& scale, const std::string& caption) {
  PageMaps maps;
  maps.caption = caption;
  const PixelEstimates& reference = comparison.references.front().estimates;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool small = values[i].size() != reference.pixel_count();
    const BiasTest& test = comparison.configurations[i].bias;
    const int width = small ? test.blocks_across : reference.width;
    const int height = small ? test.blocks_down : reference.height;
    maps.maps.push_back({comparison.configurations[i].name,
                         encode_png(heat_map(values[i], width, height, scale), {}, "a map")});
  }
  maps.scale = encode_png(color_bar(scale), {}, "a scale");
  maps.low = number_text(scale.value(0), 2);
  maps.middle = number_text(scale.value(0.5), 2);
  maps.high = number_text(scale.value(1), 2);
  return maps;
}

std::vector<std::span<const float>> spans_of(const std::vector<std::vector<float>>& maps) {
  return {maps.begin(), maps.end()};
}

/// |difference| over the reference's luminance, of the first runs.
std::vector<std::vector<float>> error_maps(const Comparison& comparison) {
  std::vector<std::vector<float>> maps;
  for (std::size_t which = 0; which < comparison.configurations.size(); ++which) {
    const PixelEstimates& reference = comparison.reference(which).estimates;
    const PixelEstimates& picture = comparison.configurations[which].first;
    std::vector<float>& map = maps.emplace_back();
    for (std::size_t pixel = 0; pixel < reference.pixel_count(); ++pixel) {
      double squares = 0;
      double expected = 0;
      for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
        const double difference = picture.mean[i] - reference.mean[i];
        squares += difference * difference / 3;
        expected += reference.mean[i] / 3.0;
      }
      map.push_back(static_cast<float>(std::sqrt(squares) / (std::abs(expected) + 0.01)));
    }
  }
  return maps;
}

void add_maps(const Comparison& comparison, Page& page) {
  const std::vector<std::vector<float>> errors = error_maps(comparison);
  page.blocks.emplace_back(maps_of(comparison, errors, logarithmic_scale(spans_of(errors)),
                                   "Error of the first run, relative to the reference."));
  std::vector<std::vector<float>> lookups;
  std::vector<std::vector<float>> differences;
  std::vector<std::vector<float>> z;
  for (const ConfigurationResult& result : comparison.configurations) {
    lookups.push_back(result.together.lookups);
    differences.push_back(result.flip);
    std::vector<float>& blocks = z.emplace_back();
    for (std::size_t i = 0; i + 2 < result.bias.block_z.size(); i += 3) {
      // Of the three channels the one that strays furthest.
      const float* const values = &result.bias.block_z[i];
      blocks.push_back(*std::max_element(
          values, values + 3, [](float a, float b) { return std::abs(a) < std::abs(b); }));
    }
  }
  page.blocks.emplace_back(maps_of(comparison, lookups, logarithmic_scale(spans_of(lookups)),
                                   "Look-ups of a path, with its shadow rays."));
  page.blocks.emplace_back(
      maps_of(comparison, differences, ColorScale{.low = 0, .high = 1}, "FLIP of the first run."));
  const ColorScale around_zero{
      .low = -comparison.threshold, .high = comparison.threshold, .diverging = true};
  page.blocks.emplace_back(maps_of(
      comparison, z, around_zero,
      "z of blocks of 16×16 pixels, all runs together, of the channel that strays furthest. The "
      "ends of the scale are where chance stops being an explanation."));
}

std::string method_text(const Comparison& comparison) {
  const ConfigurationResult& baseline = comparison.configurations[comparison.baseline];
  return fmt::format(
      "Each method was run {} with seeds of its own. A round runs all methods, beginning "
      "with another one each time, so that what slows the machine down meets all alike; "
      "efficiencies, 1/(MSE · CPU time), are relative to {} in the same round, and their intervals "
      "are "
      "Student's, of the rounds' logarithms. MSE is stated less the reference's own variance, so "
      "it estimates that of the method alone. The bias test compares all runs of a method "
      "together with the reference, the variances of both included: the means of the channels "
      "and of blocks of 16×16 pixels. {} in all; for a false alarm in a share of {:g} of all "
      "reports, |z| may reach {:.2f}.",
      counted(baseline.runs.size(), "time"), baseline.name, counted(comparison.tests, "test"),
      comparison.level, comparison.threshold);
}

}  // namespace

std::vector<std::string> findings_of(const Comparison& comparison) {
  std::vector<std::string> findings;
  const ConfigurationResult& baseline = comparison.configurations[comparison.baseline];
  const std::optional<std::size_t> which = best_of(comparison);
  if (!which) {
    findings.emplace_back(
        "Which method is the most efficient can't be told: none that is to be trusted has errors "
        "above the reference's noise.");
  } else if (*which == comparison.baseline) {
    findings.push_back(
        fmt::format("No method that is to be trusted is more efficient than {}.", baseline.name));
  } else {
    const ConfigurationResult& best = comparison.configurations[*which];
    const Interval& gain = *best.efficiency;
    const std::string range =
        gain.low ? fmt::format(" ({})", interval_note(gain, 3)) : std::string();
    findings.push_back(fmt::format("{} is the most efficient: {}× {}{}.", best.name,
                                   number_text(gain.value, 3), baseline.name, range));
    if (gain.low && *gain.low < 1) {
      findings.emplace_back(
          "Its interval holds 1: more repeats would tell whether that is chance.");
    }
  }
  for (const ConfigurationResult& result : comparison.configurations) {
    if (result.bias.is_heavy_tailed) {
      findings.push_back(fmt::format(
          "{} has samples that are rare and large: a few pixels hold most of its variance. Its "
          "errors are guesses, and the bias test can't tell; give it more time, or a tracker whose "
          "weights are bounded.",
          result.name));
    } else if (result.verdict == BiasVerdict::kFails) {
      findings.push_back(fmt::format("{} fails the bias test, |z| = {:.1f}{}.", result.name,
                                     result.bias.worst(),
                                     result.is_biased ? ", as it says itself that it is biased"
                                                      : ": do not trust it on this picture"));
    } else if (result.is_biased) {
      findings.push_back(fmt::format(
          "{} passes the bias test, though it says itself that it is biased: the bias is "
          "smaller than the noise.",
          result.name));
    }
  }
  for (const ConfigurationResult& result : comparison.configurations) {
    uint64_t overflows = 0;
    for (const ComparisonRun& run : result.runs) overflows += run.overflows;
    if (overflows == 0) continue;
    findings.push_back(
        fmt::format("The weights of {} of {} left the range of float and count as 0: its "
                    "pictures are not to be trusted.",
                    counted(overflows, "path"), result.name));
  }
  for (const Reference& reference : comparison.references) {
    if (reference.variance_known) continue;
    findings.emplace_back(
        "The reference's variance is not known: its noise is in every MSE, and bias tests fail "
        "where it shows. Give one with variance channels, or let it be made.");
  }
  return findings;
}

Page page_of(const Comparison& comparison, const ReportContext& context) {
  Page page{.title = "Estimators on " + context.target, .subtitle = {}, .blocks = {}};
  page.subtitle = fmt::format("freepath compare, {}, {}", context.date, context.machine);
  page.blocks.emplace_back(PageHeading{"What came out"});
  for (const std::string& finding : findings_of(comparison)) {
    page.blocks.emplace_back(PageText{finding});
  }
  page.blocks.emplace_back(PageHeading{"Errors and efficiency"});
  page.blocks.emplace_back(table_of(comparison, true));
  page.blocks.emplace_back(PageHeading{"Work"});
  page.blocks.emplace_back(table_of(comparison, false));
  page.blocks.emplace_back(PageHeading{"Figures"});
  for (const NamedFigure& figure : figures_of(comparison)) {
    page.blocks.emplace_back(
        PageFigure{figure.svg, figure.file_name, figure.caption, figure.is_wide});
  }
  page.blocks.emplace_back(PageHeading{"Pictures"});
  page.blocks.emplace_back(pictures_of(comparison, context));
  page.blocks.emplace_back(PageHeading{"Maps"});
  add_maps(comparison, page);
  page.blocks.emplace_back(PageHeading{"How it was made"});
  page.blocks.emplace_back(PageText{method_text(comparison)});
  for (const Reference& reference : comparison.references) {
    page.blocks.emplace_back(PageText{"Reference: " + reference.origin + "."});
  }
  page.blocks.emplace_back(PageCode{context.command});
  return page;
}

}  // namespace freepath
