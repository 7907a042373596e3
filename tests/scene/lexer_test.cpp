#include "freepath/scene/pbrt/lexer.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "freepath/scene/pbrt/diagnostics.h"
#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath::testing {
namespace {

std::vector<Token> tokens_of(const std::string& text) {
  // Token::source points into a lexer, which is gone when the tokens are looked at.
  Lexer lexer("text", text);
  std::vector<Token> tokens;
  while (lexer.peek().kind != TokenKind::kEnd) tokens.push_back(lexer.next());
  return tokens;
}

std::string lexer_error(const std::string& text) {
  try {
    tokens_of(text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Lexer, TellsKindsApart) {
  const std::vector<Token> tokens = tokens_of("Shape\"sphere\"[1 -2]#comment [ \" \n true");
  ASSERT_EQ(tokens.size(), 7U);
  const TokenKind kinds[] = {TokenKind::kWord,   TokenKind::kString, TokenKind::kOpenBracket,
                             TokenKind::kNumber, TokenKind::kNumber, TokenKind::kCloseBracket,
                             TokenKind::kWord};
  for (std::size_t i = 0; i < tokens.size(); ++i) EXPECT_EQ(tokens[i].kind, kinds[i]) << i;
  EXPECT_EQ(tokens[1].text, "sphere");
}

TEST(Lexer, CountsLinesAndCharacters) {
  const std::vector<Token> tokens = tokens_of("a # \xc3\xa9\r\n\t\"\xc3\xa9\xc3\xa9\" b\n\n  [");
  ASSERT_EQ(tokens.size(), 4U);
  const std::pair<int, int> locations[] = {{1, 1}, {2, 2}, {2, 7}, {4, 3}};
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    EXPECT_EQ(std::pair(tokens[i].line, tokens[i].column), locations[i]) << i;
  }
}

TEST(Lexer, ReadsNumbers) {
  const std::pair<const char*, double> numbers[] = {
      {"0", 0},           {"-0", 0},     {"+7", 7},          {"1.", 1},
      {".5", 0.5},        {"-.5", -0.5}, {"1e3", 1000},      {"1E+3", 1000},
      {"2.5e-3", 0.0025}, {"007", 7},    {"3.4e38", 3.4e38}, {"-3.4e38", -3.4e38},
      {"1e-300", 1e-300}};
  for (const auto& [text, value] : numbers) {
    const std::vector<Token> tokens = tokens_of(text);
    ASSERT_EQ(tokens.size(), 1U) << text;
    EXPECT_EQ(tokens[0].kind, TokenKind::kNumber) << text;
    EXPECT_EQ(tokens[0].number, value) << text;
  }
  for (const char* whole : {"1", "-1", "+1", "2147483648"}) {
    EXPECT_TRUE(tokens_of(whole)[0].is_whole) << whole;
  }
  for (const char* part : {"1.", "1e0", "1.0", "-.5"}) {
    EXPECT_FALSE(tokens_of(part)[0].is_whole) << part;
  }
}

TEST(Lexer, RefusesWhatIsNoNumber) {
  for (const char* text : {"1x", "--1", "+-1", "1e", "1.2.3", "0x10", "-", ".", "1,5", "1e5e5"}) {
    EXPECT_EQ(lexer_error(text), std::string("text:1:1: '") + text + "' is not a number");
  }
  for (const char* text : {"nan", "NaN", "inf", "-inf", "+Infinity", "-nan"}) {
    EXPECT_EQ(lexer_error(text), std::string("text:1:1: '") + text + "' is not a finite number");
  }
  for (const char* text : {"1e39", "-1e39", "1e999", "1e-999", "3.5e38"}) {
    EXPECT_NE(lexer_error(text).find("out of range"), std::string::npos) << text;
  }
}

TEST(Lexer, ReplacesEscapes) {
  EXPECT_EQ(tokens_of(R"("a\"b\\c\n\t\r\b\f\'")")[0].text, "a\"b\\c\n\t\r\b\f'");
  EXPECT_EQ(tokens_of(R"("")")[0].text, "");
  EXPECT_EQ(tokens_of(R"("# no comment")")[0].text, "# no comment");
  EXPECT_NE(lexer_error(R"(x "ab\q")").find(R"(text:1:6: unknown escape '\q')"), std::string::npos);
  EXPECT_NE(lexer_error(R"("ab\)").find("text:1:1: this string is not closed"), std::string::npos);
  EXPECT_NE(lexer_error("x\n \"ab\n\"").find("text:2:2: this string is not closed"),
            std::string::npos);
}

TEST(Lexer, StaysAtTheEnd) {
  Lexer lexer("text", "  # nothing");
  EXPECT_EQ(lexer.next().kind, TokenKind::kEnd);
  EXPECT_EQ(lexer.next().kind, TokenKind::kEnd);
}

TEST(EditDistance, CountsChangesAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("radius", "radius"), 0U);
  EXPECT_EQ(edit_distance("raduis", "radius"), 1U);  // a swap
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("Camera", "camera"), 1U);
}

TEST(EditDistance, FindsTheNearestNameIfAnyIsNear) {
  const std::string_view names[] = {"sphere", "disk", "trianglemesh"};
  EXPECT_EQ(nearest_name("shpere", names), "sphere");
  EXPECT_EQ(nearest_name("bilinearmesh", names), "");
  EXPECT_EQ(did_you_mean("dsk", names), "; did you mean 'disk'?");
  EXPECT_EQ(nearest_name("", names), "");
}

TEST(Messages, AreOneLineThatCanBePrinted) {
  EXPECT_EQ(in_quotes("a\nb\x01\xff"), R"('a\x0ab\x01\xff')");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(60, 'x') + "...'");
}

TEST(Diagnostics, SayTheSameOnce) {
  Diagnostics diagnostics;
  const auto file = std::make_shared<const std::string>("a.pbrt");
  diagnostics.warn({file, 1, 2}, "one");
  diagnostics.warn({file, 3, 4}, "two");
  diagnostics.warn({file, 5, 6}, "one");
  const std::vector<std::string> expected = {"a.pbrt:1:2: one (and 1 more like this)",
                                             "a.pbrt:3:4: two"};
  EXPECT_EQ(diagnostics.warnings(), expected);
}

}  // namespace
}  // namespace freepath::testing
