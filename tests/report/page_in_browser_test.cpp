// What a browser makes of a page. Skipped where there is no Chromium.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "freepath/report/chart_colors.h"
#include "freepath/report/page.h"
#include "tests/report/browser.h"
#include "tests/report/sample_page.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;
using testing::Browser;
using testing::Screenshot;

constexpr const char* kLightPaper = "#f7f7f5";
constexpr const char* kDarkPaper = "#0f1114";
constexpr const char* kPrefersLight = "--blink-settings=preferredColorScheme=1";
constexpr const char* kPrefersDark = "--blink-settings=preferredColorScheme=0";

class PageInBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto program = Browser::find();
    if (!program) GTEST_SKIP() << "no chromium, chromium-browser or google-chrome in the path";
    std::string pattern = fs::path(::testing::TempDir()) / "freepath_browser_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    browser_ = std::make_unique<Browser>(*program, folder_);
    html_ = to_html(testing::sample_page());
  }
  void TearDown() override {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }

  std::string write(const std::string& name, const std::string& text) const {
    const fs::path file = folder_ / name;
    std::ofstream(file) << text;
    return file;
  }
  std::string page() const { return write("page.html", html_); }

  /// What a script's function `probe` returns after the page's own scripts ran.
  std::string probe(const std::string& html, const std::string& script) const {
    const std::string file =
        write("probe.html",
              html + "<script>(async () => {'use strict'; const probe = async () => {" + script +
                  "}; document.documentElement.dataset.probe = String(await probe());"
                  "})();</script>");
    const std::string document = browser_->document(file);
    const std::regex attribute("data-probe=\"([^\"]*)\"");
    std::smatch match;
    return std::regex_search(document, match, attribute) ? match[1].str() : "no answer";
  }
  std::string probe(const std::string& script) const { return probe(html_, script); }

  fs::path folder_;
  std::unique_ptr<Browser> browser_;
  std::string html_;
};

TEST_F(PageInBrowser, RunsWithoutErrors) {
  const std::string document = browser_->document(page());
  EXPECT_NE(document.find("data-ready=\"yes\""), std::string::npos);
  EXPECT_NE(document.find("data-errors=\"0\""), std::string::npos);
}

TEST_F(PageInBrowser, CountsErrors) {
  const std::string document =
      browser_->document(write("broken.html", html_ + "<script>missing();</script>"));
  EXPECT_NE(document.find("data-errors=\"1\""), std::string::npos);
}

/// Colours of the page and of its charts' first series.
void expect_scheme(const Screenshot& shot, bool is_dark) {
  const auto& palette = is_dark ? kDarkPalette : kLightPalette;
  const auto& other = is_dark ? kLightPalette : kDarkPalette;
  const std::size_t all = static_cast<std::size_t>(shot.width) * shot.height;
  EXPECT_GT(shot.count_near(is_dark ? kDarkPaper : kLightPaper), all / 10);
  EXPECT_EQ(shot.count_near(is_dark ? kLightPaper : kDarkPaper, 0), 0U);
  for (int i = 0; i < 6; ++i) {
    EXPECT_GT(shot.count_near(std::string(palette[i])), 100U) << palette[i];
  }
  for (int i = 1; i < 3; ++i) {
    EXPECT_LT(shot.count_near(std::string(other[i])), 20U) << other[i];
  }
  EXPECT_GT(shot.colour_count(), 200U);
}

TEST_F(PageInBrowser, FollowsTheReadersPreference) {
  const Screenshot light = browser_->screenshot(page(), 1280, 1700, kPrefersLight);
  const Screenshot dark = browser_->screenshot(page(), 1280, 1700, kPrefersDark);
  EXPECT_EQ(light.width, 1280);
  EXPECT_EQ(light.height, 1700);
  EXPECT_EQ(dark.width, 1280);
  EXPECT_EQ(dark.height, 1700);
  expect_scheme(light, false);
  expect_scheme(dark, true);
}

TEST_F(PageInBrowser, ThemeOutweighsThePreferenceInChartsToo) {
  expect_scheme(browser_->screenshot(page() + "?theme=light", 1280, 1700, kPrefersDark), false);
  expect_scheme(browser_->screenshot(page() + "?theme=dark", 1280, 1700, kPrefersLight), true);
}

TEST_F(PageInBrowser, ThemeButtonGoesRoundAndIsRemembered) {
  EXPECT_EQ(probe(R"js(
    const button = document.querySelector('.theme');
    const seen = [];
    for (let i = 0; i < 3; ++i) {
      button.click();
      seen.push(document.documentElement.dataset.theme + '/' + button.innerText.trim() + '/' +
                localStorage.getItem('freepath-theme'));
    }
    return seen.join(' ');
  )js"),
            "light/Light/light dark/Dark/dark undefined/Auto/auto");
}

