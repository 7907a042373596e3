#pragma once
/// @file Headers of volume files that are text: lines, words and numbers.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/io/volume_file.h"

namespace freepath::io {

/// The number that a whole word is, which may be infinite or NaN, with a + in front or not; nothing
/// if it is none.
std::optional<double> number_of(std::string_view word);

/// A text without the blanks at both ends.
std::string_view trimmed(std::string_view text);

/// A text in lower-case letters of ASCII.
std::string lower_case(std::string_view text);

/// Words of a text, between blanks, commas and further characters.
std::vector<std::string> split_words(std::string_view text, std::string_view further = {});

/// Reads lines and words of a file, with every length checked.
class TextCursor {
 public:
  TextCursor(const VolumeFile& file, uint64_t offset) : cursor_(file, offset) {}

  const VolumeFile& file() const { return cursor_.file(); }
  /// Place in the file of what is read next.
  uint64_t offset() const { return cursor_.offset(); }
  bool at_end() const { return offset() >= file().size(); }
  /// @throws Error if the file ends before
  void skip(uint64_t bytes) { cursor_.skip(bytes); }

  /// The line up to its end, which is taken and is no part of it; the last one need have none.
  /// @throws Error if it is longer than any header has them
  std::string line();
  /// The next word between blanks, of which one behind it is taken; empty at the end of the file.
  /// @throws Error as line()
  std::string word();

 private:
  char take() { return static_cast<char>(cursor_.take<uint8_t>()); }
  FileCursor cursor_;
};

/// The numbers of a field of a header.
/// @param what names the field in messages
/// @param count how many there must be
/// @throws Error that names file and field if there are not so many, or one isn't finite
std::vector<double> header_numbers(const VolumeFile& file, std::string_view what,
                                   std::string_view text, std::size_t count);

/// The fields of a header in text, by their names, and where it ends.
class HeaderFields {
 public:
  explicit HeaderFields(const VolumeFile& file) : file_(file) {}

  const VolumeFile& file() const { return file_; }
  /// Where the values begin that stand behind the header.
  uint64_t end() const { return end_; }
  /// The value of a field, under any of its names; nothing where it isn't given.
  std::optional<std::string> find(std::initializer_list<const char*> names) const;
  /// The text of an entry that has to be there. @throws Error that names the first of the names
  std::string get(std::initializer_list<const char*> names) const;

 protected:
  const VolumeFile& file_;
  std::map<std::string, std::string> fields_;
  uint64_t end_ = 0;
};

/// The file whose name a header has, in the header's folder unless it is absolute.
/// @throws Error if it isn't there
std::shared_ptr<const VolumeFile> beside(const VolumeFile& header, const std::string& name);

}  // namespace freepath::io
