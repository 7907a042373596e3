#include "freepath/report/page.h"

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "freepath/base/error.h"
#include "freepath/report/markup.h"
#include "tests/report/sample_page.h"
#include "tests/report/well_formed.h"

namespace freepath {
namespace {

using testing::count;
using testing::sample_page;

std::string html_of(PageBlock block) {
  Page page{"title", "", {}};
  page.blocks.push_back(std::move(block));
  return to_html(page);
}

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

// RFC 4648, section 10.
TEST(Base64, GivesThePublishedAnswers) {
  EXPECT_EQ(base64(bytes_of("")), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foo")), "Zm9v");
  EXPECT_EQ(base64(bytes_of("foob")), "Zm9vYg==");
  EXPECT_EQ(base64(bytes_of("fooba")), "Zm9vYmE=");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
  EXPECT_EQ(base64(std::vector<uint8_t>{0xFB, 0xFF, 0xBF}), "+/+/");
}

TEST(Markup, KeepsCharactersAndReplacesWhatIsNone) {
  EXPECT_EQ(escape_markup("a\t<&>\"'\n"), "a\t&lt;&amp;&gt;&quot;&#39;\n");
  EXPECT_EQ(escape_markup("µ → 😀"), "µ → 😀");
  EXPECT_EQ(escape_markup("a\xC3"), "a\uFFFD") << "cut off";
  EXPECT_EQ(escape_markup("\xC0\xAF"), "\uFFFD\uFFFD") << "overlong /";
  EXPECT_EQ(escape_markup("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD") << "half of a surrogate pair";
  EXPECT_EQ(escape_markup(std::string("\0\x1B", 2)), "\uFFFD\uFFFD");
}

TEST(Page, EscapesAllTexts) {
  const std::string evil = "</script><b x='\"'>&";
  Page page{evil, evil, {}};
  page.blocks = {PageHeading{evil},
                 PageText{evil},
                 PageCode{evil},
                 PageTable{{{evil, evil}}, {{{evil, 1, evil}}}, evil},
                 PageFigure{"<svg></svg>", evil, evil},
                 PagePictures{{{evil, {1}}}, 1, 1, evil},
                 PageMaps{{{evil, {1}}}, {1}, evil, evil, evil, evil}};
  const std::string html = to_html(page);
  EXPECT_EQ(html.find(evil), std::string::npos);
  EXPECT_EQ(html.find("<b x"), std::string::npos);
  EXPECT_EQ(count(html, "</script>"), 2U) << "its own two";
  // Title twice, subtitle, heading and its line in the contents, text, code; of the table name,
  // meaning, cell and the name it has there, note and caption twice; file name and caption; of
  // pictures two options, name twice, caption; of maps name twice, three values, caption.
  EXPECT_EQ(count(html, escape_markup(evil)), 7 + 7 + 2 + 5 + 6U);
}

TEST(Page, RefersToNothingOutside) {
  std::string html = to_html(sample_page());
  const std::regex name_space(R"(xmlns="http://www\.w3\.org/2000/svg")");
  html = std::regex_replace(html, name_space, "");
  for (const char* part : {"http://", "https://", "//cdn", "@import", "url("}) {
    EXPECT_EQ(html.find(part), std::string::npos) << part;
  }
  const std::regex reference(R"rx((?:src|href)="(?!#|data:))rx");
  EXPECT_FALSE(std::regex_search(html, reference));
}

TEST(Page, HoldsEachPictureOnce) {
  const Page page = sample_page();
  const std::string html = to_html(page);
  int pictures = 0;
  const auto check = [&](const PngBytes& png) {
    EXPECT_EQ(count(html, base64(png)), 1U);
    ++pictures;
  };
  for (const PageBlock& block : page.blocks) {
    if (const auto* viewer = std::get_if<PagePictures>(&block)) {
      for (const auto& picture : viewer->pictures) check(picture.png);
    } else if (const auto* maps = std::get_if<PageMaps>(&block)) {
      for (const auto& map : maps->maps) check(map.png);
      check(maps->scale);
    }
  }
  EXPECT_EQ(pictures, 7 + 6 + 1);
}

TEST(Page, CellsOfNumbersSayWhatTheyAreSortedBy) {
  PageTable table;
  table.columns = {{"name", "", false}, {"value", ""}};
  table.rows = {{{"a"}, {"1.5 k", 1500}}, {{"b"}, {"–", std::nan("")}}, {{"c"}, {"∞", HUGE_VAL}}};
  const std::string html = html_of(table);
  EXPECT_NE(html.find("<td data-label=\"name\">a</td>"
                      "<td class=\"number\" data-label=\"value\" data-number=\"1500\">1.5 k</td>"),
            std::string::npos);
  EXPECT_NE(html.find("data-number=\"NaN\""), std::string::npos);
  EXPECT_NE(html.find("data-number=\"Infinity\""), std::string::npos);
}

TEST(Page, RefusesRowsThatDoNotFitTheirColumns) {
  PageTable table;
  table.columns = {{"a", ""}, {"b", ""}};
  table.rows = {{{"1"}, {"2"}}, {{"3"}}};
  EXPECT_THROW(html_of(table), Error);
}

TEST(Page, HeadingsHaveAnchorsOfTheirOwn) {
  Page page{"t", "", {PageHeading{"Time & error"}, PageHeading{"Time, error"}, PageHeading{"µ"}}};
  const std::string html = to_html(page);
  for (const char* anchor : {"time-error", "time-error-2", "section"}) {
    EXPECT_EQ(count(html, "<section id=\"" + std::string(anchor) + "\">"), 1U);
    EXPECT_EQ(count(html, "<li><a href=\"#" + std::string(anchor) + "\">"), 1U);
  }
}

TEST(Page, FiguresThatFollowEachOtherStandSideBySide) {
  Page page{"t", "", {}};
  page.blocks = {PageFigure{"<svg></svg>", "a.svg"}, PageFigure{"<svg></svg>", "b.svg"},
                 PageText{"between"}, PageFigure{"<?xml version=\"1.0\"?>\n<svg></svg>", "c.svg"}};
  const std::string html = to_html(page);
  EXPECT_EQ(count(html, "<div class=\"figures\">"), 2U);
  EXPECT_EQ(html.find("<?xml"), std::string::npos);
  EXPECT_EQ(count(html, "download=\"b.svg\""), 1U);
}

TEST(Page, SurvivesEmptyBlocks) {
  Page page;
  page.blocks = {PageHeading{}, PageText{}, PageCode{},     PageTable{},
                 PageFigure{},  PageMaps{}, PagePictures{}, PageHeading{}};
  const std::string html = to_html(page);
  EXPECT_NE(html.find("</html>"), std::string::npos);
  EXPECT_EQ(count(html, "<section"), count(html, "</section>"));
}

TEST(Page, GivesTheSameBytesAgain) { EXPECT_EQ(to_html(sample_page()), to_html(sample_page())); }

}  // namespace
}  // namespace freepath
