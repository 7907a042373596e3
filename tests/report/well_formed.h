#pragma once
/// @file Whether a text is well-formed XML, as far as drawings need it, and what it holds.

#include <cstddef>
#include <string>

namespace freepath::testing {

/// Nothing where every element is closed in order, attributes are quoted and unlike each other, and
/// references are known; else the first fault, with the text near it.
std::string xml_fault(const std::string& text);

/// How often a part stands in a text.
std::size_t count(const std::string& text, const std::string& part);

}  // namespace freepath::testing
