#include "freepath/report/page_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "freepath/base/error.h"
#include "freepath/report/markup.h"

namespace freepath {

namespace {

std::string caption_html(const std::string& caption, std::string_view tag) {
  if (caption.empty()) return {};
  return fmt::format("<{0} class=\"caption\">{1}</{0}>\n", tag, escape_markup(caption));
}

std::string picture_url(const PngBytes& png) { return "data:image/png;base64," + base64(png); }

std::string svg_url(const std::string& svg) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(svg.data());
  return "data:image/svg+xml;base64," + base64({bytes, svg.size()});
}

/// The drawing without what a file may have before it, such as an XML declaration.
std::string_view svg_element(const std::string& svg) {
  const std::size_t begin = svg.find("<svg");
  return begin == std::string::npos ? std::string_view(svg) : std::string_view(svg).substr(begin);
}

/// The width that a drawing has by itself, 0 where it says none.
double svg_width(std::string_view svg) {
  constexpr std::string_view kAttribute = " width=\"";
  const std::size_t offset = svg.substr(0, svg.find('>')).find(kAttribute);
  if (offset == std::string_view::npos) return 0;
  const char* begin = svg.data() + offset + kAttribute.size();
  double width = 0;
  std::from_chars(begin, svg.data() + svg.size(), width);
  return width;
}

// ---- Tables

/// A number as scripts read it; NaN as one that is none.
std::string script_number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  return fmt::format("{}", value);
}

std::string_view tone_class(PageCell::Tone tone) {
  switch (tone) {
    case PageCell::Tone::kBest:
      return "best";
    case PageCell::Tone::kGood:
      return "good";
    case PageCell::Tone::kBad:
      return "bad";
    case PageCell::Tone::kFaint:
      return "faint";
    default:
      return {};
  }
}

std::string head_html(const PageColumn& column) {
  const std::string title =
      column.meaning.empty() ? "" : fmt::format(" title=\"{}\"", escape_markup(column.meaning));
  return fmt::format(R"(<th scope="col"{}{}><button type="button">{}</button></th>)",
                     column.is_numeric ? " class=\"number\"" : "", title,
                     escape_markup(column.name));
}

std::string cell_html(const PageCell& cell, const PageColumn& column) {
  std::string classes = column.is_numeric ? "number" : "";
  const std::string_view tone = tone_class(cell.tone);
  if (!classes.empty() && !tone.empty()) classes += ' ';
  classes += tone;
  std::string html = "<td";
  if (!classes.empty()) html += fmt::format(" class=\"{}\"", classes);
  html += fmt::format(" data-label=\"{}\"", escape_markup(column.name));
  if (column.is_numeric) html += fmt::format(" data-number=\"{}\"", script_number(cell.number));
  html += ">" + escape_markup(cell.text);
  if (!cell.note.empty()) {
    html += fmt::format("<span class=\"note\">{}</span>", escape_markup(cell.note));
  }
  return html + "</td>";
}

// ---- Pictures

std::string options_html(const PagePictures& block) {
  std::string html;
  for (const PagePictures::Picture& picture : block.pictures) {
    html += fmt::format("<option>{}</option>", escape_markup(picture.name));
  }
  return html;
}

std::string tools_html(const PagePictures& block) {
  const std::string options = options_html(block);
  return fmt::format(
      R"html(<div class="tools js-only">
<div><label>Left <select class="choose-left">{0}</select></label>
<button type="button" class="button swap" title="Swap left and right" aria-label="Swap left and right">&#8646;</button>
<label>Right <select class="choose-right">{0}</select></label></div>
<div><span class="where"></span><span class="scale-shown"></span>
<button type="button" class="button zoom-out" title="Zoom out" aria-label="Zoom out">&minus;</button>
<button type="button" class="button zoom-in" title="Zoom in" aria-label="Zoom in">+</button>
<button type="button" class="button zoom-reset">Whole picture</button></div>
</div>
)html",
      options);
}

/// The largest whole multiple of a picture's width that fits into a page, so that all of its pixels
/// are shown in one size. Half of a picture's height, at least, fits into the window.
std::string stage_width(const PagePictures& block) {
  constexpr int kPageWidth = 1150;
  const int multiple = std::max(1, kPageWidth / std::max(1, block.width));
  return fmt::format("min(100%,{}px,calc(80vh*{}/{}))", multiple * block.width, block.width,
                     block.height);
}

std::string stage_html(const PagePictures& block) {
  constexpr std::string_view kLayer =
      R"(<div class="layer {}"><img alt=""><span class="tag"></span></div>)";
  const std::string width = stage_width(block);
  std::string html = fmt::format(
      "<div class=\"stage js-only\" style=\"--seam:50%;width:{};aspect-ratio:{}/{}\">\n", width,
      block.width, block.height);
  html += fmt::format(kLayer, "left") + "\n" + fmt::format(kLayer, "right") + "\n";
  html += "<div class=\"handle\"></div>\n</div>\n";
  html += fmt::format(
      "<input type=\"range\" class=\"seam js-only\" min=\"0\" max=\"100\" step=\"0.1\" "
      "value=\"50\" aria-label=\"Seam between the pictures\" style=\"width:{}\">\n",
      width);
  return html;
}

