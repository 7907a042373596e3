#include "freepath/scene/pbrt/source_location.h"

#include <cstddef>

namespace freepath {
namespace {

bool is_printable(unsigned char byte) { return byte >= 0x20 && byte < 0x7f; }

std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (is_printable(byte)) {
      result += c;
    } else {
      result += fmt::format("\\x{:02x}", byte);
    }
  }
  return result;
}

}  // namespace

std::string to_string(const SourceLocation& location) {
  // Names of files may be in any script, but a message is one line.
  std::string file = location.file ? *location.file : std::string("scene");
  for (char& c : file) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return fmt::format("{}:{}:{}", file, location.line, location.column);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  const bool is_long = text.size() > kLongest;
  return fmt::format("'{}{}'", printable(text.substr(0, kLongest)), is_long ? "..." : "");
}

}  // namespace freepath
