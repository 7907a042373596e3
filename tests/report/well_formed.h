#pragma once
/// @file Whether a text is well-formed XML, as far as drawings need it.

#include <string>

namespace freepath::testing {

/// Nothing where every element is closed in order, attributes are quoted and unlike each other, and
/// references are known; else the first fault, with the text near it.
std::string xml_fault(const std::string& text);

}  // namespace freepath::testing
