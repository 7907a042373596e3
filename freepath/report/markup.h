#pragma once
/// @file Text and bytes as XML and HTML hold them.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace freepath {

/// Text for XML and HTML, within elements and quoted attributes: & < > " ' are escaped. Bytes that
/// are no UTF-8, and characters that XML has no place for, become U+FFFD.
std::string escape_markup(std::string_view text);

/// Base64 with padding [RFC 4648, section 4].
std::string base64(std::span<const uint8_t> bytes);

}  // namespace freepath
