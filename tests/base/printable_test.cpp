#include "freepath/base/printable.h"

#include <gtest/gtest.h>

namespace freepath {
namespace {

TEST(Printable, TextStaysAndControlCharactersAreNamed) {
  EXPECT_EQ(printable(""), "");
  EXPECT_EQ(printable("cloud 7 \"A\" \\n"), "cloud 7 \"A\" \\n");
  EXPECT_EQ(printable("nuée 雲 ☁ 𝛔"), "nuée 雲 ☁ 𝛔");
  EXPECT_EQ(printable("a\nb\tc\r"), "a\\nb\\tc\\r");
  EXPECT_EQ(printable("a\nb\033", '\n'), "a\nb\\x1b");
  EXPECT_EQ(printable("\033[2J\a\x7f"), "\\x1b[2J\\x07\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  // An 8-bit control sequence introducer, text that runs from right to left, and nothing at all.
  EXPECT_EQ(printable("\xC2\x9b"
                      "31m"),
            "\\u{9b}31m");
  EXPECT_EQ(printable("\xE2\x80\xAE"
                      "bdv"),
            "\\u{202e}bdv");
  EXPECT_EQ(printable("\xEF\xBB\xBF\xE2\x80\x8B"), "\\u{feff}\\u{200b}");
}

TEST(Printable, BytesThatAreNoCharacterAreNamed) {
  EXPECT_EQ(printable("caf\xe9.vdb"), "caf\\xe9.vdb");
  EXPECT_EQ(printable("\xC3"), "\\xc3");
  EXPECT_EQ(printable("\x80\xBF\xFE\xFF"), "\\x80\\xbf\\xfe\\xff");
  EXPECT_EQ(printable("\xC0\xAF"), "\\xc0\\xaf");                          // "/" in two bytes
  EXPECT_EQ(printable("\xE0\x80\xAF"), "\\xe0\\x80\\xaf");                 // in three
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");                 // half of a pair
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");        // beyond the last
  EXPECT_EQ(printable("\xE9\x9B\xB2\xE9\x9B"), "\xE9\x9B\xB2\\xe9\\x9b");  // cut short
}

}  // namespace
}  // namespace freepath
