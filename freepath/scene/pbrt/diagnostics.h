#pragma once
/// @file What there is to say about a scene that is no error.

#include <cstddef>
#include <string>
#include <vector>

#include "freepath/scene/pbrt/source_location.h"

namespace freepath {

/// Collects warnings and says each once: the same text at other places only adds to a count.
class Diagnostics {
 public:
  void warn(const SourceLocation& location, const std::string& text);

  /// Warnings in the order in which they came up: "file:line:column: text", with "(and 3 more like
  /// this)" where the text came up again at other places.
  std::vector<std::string> warnings() const;

 private:
  struct Warning {
    SourceLocation location;
    std::string text;
    std::size_t repeats = 0;
  };
  std::vector<Warning> warnings_;
};

}  // namespace freepath
