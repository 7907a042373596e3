#pragma once
/// @file The tokens of a scene, whatever files they stand in.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "freepath/scene/pbrt/lexer.h"

namespace freepath {

/// Reads tokens of a file, and of files that it includes where it includes them: an included file
/// is text in the place of its Include, so that a statement may begin in one file and end in
/// another.
class TokenStream {
 public:
  /// Goes on with the text of a file; once that is at its end, with what comes after now.
  void open(const std::filesystem::path& path, std::string text);

  /// The next token, which stays the next; kEnd at the end of the text, or of a part.
  /// @throws Error as Lexer::next
  const Token& peek();
  Token next();

  /// Where a token stands, even if its file is at its end.
  SourceLocation location(const Token& token) const {
    return {names_[static_cast<std::size_t>(token.file)], token.line, token.column};
  }
  /// The file that a token stands in.
  const std::string& file_of(const Token& token) const {
    return *names_[static_cast<std::size_t>(token.file)];
  }

  /// Begins a part: the file that is opened next, with all that it includes. Its end is an end.
  /// @return what end_part() takes
  std::size_t begin_part();
  /// Ends a part that has been read to its end.
  void end_part(std::size_t outside);

  /// Whether a file is being read.
  bool is_open(const std::filesystem::path& path) const;
  /// How many files are being read.
  std::size_t depth() const { return files_.size(); }
  const std::filesystem::path& main_file() const { return files_.front().path; }

  /// Frees texts that have been read to their end. Token::source of all tokens read so far is void
  /// then.
  void free_finished() { finished_.clear(); }

 private:
  struct OpenFile {
    std::filesystem::path path;
    std::unique_ptr<Lexer> lexer;
  };
  void close();

  std::vector<OpenFile> files_;
  std::size_t part_ = 0;  ///< Number of the file that ends with an end.
  std::vector<std::unique_ptr<Lexer>> finished_;
  std::vector<std::shared_ptr<const std::string>> names_;
};

}  // namespace freepath
