#include "freepath/base/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

#include "freepath/base/error.h"

namespace freepath {

struct GzipReader::State {
  std::string_view packed;  ///< What is left of it.
  z_stream stream{};
  int status = Z_OK;
  std::string block = std::string(std::size_t{1} << 16, '\0');
};

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

GzipReader::GzipReader(std::string_view packed) : state_(std::make_unique<State>()) {
  constexpr int kGzipWindow = 15 + 32;  // The largest window; 32 takes gzip's header or zlib's.
  state_->packed = packed;
  if (inflateInit2(&state_->stream, kGzipWindow) != Z_OK) throw std::bad_alloc();
}

GzipReader::~GzipReader() { inflateEnd(&state_->stream); }

bool GzipReader::append_to(std::string& text) {
  std::string_view& packed = state_->packed;
  z_stream& stream = state_->stream;
  std::string& block = state_->block;
  if (state_->status == Z_STREAM_END) {
    // Padding may follow the last member, as tapes leave it.
    if (!is_gzip(packed)) return false;
    inflateReset(&stream);
  }
  const std::size_t given =
      std::min<std::size_t>(packed.size(), std::numeric_limits<uInt>::max() / 2);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(given);
  stream.next_out = reinterpret_cast<Bytef*>(block.data());
  stream.avail_out = static_cast<uInt>(block.size());
  state_->status = inflate(&stream, Z_NO_FLUSH);
  if (state_->status == Z_BUF_ERROR) {
    fail("its gzip stream ends too soon; is the file truncated?");
  }
  if (state_->status != Z_OK && state_->status != Z_STREAM_END) {
    fail("its gzip stream is damaged");
  }
  packed.remove_prefix(given - stream.avail_in);
  text.append(block, 0, block.size() - stream.avail_out);
  return true;
}

std::size_t GzipReader::largest_size(std::size_t packed) {
  return packed > std::numeric_limits<std::size_t>::max() / kLargestRatio
             ? std::numeric_limits<std::size_t>::max()
             : packed * kLargestRatio;
}

std::string unpack_gzip(std::string_view bytes, std::size_t limit) {
  GzipReader reader(bytes);
  std::string text;
  while (reader.append_to(text)) {
    if (text.size() > limit) fail("it unpacks to more than the {} bytes that are read", limit);
  }
  return text;
}

}  // namespace freepath