TEST_F(PageInBrowser, DrawingAloneFollowsThePreference) {
  const std::string file = write("chart.svg", to_svg(testing::sample_chart()));
  const Screenshot light = browser_->screenshot(file, 640, 420, kPrefersLight);
  const Screenshot dark = browser_->screenshot(file, 640, 420, kPrefersDark);
  EXPECT_EQ(light.at(3, 3), 0xFFFFFFU);
  EXPECT_EQ(dark.at(3, 3), 0x15181CU);
  for (int i = 0; i < 6; ++i) {
    EXPECT_GT(light.count_near(std::string(kLightPalette[i])), 100U) << i;
    EXPECT_GT(dark.count_near(std::string(kDarkPalette[i])), 100U) << i;
  }
}

TEST_F(PageInBrowser, AClickOnAColumnSortsByIt) {
  // Errors, ascending: 0.142, 0.21, 0.34, 0.42, 0.63, 0.97. Time to 1 %: "regular" has none.
  const std::string sorted = probe(R"js(
    const table = document.querySelector('table');
    const heads = [...table.tHead.rows[0].cells];
    const names = () => [...table.tBodies[0].rows].map(
        row => row.cells[0].textContent[0] + row.cells[0].textContent.length).join();
    const click = name => {
      const head = heads.find(cell => cell.innerText.trim() === name);
      head.querySelector('button').click();
      return names() + ':' + head.getAttribute('aria-sort');
    };
    return [names(), click('error'), click('error'), click('error'), click('time to 1 %'),
            click('time to 1 %'), click('tracker')].join(' ');
  )js");
  EXPECT_EQ(sorted,
            "d5,w14,d13,r14,s12,r7 "
            "d13,r14,s12,d5,w14,r7:ascending "
            "r7,w14,d5,s12,r14,d13:descending "
            "d5,w14,d13,r14,s12,r7:null "
            "d13,r14,s12,d5,w14,r7:ascending "
            "w14,d5,s12,r14,d13,r7:descending "
            "d13,d5,r7,r14,s12,w14:ascending");
}

TEST_F(PageInBrowser, ViewerMovesItsSeamAndChoosesPictures) {
  EXPECT_EQ(probe(R"js(
    const viewer = document.querySelector('.viewer');
    const get = selector => viewer.querySelector(selector);
    const stage = get('.stage');
    const seen = [];
    const tags = () => get('.left .tag').textContent + '|' + get('.right .tag').textContent;
    seen.push(stage.style.getPropertyValue('--seam'), tags());
    const seam = get('.seam');
    seam.value = 25;
    seam.dispatchEvent(new Event('input'));
    seen.push(stage.style.getPropertyValue('--seam'));
    const handle = get('.handle').getBoundingClientRect();
    const box = stage.getBoundingClientRect();
    seen.push(((handle.left + handle.width / 2 - box.left) / box.width).toFixed(2));
    const right = get('.choose-right');
    right.value = 'decomposition';
    right.dispatchEvent(new Event('change'));
    const source = [...viewer.querySelectorAll('.picture-grid img')]
        .find(image => image.alt === 'decomposition');
    seen.push(tags(), get('.layer.right img').src === source.src);
    get('.swap').click();
    seen.push(tags());
    return seen.join(' ');
  )js"),
            "50% reference|delta 25% 0.25 reference|decomposition true decomposition|reference");
}

TEST_F(PageInBrowser, ViewerZoomsAboutThePointerAndMoves) {
  EXPECT_EQ(probe(R"js(
    const viewer = document.querySelector('.viewer');
    const get = selector => viewer.querySelector(selector);
    const stage = get('.stage');
    const image = get('.layer.left img');
    const box = stage.getBoundingClientRect();
    const at = (x, y) => ({clientX: box.left + x * box.width, clientY: box.top + y * box.height});
    // Where the picture's point at (0.25, 0.75) is on the stage.
    const place = () => {
      const shown = image.getBoundingClientRect();
      return ((shown.left + 0.25 * shown.width - box.left) / box.width).toFixed(2) + ',' +
             ((shown.top + 0.75 * shown.height - box.top) / box.height).toFixed(2);
    };
    const zoomed = () => image.getBoundingClientRect().width > box.width * 1.01;
    const seen = [place()];
    for (let i = 0; i < 5; ++i) {
      stage.dispatchEvent(new WheelEvent('wheel', {...at(0.25, 0.75), deltaY: -100,
                                                   cancelable: true}));
    }
    seen.push(zoomed(), place(), getComputedStyle(image).imageRendering);
    stage.setPointerCapture = () => {};  // there is no pointer to capture
    const pointer = (type, x, y) => stage.dispatchEvent(
        new PointerEvent(type, {...at(x, y), pointerId: 1, button: 0}));
    pointer('pointerdown', 0.5, 0.5);
    pointer('pointermove', 0.6, 0.4);
    pointer('pointerup', 0.6, 0.4);
    pointer('pointermove', 0.9, 0.9);
    seen.push(place());
    stage.dispatchEvent(new MouseEvent('dblclick'));
    seen.push(zoomed(), place());
    get('.zoom-in').click();
    seen.push(zoomed());
    get('.zoom-reset').click();
    pointer('pointerdown', 0.5, 0.5);
    pointer('pointermove', 0.75, 0.5);
    pointer('pointerup', 0.75, 0.5);
    seen.push(zoomed(), stage.style.getPropertyValue('--seam'));
    return seen.join(' ');
  )js"),
            "0.25,0.75 true 0.25,0.75 pixelated 0.35,0.65 false 0.25,0.75 true false 75%");
}

