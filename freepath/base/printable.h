#pragma once
/// @file Names from outside, made fit for being shown.

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace freepath {

/// A character at the front of a text.
struct CodePoint {
  std::size_t bytes = 0;  ///< 0: the text does not begin with a character of UTF-8.
  char32_t value = 0;
};

/// Reads the character at the front of a text in UTF-8, as Unicode 15.0, table 3-7, has it.
/// @param text not empty
inline CodePoint front_code_point(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t first = byte(0);
  if (first < 0x80) return {1, first};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return {};
  char32_t value = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {};
    value = value << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < kSmallest[bytes] || value > 0x10FFFF || surrogate) return {};
  return {bytes, value};
}

/// Whether a character moves, hides or turns around what is shown beside it.
constexpr bool is_control(char32_t c) {
  return c < 0x20 || (c >= 0x7F && c <= 0x9F) || c == 0x2028 || c == 0x2029 || c == 0xFEFF ||
         (c >= 0x200B && c <= 0x200F) || (c >= 0x202A && c <= 0x202E) ||
         (c >= 0x2060 && c <= 0x2069);
}

/// The text in UTF-8 without control characters: those, and bytes that are no UTF-8, stand in it as
/// \n, \t, \u{202e} or \xe9. A terminal shows it and obeys nothing in it.
/// @param kept a control character that stays, such as a line break; 0: none
inline std::string printable(std::string_view text, char kept = 0) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const CodePoint c = front_code_point(text);
    const std::size_t bytes = c.bytes == 0 ? 1 : c.bytes;
    const char front = text.front();
    if (c.bytes > 0 && (!is_control(c.value) || (kept != 0 && front == kept))) {
      shown += text.substr(0, bytes);
    } else if (front == '\n' || front == '\t' || front == '\r') {
      shown += front == '\n' ? "\\n" : front == '\t' ? "\\t" : "\\r";
    } else if (bytes == 1) {
      shown += fmt::format("\\x{:02x}", static_cast<uint8_t>(front));
    } else {
      shown += fmt::format("\\u{{{:x}}}", static_cast<uint32_t>(c.value));
    }
    text.remove_prefix(bytes);
  }
  return shown;
}

/// The begin of a text from a file, for a message, as printable() shows it: what is longer ends in
/// "...".
inline std::string excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 120;
  if (text.size() <= kLongest) return printable(text);
  return printable(text.substr(0, kLongest)) + "...";
}

}  // namespace freepath
