#pragma once
/// @file Scene files as text: read whole, unpacked, and told from what is no text.

#include <cstddef>
#include <string>

namespace freepath {

/// The bytes of a scene file, unpacked where they begin as a gzip file does. Such a file may have
/// several members.
/// @throws Error, without a place, if it is damaged or has more than `limit` bytes unpacked
std::string unpack(std::string bytes, std::size_t limit);

/// Unpacked bytes as text, without a byte order mark.
/// @param name of the file, for messages
/// @throws Error, beginning "file:line:column: ", for a byte that no text has: any control
/// character
///   but white space
std::string check_text(std::string bytes, const std::string& name);

}  // namespace freepath
