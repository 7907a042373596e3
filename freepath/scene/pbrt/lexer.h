#pragma once
/// @file Scene text as tokens.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "freepath/scene/pbrt/source_location.h"

namespace freepath {

enum class TokenKind { kEnd, kWord, kString, kNumber, kOpenBracket, kCloseBracket };

/// A token of a scene file.
struct Token {
  TokenKind kind = TokenKind::kEnd;
  std::string text;         ///< Text of a string, without quotes and with its escapes replaced.
  std::string_view source;  ///< Token as it stands in the file; a part of the lexer's text.
  double number = 0;        ///< Value of a number; finite, and in the range of single precision.
  bool is_whole = false;    ///< Whether a number is written as an integer, with digits alone.
  int line = 1, column = 1;
  int file = 0;  ///< Number of the file that it stands in, the lexer's.
};

/// What a message calls a token: "number 1.5", "'Shape'", "end of file".
std::string describe(const Token& token);

/// Cuts the text of a file into tokens. White space separates; '#' begins a comment that ends with
/// its line; a string stands in double quotes on one line, with the escapes \" \' \\ \n \r \t \b
/// \f.
class Lexer {
 public:
  /// @param file name of the file, for messages
  /// @param number Token::file
  Lexer(std::shared_ptr<const std::string> file, std::string text, int number = 0);
  Lexer(const std::string& file, std::string text)
      : Lexer(std::make_shared<const std::string>(file), std::move(text)) {}
  Lexer(const Lexer&) = delete;
  Lexer& operator=(const Lexer&) = delete;

  /// The next token, which stays the next.
  /// @throws Error as next
  const Token& peek();
  /// The next token; at the end of the text again and again a token kEnd.
  /// @throws Error, beginning "file:line:column: ", for a string that is not closed or has an
  ///   unknown escape, a number that is malformed, not finite or out of the range of single
  ///   precision, and characters that begin no token
  Token next();

  SourceLocation location(const Token& token) const { return {file_, token.line, token.column}; }
  const std::string& file() const { return *file_; }

 private:
  Token read();
  void skip_blanks();
  void advance(std::size_t count);
  void read_string(Token& token);
  void read_word(Token& token);
  void read_number(Token& token) const;

  std::shared_ptr<const std::string> file_;
  std::string text_;
  std::string_view rest_;
  int number_;
  int line_ = 1, column_ = 1;
  Token ahead_;
  bool has_ahead_ = false;
};

}  // namespace freepath
