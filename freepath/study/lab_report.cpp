#include "freepath/study/lab_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/report/page.h"
#include "freepath/study/lab_figures.h"
#include "freepath/study/lab_numbers.h"

namespace freepath {
namespace {

using Tone = PageCell::Tone;

/// Standard errors beyond which nobody counts them: p underflows.
constexpr double kFarOff = 40;

PageCell text_cell(std::string text, Tone tone = Tone::kPlain) {
  return {.text = std::move(text), .tone = tone};
}

PageCell number_cell(double number, int digits = 3) {
  const bool whole = number >= std::pow(10, digits) && number < 1e6;
  return {.text = whole ? fmt::format("{:.0f}", number) : fmt::format("{:.{}g}", number, digits),
          .number = number};
}

/// Largest distance of the comparisons that count, in standard errors.
double worst_z(const LabMeasurement& measurement) {
  double worst = 0;
  for (const LabCheck& check : checks_of(measurement)) {
    if (check.standing == LabStanding::kTested) worst = std::max(worst, std::abs(check.z));
  }
  return worst;
}

PageCell verdict_cell(const LabMeasurement& measurement, double level) {
  const LabVerdict verdict = verdict_of(measurement, level);
  PageCell cell = text_cell(std::string(to_string(verdict)));
  if (verdict == LabVerdict::kRefuses || verdict == LabVerdict::kUndecided) {
    cell.tone = Tone::kFaint;
  } else if (verdict == LabVerdict::kDiffers) {
    cell.tone = Tone::kBad;
  } else {
    cell.tone = measurement.biased ? Tone::kPlain : Tone::kGood;
  }
  if (measurement.biased) cell.note = "biased";
  return cell;
}

/// Which channel's comparison is the farthest off, and how many of them count.
PageCell check_cell(const LabMeasurement& measurement, LabCheck LabChannel::*member, bool as_p) {
  const LabCheck* worst = nullptr;
  std::size_t tested = 0;
  for (const LabChannel& channel : measurement.channels) {
    const LabCheck& check = channel.*member;
    if (check.standing != LabStanding::kTested) continue;
    ++tested;
    if (worst == nullptr || check.p < worst->p) worst = &check;
  }
  if (worst == nullptr) {
    const LabCheck& check = measurement.channels[0].*member;
    return text_cell(check.standing == LabStanding::kRare ? "rare" : "heavy", Tone::kFaint);
  }
  PageCell cell = number_cell(as_p ? worst->p : worst->z, as_p ? 2 : 3);
  if (!as_p) cell.text = fmt::format("{:+.2f}", worst->z);
  if (tested < measurement.channels.size()) {
    cell.note = fmt::format("{} of {} channels", tested, measurement.channels.size());
  }
  return cell;
}

/// Columns after the tracker's name.
const std::vector<PageColumn>& tracker_columns() {
  static const std::vector<PageColumn> kColumns = {
      {"tracker", "", false},
      {"verdict", "Whether all comparisons that count agree with the exact curves", false},
      {"z of T", "Transmittance: standard errors from the exact value; the channel farthest off"},
      {"p of free paths", "Chance of a distribution of scatterings at least as far off"},
      {"z of radiance", "Standard errors from the exact value; the channel farthest off"},
      {"look-ups", "Component densities read by a path, in all channels together"},
      {"control", "Collisions of a path that the control decides"},
      {"largest weight", "Largest |weight| after a collision"},
      {"variance", "Of the radiance of a path, mean over channels"},
      {"cost", "Look-ups × variance: what a given error costs; less is better"},
      {"ns", "Nanoseconds a path on one thread; differs from run to run"}};
  return kColumns;
}

std::vector<PageCell> tracker_row(const LabMeasurement& measurement, double level) {
  std::vector<PageCell> row = {text_cell(lab_label(measurement.tracker)),
                               verdict_cell(measurement, level)};
  if (!measurement.stands_for.empty()) row[0].note = measurement.stands_for;
  if (!measurement.refusal.empty()) {
    row.resize(tracker_columns().size(), text_cell("–", Tone::kFaint));
    return row;
  }
  row.push_back(check_cell(measurement, &LabChannel::transmittance, false));
  row.push_back(check_cell(measurement, &LabChannel::free_path, true));
  row.push_back(check_cell(measurement, &LabChannel::radiance, false));
  row.push_back(number_cell(measurement.lookups));
  row.push_back(number_cell(measurement.control_collisions));
  row.push_back(number_cell(measurement.statistics.largest_weight));
  row.push_back(number_cell(measurement.variance));
  row.push_back(number_cell(measurement.lookups * measurement.variance));
  row.push_back(number_cell(1e9 * measurement.seconds));
  return row;
}

PageTable tracker_table(const LabFindings& findings, double level) {
  PageTable table;
  table.columns = tracker_columns();
  for (const LabMeasurement& measurement : findings.trackers) {
    table.rows.push_back(tracker_row(measurement, level));
  }
  table.caption =
      "Rare, heavy: the events are too rare, or their weights spread too widely, to be tested.";
  if (findings.setting.channels > 1) {
    table.caption +=
        " Trackers that give each channel a path of its own count the look-ups of all channels.";
  }
  return table;
}

/// All trackers against all settings.
PageTable overview(const LabResult& result) {
  PageTable table;
  table.caption =
      "Largest distance from the exact curves, in standard errors, of all comparisons that count.";
  table.columns.push_back({"tracker", "", false});
  std::vector<std::string> trackers;
  for (const LabFindings& findings : result.settings) {
    table.columns.push_back({findings.setting.name, findings.setting.summary});
    // In the order of the settings' own lists, merged.
    auto next = trackers.begin();
    for (const LabMeasurement& measurement : findings.trackers) {
      auto found = std::find(trackers.begin(), trackers.end(), measurement.tracker);
      if (found == trackers.end()) found = trackers.insert(next, measurement.tracker);
      next = found + 1;
    }
  }
  for (const std::string& tracker : trackers) {
    std::vector<PageCell> row = {text_cell(lab_label(tracker))};
    for (const LabFindings& findings : result.settings) {
      const auto found = std::find_if(findings.trackers.begin(), findings.trackers.end(),
                                      [&](const auto& each) { return each.tracker == tracker; });
      if (found == findings.trackers.end()) {
        row.push_back(text_cell("", Tone::kFaint));
        continue;
      }
      PageCell cell = verdict_cell(*found, result.level);
      if (cell.tone != Tone::kFaint) {
        cell.number = worst_z(*found);
        cell.text = cell.number < kFarOff ? fmt::format("{:.2f}", cell.number) : "> 40";
      }
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_refusals(const LabFindings& findings, Page& page) {
  for (const LabMeasurement& measurement : findings.trackers) {
    if (measurement.refusal.empty()) continue;
    page.blocks.emplace_back(PageText{"Refused: " + measurement.refusal + "."});
  }
}

/// Adds the figures to the page, and to the files.
void add_figures(const LabFindings& findings, const std::vector<LabFigure>& figures, Page& page,
                 std::vector<LabFile>& files) {
  for (const LabFigure& figure : figures) {
    LabFile file{fmt::format("{}-{}.svg", findings.setting.name, figure.name),
                 to_svg(figure.chart)};
    page.blocks.emplace_back(PageFigure{file.content, file.name, figure.caption});
    files.push_back(std::move(file));
  }
}

std::string exact_text(const LabFindings& findings) {
  std::string thickness;
  std::string radiance;
  for (int channel = 0; channel < findings.setting.channels; ++channel) {
    const char* const comma = channel == 0 ? "" : ", ";
    thickness += fmt::format("{}{:.6g}", comma, findings.curves.depth(1, channel));
    radiance += fmt::format("{}{:.8f}", comma, findings.curves.radiance(channel));
  }
  std::string text = fmt::format("{}. Optical thickness {}; exact radiance {}.",
                                 findings.setting.summary, thickness, radiance);
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (findings.setting.name == "fixture-a") {
    text += fmt::format(" Quadrature of the functions, before they became voxels, gives {:.8f}.",
                        fmt::join(kFixtureRadiance, ", "));
  }
  return text;
}

void add_setting(const LabFindings& findings, double level, Page& page,
                 std::vector<LabFile>& files) {
  page.blocks.emplace_back(PageHeading{findings.setting.name});
  page.blocks.emplace_back(PageText{exact_text(findings)});
  page.blocks.emplace_back(tracker_table(findings, level));
  add_refusals(findings, page);
  add_figures(findings, {extinction_figure(findings)}, page, files);
  add_figures(findings, free_path_figures(findings), page, files);
  add_figures(findings, deviation_figures(findings), page, files);
  add_figures(findings, weight_figures(findings), page, files);
  add_figures(findings, throughput_figures(findings), page, files);
  add_figures(findings, sweep_figures(findings), page, files);
}

Page first_page(const LabResult& result) {
  Page page;
  page.title = "Free paths in one dimension";
  page.subtitle =
      fmt::format("{} a tracker, seed {}, {} absorption", counted(result.options.paths, "path"),
                  result.options.seed,
                  result.options.absorption == Absorption::kAnalog ? "analog" : "weighted");
  page.blocks.emplace_back(
      PageText{"Each setting is a medium that varies along x alone, and one ray through it. Its "
               "exact curves "
               "are known: the transmittance T, the scattering µs T along the ray and the radiance "
               "that comes "
               "out. Every tracker is compared with them."});
  page.blocks.emplace_back(PageText{fmt::format(
      "Comparisons of unbiased trackers: {}. A tracker differs where one has a p below "
      "{:.2g}, "
      "so that all of them together raise one false alarm in {:.0f} reports. Comparisons of events "
      "that are too rare, or of weights that spread too widely for a mean to be normal, do not "
      "count.",
      result.tests, result.level, 1 / kLabLevel)});
  page.blocks.emplace_back(overview(result));
  return page;
}

}  // namespace

std::vector<LabFile> lab_files(const LabResult& result, const std::string& command) {
  std::vector<LabFile> plots;
  Page page = first_page(result);
  for (const LabFindings& findings : result.settings) {
    add_setting(findings, result.level, page, plots);
  }
  if (!command.empty()) {
    page.blocks.emplace_back(PageHeading{"Again"});
    page.blocks.emplace_back(PageCode{command});
  }
  std::vector<LabFile> files = {
      {"report.html", to_html(page)}, {"lab.json", lab_json(result)}, {"lab.csv", lab_csv(result)}};
  std::move(plots.begin(), plots.end(), std::back_inserter(files));
  return files;
}

}  // namespace freepath
