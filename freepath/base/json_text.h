#pragma once
/// @file JSON as text, whatever names are in it.

#include <nlohmann/json.hpp>
#include <string>

namespace freepath {

/// The JSON as UTF-8, without a line break at its end. Bytes of names that are no UTF-8 become
/// U+FFFD.
/// @param indent blanks of a level; -1: all in one line
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace freepath
