#include "freepath/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <type_traits>

#include "freepath/report/markup.h"
#include "freepath/report/page_blocks.h"
#include "freepath/report/page_script.h"
#include "freepath/report/page_style.h"

namespace freepath {

namespace {

/// Letters and digits of a heading, joined by hyphens, and unlike all before.
std::string anchor_of(const std::string& heading, std::set<std::string>& taken) {
  std::string anchor;
  for (const char character : heading) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x80 && std::isalnum(byte) != 0) {
      anchor += static_cast<char>(std::tolower(byte));
    } else if (!anchor.empty() && anchor.back() != '-') {
      anchor += '-';
    }
  }
  while (!anchor.empty() && anchor.back() == '-') anchor.pop_back();
  if (anchor.empty()) anchor = "section";
  std::string unique = anchor;
  for (int number = 2; !taken.insert(unique).second; ++number) {
    unique = fmt::format("{}-{}", anchor, number);
  }
  return unique;
}

/// All blocks, in sections that begin with headings, and the list of contents.
class BodyWriter {
 public:
  void add(const PageBlock& block) {
    std::visit([&](const auto& kind) { add_kind(kind); }, block);
  }

  std::string contents() const { return contents_; }

  std::string finished() && {
    leave_figures();
    if (in_section_) html_ += "</section>\n";
    return std::move(html_);
  }

 private:
  void add_kind(const PageHeading& heading) {
    leave_figures();
    if (in_section_) html_ += "</section>\n";
    in_section_ = true;
    const std::string anchor = anchor_of(heading.text, anchors_);
    const std::string text = escape_markup(heading.text);
    html_ += fmt::format("<section id=\"{0}\">\n<h2><a href=\"#{0}\">{1}</a></h2>\n", anchor, text);
    contents_ += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", anchor, text);
  }

  template <class Kind>
  void add_kind(const Kind& block) {
    // Figures that follow each other stand side by side.
    if constexpr (std::is_same_v<Kind, PageFigure>) {
      if (!in_figures_) html_ += "<div class=\"figures\">\n";
      in_figures_ = true;
    } else {
      leave_figures();
    }
    html_ += block_html(block);
  }

  void leave_figures() {
    if (in_figures_) html_ += "</div>\n";
    in_figures_ = false;
  }

  std::string html_, contents_;
  std::set<std::string> anchors_;
  bool in_section_ = false;
  bool in_figures_ = false;
};

std::string page_style() {
  std::string style = fmt::format(":root{{{}}}\n", kPageLightColours);
  style += fmt::format("@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n",
                       kPageDarkColours);
  style +=
      fmt::format("@media screen{{:root[data-theme=light]{{{}}}\n:root[data-theme=dark]{{{}}}}}\n",
                  kPageLightColours, kPageDarkColours);
  style += kPageStyle;
  return style + fmt::format("@media print{{:root{{{}}}{}}}\n", kPagePrintColours, kPagePrintStyle);
}

/// Nothing is loaded from anywhere, and a browser sees to it.
constexpr std::string_view kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "base-uri 'none'; form-action 'none'";

std::string head_html(const std::string& title) {
  return fmt::format(
      R"html(<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{}</title>
<link rel="icon" href="data:,">
<style>
{}</style>
<script>{}</script>
</head>
)html",
      kPolicy, title, page_style(), kPageFirstScript);
}

std::string bar_html(const std::string& contents) {
  return fmt::format(
      R"html(<div class="bar"><div class="bar-inner">
<nav class="contents" aria-label="Contents"><ol>
{}</ol></nav>
<button type="button" class="button theme js-only"><svg viewBox="0 0 16 16" aria-hidden="true"><circle cx="8" cy="8" r="6.5" fill="none" stroke="currentColor" stroke-width="1.5"/><path d="M8 1.5a6.5 6.5 0 0 1 0 13z" fill="currentColor"/></svg><span>Auto</span></button>
</div></div>
)html",
      contents);
}

}  // namespace

std::string to_html(const Page& page) {
  BodyWriter body;
  for (const PageBlock& block : page.blocks) body.add(block);
  const std::string title = escape_markup(page.title);
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n" + head_html(title) + "<body>\n";
  html += bar_html(body.contents());
  html += fmt::format("<main>\n<header class=\"opening\">\n<h1>{}</h1>\n", title);
  if (!page.subtitle.empty()) {
    html += fmt::format("<p class=\"subtitle\">{}</p>\n", escape_markup(page.subtitle));
  }
  html += "</header>\n" + std::move(body).finished() + "</main>\n";
  html += "<dialog class=\"enlarged\"><img alt=\"\"><p></p></dialog>\n";
  html += fmt::format("<script>{}</script>\n</body>\n</html>\n", kPageScript);
  return html;
}

}  // namespace freepath
