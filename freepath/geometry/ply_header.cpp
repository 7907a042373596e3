#include "freepath/geometry/ply_header.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "freepath/base/error.h"

namespace freepath {

namespace {

/// The words of a line.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t offset = 0;
  for (;;) {
    offset = line.find_first_not_of(" \t\r", offset);
    if (offset == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t\r", offset), line.size());
    words.push_back(line.substr(offset, end - offset));
    offset = end;
  }
}

std::optional<PlyType> type_named(std::string_view name) {
  struct Name {
    std::string_view old_name, new_name;
    PlyType type;
  };
  static constexpr Name kNames[] = {
      {"char", "int8", PlyType::kInt8},        {"uchar", "uint8", PlyType::kUint8},
      {"short", "int16", PlyType::kInt16},     {"ushort", "uint16", PlyType::kUint16},
      {"int", "int32", PlyType::kInt32},       {"uint", "uint32", PlyType::kUint32},
      {"float", "float32", PlyType::kFloat32}, {"double", "float64", PlyType::kFloat64}};
  for (const Name& known : kNames) {
    if (name == known.old_name || name == known.new_name) return known.type;
  }
  return std::nullopt;
}

/// Reads one line after the other.
class HeaderParser {
 public:
  HeaderParser(std::string_view content, const std::string& name)
      : content_(content), name_(name) {}

  PlyHeader parse() {
    if (!content_.starts_with("ply") || next_line() != "ply") {
      fail(
          "{}: this is no PLY file: it does not begin with 'ply'. Is it compressed, and not by "
          "gzip? "
          "Then unpack it",
          name_);
    }
    bool has_format = false;
    for (;;) {
      const std::vector<std::string_view> words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        parse_format(words);
        has_format = true;
      } else if (words[0] == "element") {
        parse_element(words);
      } else if (words[0] == "property") {
        parse_property(words);
      } else {
        bad(fmt::format("'{}' is none of format, element, property and comment", words[0]));
      }
    }
    if (!has_format) bad("the header ends without a format");
    header_.size = offset_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void bad(const std::string& what) const {
    fail("{}:{}: {}; write the file anew", name_, header_.lines, what);
  }

  std::string_view next_line() {
    const std::size_t end = content_.find('\n', offset_);
    ++header_.lines;
    if (end == std::string_view::npos) bad("the header does not end: there is no 'end_header'");
    std::string_view line = content_.substr(offset_, end - offset_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    offset_ = end + 1;
    return line;
  }

  void parse_format(const std::vector<std::string_view>& words) {
    const std::string_view format = words.size() > 1 ? words[1] : std::string_view();
    if (format == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (format == "binary_little_endian") {
      header_.format = PlyFormat::kLittleEndian;
    } else if (format == "binary_big_endian") {
      header_.format = PlyFormat::kBigEndian;
    } else {
      bad(
          fmt::format("the format '{}' is none of ascii, binary_little_endian and "
                      "binary_big_endian",
                      format));
    }
  }

  void parse_element(const std::vector<std::string_view>& words) {
    PlyElement element;
    if (words.size() < 3) bad("an element needs a name and a count");
    element.name = words[1];
    const char* const end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc() || stop != end) {
      bad(fmt::format("the count '{}' of '{}' is no number", words[2], words[1]));
    }
    header_.elements.push_back(std::move(element));
  }

  void parse_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) bad("a property before any element");
    PlyProperty property;
    property.is_list = words.size() > 1 && words[1] == "list";
    if (words.size() < (property.is_list ? 5U : 3U)) bad("a property needs a type and a name");
    if (property.is_list) property.count_type = parse_type(words[2]);
    property.type = parse_type(words[property.is_list ? 3 : 1]);
    property.name = words[property.is_list ? 4 : 2];
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType parse_type(std::string_view word) const {
    const std::optional<PlyType> type = type_named(word);
    if (!type) bad(fmt::format("the type '{}' is unknown", word));
    return *type;
  }

  std::string_view content_;
  const std::string& name_;
  std::size_t offset_ = 0;
  PlyHeader header_;
};

}  // namespace

PlyHeader parse_ply_header(std::string_view content, const std::string& name) {
  return HeaderParser(content, name).parse();
}

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

}  // namespace freepath
