#include "freepath/report/markup.h"

#include <cstddef>

#include "freepath/base/printable.h"

namespace freepath {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Number of bytes of the character that starts here, which is not ASCII; 0 where there is none
/// that is well-formed and allowed in XML.
std::size_t character_length(std::string_view text) {
  const CodePoint point = front_code_point(text);
  const bool is_control = point.value < 0xA0;  // C1, allowed in XML but never meant
  const bool is_no_character = point.value == 0xFFFE || point.value == 0xFFFF;
  return is_control || is_no_character ? 0 : point.bytes;
}

/// What stands for an ASCII character; nothing where it stands for itself.
std::string_view escaped(char character) {
  switch (character) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    case '\t':
    case '\n':
    case '\r':
      return {};
    default:
      return static_cast<unsigned char>(character) < 0x20 || character == 0x7F ? kReplacement
                                                                               : std::string_view{};
  }
}

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    std::size_t length = 1;
    if (static_cast<unsigned char>(text[0]) < 0x80) {
      const std::string_view replaced = escaped(text[0]);
      result += replaced.empty() ? text.substr(0, 1) : replaced;
    } else {
      length = character_length(text);
      result += length == 0 ? kReplacement : text.substr(0, length);
      if (length == 0) length = 1;
    }
    text.remove_prefix(length);
  }
  return result;
}

std::string base64(std::span<const uint8_t> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  result.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
    uint32_t group = 0;  // 24 bits: four digits of six
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      result += k <= count ? kDigits[group >> (18 - 6 * k) & 0x3F] : '=';
    }
  }
  return result;
}

}  // namespace freepath
