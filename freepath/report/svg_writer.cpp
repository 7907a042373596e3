#include "freepath/report/svg_writer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "freepath/report/chart_colors.h"
#include "freepath/report/markup.h"

namespace freepath {

namespace {

using Palette = std::array<std::string_view, 8>;

/// Rules that give all classes their colours.
/// @param scope what stands before each selector, such as ":root[data-theme=dark] "
std::string color_rules(std::string_view scope, const ChartInks& inks, const Palette& palette) {
  const std::pair<std::string_view, std::string_view> named[] = {{"ink", inks.ink},
                                                                 {"soft", inks.soft},
                                                                 {"grid", inks.grid},
                                                                 {"bar", inks.bar},
                                                                 {"best", inks.best}};
  std::string rules =
      fmt::format("{0}.fpc{{color:{1}}}{0}.fpc-paper{{fill:{2}}}{0}.fpc-halo{{stroke:{2}}}", scope,
                  inks.ink, inks.paper);
  for (const auto& [name, color] : named) {
    rules += fmt::format("{}.fpc-{}{{color:{}}}", scope, name, color);
  }
  for (std::size_t i = 0; i < palette.size(); ++i) {
    rules += fmt::format("{}.fpc-s{}{{color:{}}}", scope, i + 1, palette[i]);
  }
  return rules;
}

/// The style sheet of every chart. That of a page outweighs the reader's preference where it names
/// a theme, since its selectors are more specific. Colours are written out: many programs that show
/// or convert SVG know no variables of style sheets, and draw black.
std::string drawing_style() {
  std::string style = ".fpc{font-variant-numeric:tabular-nums}\n";
  style += color_rules("", kLightInks, kLightPalette) + "\n";
  style += fmt::format("@media print{{{}}}\n", color_rules("", kPrintInks, kLightPalette));
  style += fmt::format("@media screen and (prefers-color-scheme:dark){{{}}}\n",
                       color_rules("", kDarkInks, kDarkPalette));
  style += fmt::format("@media screen{{{}\n{}}}",
                       color_rules(":root[data-theme=light] ", kLightInks, kLightPalette),
                       color_rules(":root[data-theme=dark] ", kDarkInks, kDarkPalette));
  return style;
}

std::string_view light_ink(std::string_view name) {
  if (name == "soft") return kLightInks.soft;
  if (name == "grid") return kLightInks.grid;
  if (name == "bar") return kLightInks.bar;
  return name == "best" ? kLightInks.best : kLightInks.ink;
}

std::string_view anchor_name(TextAnchor anchor) {
  switch (anchor) {
    case TextAnchor::kMiddle:
      return "middle";
    case TextAnchor::kEnd:
      return "end";
    default:
      return "start";
  }
}

/// Width of a character, in units of the font's size.
double character_width(char character) {
  constexpr std::string_view kNarrow = "ijl.,:;'|!I";
  constexpr std::string_view kSlim = "frt()[]-/ \"";
  constexpr std::string_view kWide = "mwMW%@";
  if ((static_cast<unsigned char>(character) & 0xC0) == 0x80) return 0;  // continues another
  if (kNarrow.find(character) != std::string_view::npos) return 0.32;
  if (kSlim.find(character) != std::string_view::npos) return 0.41;
  if (kWide.find(character) != std::string_view::npos) return 0.96;
  return character >= 'A' && character <= 'Z' ? 0.72 : 0.63;
}

}  // namespace

std::string coordinate(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

double text_width(std::string_view text, double size) {
  double width = 0;
  for (const char character : text) width += character_width(character);
  return width * size;
}

double text_width(const TickLabel& label, double size) {
  return text_width(label.text, size) + text_width(label.exponent, 0.75 * size);
}

std::vector<std::string> wrapped(const std::string& text, double size, double width) {
  std::vector<std::string> lines;
  std::string line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::string longer = line.empty() ? word : fmt::format("{} {}", line, word);
    if (!line.empty() && text_width(longer, size) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    begin = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

std::string shortened(const std::string& text, double size, double width) {
  if (text_width(text, size) <= width) return text;
  constexpr std::string_view kEllipsis = "\u2026";
  std::string result = text;
  while (!result.empty() && text_width(result, size) + size > width) {
    // A character is a byte that continues none, and those that continue it.
    while (result.size() > 1 && (static_cast<unsigned char>(result.back()) & 0xC0) == 0x80) {
      result.pop_back();
    }
    result.pop_back();
  }
  return result.append(kEllipsis);
}

SvgWriter::SvgWriter(double width, double height, std::string_view title,
                     std::string_view summary) {
  const std::string box = fmt::format("{} {}", coordinate(width), coordinate(height));
  add(R"(<svg xmlns="http://www.w3.org/2000/svg" class="fpc" viewBox="0 0 {}" width="{}" )"
      R"(height="{}" color="{}" fill="none" role="img" aria-label="{}" font-family="system-ui, )"
      R"(-apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif">)",
      box, coordinate(width), coordinate(height), kLightInks.ink, escape_markup(summary));
  add("<title>{}</title>", escape_markup(title));
  add("<style>\n{}\n</style>", drawing_style());
  add(R"(<rect class="fpc-paper" width="{}" height="{}" fill="{}"/>)", coordinate(width),
      coordinate(height), kLightInks.paper);
}

void SvgWriter::begin_series(int number) {
  const std::size_t colour = number % kLightPalette.size();
  add(R"(<g class="fpc-s{}" color="{}">)", colour + 1, kLightPalette[colour]);
}

void SvgWriter::begin_ink(std::string_view name) {
  add(R"(<g class="fpc-{}" color="{}">)", name, light_ink(name));
}

// A nested drawing is cut off at its sides by itself; a path to clip by would need an id.
void SvgWriter::begin_clip(const SvgBox& box) {
  const std::string x = coordinate(box.left);
  const std::string y = coordinate(box.top);
  const std::string width = coordinate(box.width());
  const std::string height = coordinate(box.height());
  add(R"(<svg x="{0}" y="{1}" width="{2}" height="{3}" viewBox="{0} {1} {2} {3}" )"
      R"(overflow="hidden">)",
      x, y, width, height);
}

void SvgWriter::end_clip() { add("</svg>"); }

void SvgWriter::line(double x0, double y0, double x1, double y1, std::string_view attributes) {
  add(R"(<line x1="{}" y1="{}" x2="{}" y2="{}" stroke="currentColor"{}{}/>)", coordinate(x0),
      coordinate(y0), coordinate(x1), coordinate(y1), attributes.empty() ? "" : " ", attributes);
}

void SvgWriter::text(double x, double y, TextAnchor anchor, double size, std::string_view markup,
                     std::string_view attributes) {
  add(R"(<text x="{}" y="{}" text-anchor="{}" font-size="{}" fill="currentColor"{}{}>{}</text>)",
      coordinate(x), coordinate(y), anchor_name(anchor), coordinate(size),
      attributes.empty() ? "" : " ", attributes, markup);
}

void SvgWriter::label(double x, double y, TextAnchor anchor, const TickLabel& label) {
  std::string markup = escape_markup(label.text);
  if (!label.exponent.empty()) {
    markup += fmt::format(R"(<tspan dy="-5" font-size="{}">{}</tspan>)",
                          coordinate(0.75 * kTickSize), escape_markup(label.exponent));
  }
  text(x, y, anchor, kTickSize, markup);
}

void SvgWriter::title(const std::vector<std::string>& lines) {
  double baseline = 28;
  for (const std::string& line : lines) {
    text(16, baseline, TextAnchor::kStart, kTitleSize, escape_markup(line), R"(font-weight="600")");
    baseline += 20;
  }
}

std::string SvgWriter::finished() && {
  add("</svg>");
  return std::move(text_);
}

}  // namespace freepath