TEST_F(PageInBrowser, MapsAreEnlarged) {
  EXPECT_EQ(probe(R"js(
    const dialog = document.querySelector('.enlarged');
    document.querySelectorAll('.enlarge')[1].click();
    const seen = [dialog.open, dialog.innerText.trim()];
    dialog.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'}));
    seen.push(dialog.innerText.trim(), dialog.querySelector('img').clientWidth > 500);
    dialog.click();
    seen.push(dialog.open);
    return seen.join(' ');
  )js"),
            "true weighted_delta decomposition true false");
}

TEST_F(PageInBrowser, NothingIsHiddenBesideOrBelowWhateverTheWindow) {
  // A frame can be narrower than a browser's window; it reports what it measures: the width of the
  // page, what juts out, and what would have to be scrolled within the page to be seen.
  const std::string measure = html_ + R"js(<script>
    const wide = [...document.querySelectorAll('.card, h1, h2, p, .tools *, .code *, td')].filter(
        element => element.getBoundingClientRect().right > innerWidth);
    const cut = [...document.querySelectorAll('.scroll, .code pre')].filter(
        element => element.scrollWidth > element.clientWidth + 1 ||
                   element.scrollHeight > element.clientHeight + 1);
    parent.postMessage([innerWidth, document.documentElement.scrollWidth, wide.length,
                        cut.length].join(' '), '*');
  </script>)js";
  write("sized.html", measure);
  for (const int width : {390, 1280}) {
    const std::string script = fmt::format(R"js(
      const frame = document.createElement('iframe');
      Object.assign(frame, {{width: {}, height: 800, src: 'sized.html'}});
      const answer = new Promise(done => window.addEventListener('message', e => done(e.data)));
      document.body.append(frame);
      return answer;
    )js",
                                           width);
    const std::string seen = probe("<!DOCTYPE html><body></body>", script);
    // A bar for scrolling the page itself may take some of the width.
    int inner = 0;
    int page = 0;
    int wide = -1;
    int cut = -1;
    ASSERT_EQ(std::sscanf(seen.c_str(), "%d %d %d %d", &inner, &page, &wide, &cut), 4) << seen;
    EXPECT_EQ(inner, width);
    EXPECT_LE(page, inner);
    EXPECT_EQ(wide, 0) << width;
    EXPECT_EQ(cut, 0) << width;
  }
}

TEST_F(PageInBrowser, ShowsAllPicturesWithoutScripts) {
  std::string bare;
  std::size_t offset = 0;
  while (true) {
    const std::size_t begin = html_.find("<script>", offset);
    bare += html_.substr(offset, begin - offset);
    if (begin == std::string::npos) break;
    offset = html_.find("</script>", begin) + 9;
  }
  EXPECT_EQ(probe(bare, R"js(
    const shown = [...document.querySelectorAll('.picture-grid img, .maps img')].filter(
        image => image.naturalWidth > 0 && image.getBoundingClientRect().width > 50);
    const controls = [...document.querySelectorAll('.js-only')].filter(
        element => element.getClientRects().length > 0);
    return shown.length + ' ' + controls.length;
  )js"),
            "14 0");
}

TEST_F(PageInBrowser, PrintsSeveralPages) {
  const std::string pdf = browser_->print(page() + "?theme=dark");
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_GT(pdf.size(), 100000U) << "with the pictures";
  const std::regex pages("/Type\\s*/Page\\b(?!s)");
  const auto count = std::distance(std::sregex_iterator(pdf.begin(), pdf.end(), pages), {});
  EXPECT_GE(count, 3);
  EXPECT_LE(count, 8);
}

}  // namespace
}  // namespace freepath
