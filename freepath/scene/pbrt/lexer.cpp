#include "freepath/scene/pbrt/lexer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace freepath {
namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool ends_word(char c) { return is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Whether this is how NaN and infinity are spelt, in any case and with any sign.
bool is_non_finite(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  std::string lower(word);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

/// The character that a backslash and `c` stand for, or 0.
char unescape(char c) {
  switch (c) {
    case 'n':
      return '\n';
    case 'r':
      return '\r';
    case 't':
      return '\t';
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case '\\':
    case '"':
    case '\'':
      return c;
    default:
      return 0;
  }
}

}  // namespace

std::string describe(const Token& token) {
  switch (token.kind) {
    case TokenKind::kEnd:
      return "the end of the file";
    case TokenKind::kString:
      return "string " + in_quotes(token.text);
    case TokenKind::kNumber:
      return "number " + in_quotes(token.source);
    default:
      return in_quotes(token.source);
  }
}

Lexer::Lexer(std::shared_ptr<const std::string> file, std::string text, int number)
    : file_(std::move(file)), text_(std::move(text)), rest_(text_), number_(number) {}

const Token& Lexer::peek() {
  if (!has_ahead_) {
    ahead_ = read();
    has_ahead_ = true;
  }
  return ahead_;
}

Token Lexer::next() {
  peek();
  has_ahead_ = false;
  return std::move(ahead_);
}

Token Lexer::read() {
  skip_blanks();
  Token token;
  token.file = number_;
  token.line = line_;
  token.column = column_;
  if (rest_.empty()) return token;
  if (rest_[0] == '[' || rest_[0] == ']') {
    token.kind = rest_[0] == '[' ? TokenKind::kOpenBracket : TokenKind::kCloseBracket;
    token.source = rest_.substr(0, 1);
  } else if (rest_[0] == '"') {
    read_string(token);
  } else {
    read_word(token);
  }
  advance(token.source.size());
  return token;
}

void Lexer::skip_blanks() {
  while (!rest_.empty()) {
    if (rest_[0] == '#') {
      advance(std::min(rest_.find('\n'), rest_.size()));
    } else if (is_blank(rest_[0])) {
      advance(1);
    } else {
      return;
    }
  }
}

void Lexer::advance(std::size_t count) {
  for (const char c : rest_.substr(0, count)) {
    if (c == '\n') {
      ++line_;
      column_ = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++column_;  // Not for the later bytes of a UTF-8 character.
    }
  }
  rest_.remove_prefix(count);
}

void Lexer::read_string(Token& token) {
  token.kind = TokenKind::kString;
  for (std::size_t i = 1; i < rest_.size() && rest_[i] != '\n'; ++i) {
    if (rest_[i] == '"') {
      token.source = rest_.substr(0, i + 1);
      return;
    }
    if (rest_[i] != '\\') {
      token.text += rest_[i];
      continue;
    }
    if (++i == rest_.size() || rest_[i] == '\n') break;
    const char escaped = unescape(rest_[i]);
    if (escaped == 0) {
      const std::string_view escape = rest_.substr(i - 1, 2);
      advance(i - 1);
      fail_at({file_, line_, column_}, "unknown escape {} in a string; write \\\\ for a backslash",
              in_quotes(escape));
    }
    token.text += escaped;
  }
  fail_at(location(token), "this string is not closed on its line");
}

void Lexer::read_word(Token& token) {
  const auto* const end = std::ranges::find_if(rest_, ends_word);
  token.source = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
  const char first = token.source[0];
  // No spelling of NaN or infinity ends with a digit, and most numbers do.
  if (!is_digit(token.source.back()) && is_non_finite(token.source)) {
    fail_at(location(token), "{} is not a finite number", in_quotes(token.source));
  }
  if (is_digit(first) || first == '+' || first == '-' || first == '.') {
    read_number(token);
    return;
  }
  token.kind = TokenKind::kWord;
  const auto is_name = [](char c) { return is_letter(c) || is_digit(c); };
  if (!std::ranges::all_of(token.source, is_name)) {
    fail_at(location(token), "expected a directive or a parameter, found {}",
            in_quotes(token.source));
  }
}

void Lexer::read_number(Token& token) const {
  token.kind = TokenKind::kNumber;
  std::string_view digits = token.source;
  if (digits[0] == '+') digits.remove_prefix(1);
  const bool twice_signed = digits.starts_with('-') && token.source[0] == '+';
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, token.number);
  if (twice_signed || stop != end || error == std::errc::invalid_argument) {
    fail_at(location(token), "{} is not a number", in_quotes(token.source));
  }
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (error == std::errc::result_out_of_range || std::abs(token.number) > kLargest) {
    fail_at(location(token), "number {} is out of range; the largest is {:.3g}",
            in_quotes(token.source), kLargest);
  }
  if (digits.starts_with('-')) digits.remove_prefix(1);
  token.is_whole = std::ranges::all_of(digits, is_digit);
}

}  // namespace freepath
