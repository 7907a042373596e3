#include "freepath/scene/pbrt/source_text.h"

#include <zlib.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <new>
#include <string_view>

#include "freepath/scene/pbrt/source_location.h"

namespace freepath {
namespace {

struct InflateEnd {
  void operator()(z_stream* stream) const {
    inflateEnd(stream);
    delete stream;
  }
};

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

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string unpack_gzip(std::string_view bytes, std::size_t limit) {
  constexpr int kGzipWindow = 15 + 16;  // The largest window; 16 asks for gzip's header.
  std::unique_ptr<z_stream, InflateEnd> stream(new z_stream{});
  if (inflateInit2(stream.get(), kGzipWindow) != Z_OK) throw std::bad_alloc();
  std::string text;
  std::string block(std::size_t{1} << 16, '\0');
  int status = Z_OK;
  while (!bytes.empty() || status != Z_STREAM_END) {
    if (status == Z_STREAM_END) {
      if (!is_gzip(bytes)) break;  // Padding after the last member, as tapes leave it.
      inflateReset(stream.get());
    }
    const std::size_t given =
        std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max() / 2);
    stream->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream->avail_in = static_cast<uInt>(given);
    stream->next_out = reinterpret_cast<Bytef*>(block.data());
    stream->avail_out = static_cast<uInt>(block.size());
    status = inflate(stream.get(), Z_NO_FLUSH);
    if (status == Z_BUF_ERROR) fail("its gzip stream ends too soon; is the file truncated?");
    if (status != Z_OK && status != Z_STREAM_END) fail("its gzip stream is damaged");
    bytes.remove_prefix(given - stream->avail_in);
    text.append(block, 0, block.size() - stream->avail_out);
    if (text.size() > limit) fail("it unpacks to more than the {} bytes that are read", limit);
  }
  return text;
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