/// Three to five columns, so that the last row is as full as can be.
std::size_t columns_for(std::size_t count) {
  std::size_t best = 4;
  const auto missing = [&](std::size_t columns) { return (columns - count % columns) % columns; };
  for (const std::size_t columns : {std::size_t{3}, std::size_t{5}}) {
    if (missing(columns) < missing(best)) best = columns;
  }
  return best;
}

}  // namespace

std::string block_html(const PageText& block) {
  // An empty line ends a paragraph.
  std::string html;
  std::size_t begin = 0;
  while (begin < block.text.size()) {
    const std::size_t end = std::min(block.text.find("\n\n", begin), block.text.size());
    if (end > begin) {
      html += fmt::format("<p class=\"prose\">{}</p>\n",
                          escape_markup(block.text.substr(begin, end - begin)));
    }
    begin = end + 2;
  }
  return html;
}

std::string block_html(const PageCode& block) {
  return fmt::format(
      "<div class=\"card code\"><pre tabindex=\"0\"><code>{}</code></pre>\n"
      "<button type=\"button\" class=\"button copy js-only\">Copy</button></div>\n",
      escape_markup(block.text));
}

std::string block_html(const PageTable& block) {
  std::string html = "<figure class=\"card table-card\">\n";
  html += fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">\n",
                      escape_markup(block.caption.empty() ? "Table" : block.caption));
  constexpr std::size_t kMany = 4;  // columns that a phone has no room for
  html += fmt::format("<table{} style=\"--columns:{}\">\n",
                      block.columns.size() >= kMany ? " class=\"many\"" : "", block.columns.size());
  html += "<thead><tr>";
  for (const PageColumn& column : block.columns) html += head_html(column);
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t row = 0; row < block.rows.size(); ++row) {
    const std::vector<PageCell>& cells = block.rows[row];
    if (cells.size() != block.columns.size()) {
      fail("row {} of a table has {} cells for {} columns", row + 1, cells.size(),
           block.columns.size());
    }
    html += "<tr>";
    for (std::size_t i = 0; i < cells.size(); ++i) html += cell_html(cells[i], block.columns[i]);
    html += "</tr>\n";
  }
  html += "</tbody>\n</table></div>\n";
  return html + caption_html(block.caption, "figcaption") + "</figure>\n";
}

std::string block_html(const PageFigure& block) {
  // Letters may grow and shrink a little with the page, not more.
  constexpr double kLargestScale = 1.25;
  constexpr double kSmallestScale = 0.7;
  const std::string_view svg = svg_element(block.svg);
  const double width = svg_width(svg);
  std::string sizes;
  if (width > 0) {
    sizes = fmt::format(" style=\"--widest:{:.0f}px;--least:{:.0f}px\"", kLargestScale * width,
                        kSmallestScale * width);
  }
  std::string html = fmt::format("<figure class=\"card{}\">\n<div class=\"drawing\"{}>\n{}</div>\n",
                                 block.is_wide ? " wide" : "", sizes, svg);
  html += "<div class=\"under\">" + caption_html(block.caption, "figcaption");
  html += fmt::format("<a class=\"button save\" download=\"{}\" href=\"{}\">Save SVG</a></div>\n",
                      escape_markup(block.file_name), svg_url(block.svg));
  return html + "</figure>\n";
}

std::string block_html(const PagePictures& block) {
  if (block.pictures.empty()) return {};
  std::string html =
      fmt::format("<figure class=\"card viewer\" data-width=\"{}\" data-height=\"{}\">\n",
                  block.width, block.height);
  html += tools_html(block) + stage_html(block);
  html += "<div class=\"grid picture-grid\">\n";
  for (const PagePictures::Picture& picture : block.pictures) {
    const std::string name = escape_markup(picture.name);
    html += fmt::format(
        "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\">"
        "<figcaption>{}</figcaption></figure>\n",
        block.width, block.height, name, picture_url(picture.png), name);
  }
  html += "</div>\n";
  return html + caption_html(block.caption, "figcaption") + "</figure>\n";
}

std::string block_html(const PageMaps& block) {
  if (block.maps.empty()) return {};
  std::string html =
      fmt::format("<figure class=\"card maps\">\n<div class=\"grid\" style=\"--columns:{}\">\n",
                  columns_for(block.maps.size()));
  for (const PagePictures::Picture& map : block.maps) {
    const std::string name = escape_markup(map.name);
    html += fmt::format(
        "<figure><button type=\"button\" class=\"enlarge\"><img alt=\"{}\" src=\"{}\"></button>"
        "<figcaption>{}</figcaption></figure>\n",
        name, picture_url(map.png), name);
  }
  html += "</div>\n";
  if (!block.scale.empty()) {
    html += fmt::format(
        "<div class=\"colour-scale\"><img alt=\"Scale of colours\" src=\"{}\">"
        "<div><span>{}</span><span>{}</span><span>{}</span></div></div>\n",
        picture_url(block.scale), escape_markup(block.low), escape_markup(block.middle),
        escape_markup(block.high));
  }
  return html + caption_html(block.caption, "figcaption") + "</figure>\n";
}

}  // namespace freepath
