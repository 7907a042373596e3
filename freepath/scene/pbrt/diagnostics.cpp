#include "freepath/scene/pbrt/diagnostics.h"

#include <algorithm>

namespace freepath {

void Diagnostics::warn(const SourceLocation& location, const std::string& text) {
  const auto known = std::ranges::find(warnings_, text, &Warning::text);
  if (known == warnings_.end()) {
    warnings_.push_back({location, text});
  } else {
    ++known->repeats;
  }
}

std::vector<std::string> Diagnostics::warnings() const {
  std::vector<std::string> lines;
  for (const Warning& warning : warnings_) {
    std::string line = to_string(warning.location) + ": " + warning.text;
    if (warning.repeats > 0) line += fmt::format(" (and {} more like this)", warning.repeats);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace freepath
