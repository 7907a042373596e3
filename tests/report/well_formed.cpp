#include "tests/report/well_formed.h"

#include <array>
#include <regex>
#include <set>
#include <vector>

namespace freepath::testing {

namespace {

/// References that XML knows without being told, and numbers.
bool has_bad_reference(const std::string& text) {
  static const std::regex kReference("&(?!(amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);)");
  return std::regex_search(text, kReference);
}

/// The fault of what stands between a tag's name and its end.
std::string attributes_fault(std::string text) {
  static const std::regex kAttribute(R"rx(^\s+([A-Za-z_:][\w:.\-]*)="([^"<]*)")rx");
  std::set<std::string> names;
  std::smatch match;
  while (std::regex_search(text, match, kAttribute)) {
    if (!names.insert(match[1]).second) return "attribute twice: " + match[1].str();
    if (has_bad_reference(match[2])) return "unknown reference in " + match[0].str();
    text = match.suffix();
  }
  return text.find_first_not_of(" \n\t") == std::string::npos ? "" : "not an attribute: " + text;
}

}  // namespace

std::string xml_fault(const std::string& text) {
  static const std::regex kName("^[A-Za-z_:][\\w:.\\-]*");
  std::vector<std::string> open;
  std::size_t offset = 0;
  bool had_root = false;
  while (offset < text.size()) {
    const std::size_t begin = text.find('<', offset);
    const std::string between = text.substr(offset, begin - offset);
    if (has_bad_reference(between)) return "unknown reference in: " + between;
    if (open.empty() && between.find_first_not_of(" \n\t") != std::string::npos) {
      return "text outside of the root: " + between;
    }
    if (begin == std::string::npos) break;
    const std::size_t end = text.find('>', begin);
    if (end == std::string::npos) return "no end of " + text.substr(begin, 40);
    std::string tag = text.substr(begin + 1, end - begin - 1);
    offset = end + 1;
    if (!tag.empty() && tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "closes what is not open: " + tag;
      open.pop_back();
      continue;
    }
    const bool is_closed = !tag.empty() && tag.back() == '/';
    if (is_closed) tag.pop_back();
    std::smatch name;
    if (!std::regex_search(tag, name, kName)) return "no name: " + tag;
    if (open.empty() && had_root) return "a second root: " + tag;
    std::string fault = attributes_fault(name.suffix());
    if (!fault.empty()) return fault;
    had_root = true;
    if (!is_closed) open.push_back(name.str());
  }
  return open.empty() ? (had_root ? "" : "no element") : "not closed: " + open.back();
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

}  // namespace freepath::testing
