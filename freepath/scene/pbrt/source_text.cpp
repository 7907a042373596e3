#include "freepath/scene/pbrt/source_text.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>

#include "freepath/base/gzip.h"
#include "freepath/scene/pbrt/source_location.h"

namespace freepath {
namespace {

bool is_text(unsigned char byte) {
  return (byte >= 0x20 && byte != 0x7f) || (byte >= '\t' && byte <= '\r');
}

void refuse_binary(std::string_view text, const std::string& name) {
  const auto odd =
      std::ranges::find_if_not(text, [](char c) { return is_text(static_cast<unsigned char>(c)); });
  if (odd == text.end()) return;
  const auto line_start = std::find(std::make_reverse_iterator(odd), text.rend(), '\n').base();
  const SourceLocation location{std::make_shared<const std::string>(name),
                                static_cast<int>(1 + std::count(text.begin(), odd, '\n')),
                                static_cast<int>(1 + (odd - line_start))};
  fail_at(location, "byte 0x{:02x} is no text; is this a pbrt scene file?",
          static_cast<unsigned char>(*odd));
}

}  // namespace

std::string unpack(std::string bytes, std::size_t limit) {
  if (is_gzip(bytes)) return unpack_gzip(bytes, limit);
  return bytes;
}

std::string check_text(std::string bytes, const std::string& name) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (bytes.starts_with(kByteOrderMark)) bytes.erase(0, kByteOrderMark.size());
  refuse_binary(bytes, name);
  return bytes;
}

}  // namespace freepath
