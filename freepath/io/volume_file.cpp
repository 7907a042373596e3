#include "freepath/io/volume_file.h"

#include <algorithm>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr std::size_t kFirstWindow = std::size_t{1} << 12, kWindow = std::size_t{1} << 20;
constexpr std::size_t kLongestString = std::size_t{1} << 16;

}  // namespace

VolumeFile::VolumeFile(const std::filesystem::path& path) : file_(path, "a volume file") {
  if (size() == 0) fail("{}: the file is empty; copy or export it again", name());
}

void VolumeFile::require(uint64_t offset, uint64_t bytes) const {
  if (offset > size() || bytes > size() - offset) {
    fail_damaged(fmt::format("it ends at byte {}, where {} bytes from {} on are needed", size(),
                             bytes, offset));
  }
}

void VolumeFile::read(uint64_t offset, std::span<std::byte> bytes) const {
  require(offset, bytes.size());
  if (file_.read(offset, bytes) < bytes.size()) fail_damaged("it became shorter while it was read");
}

void VolumeFile::fail_damaged(const std::string& what) const {
  fail("{}: the file is truncated or damaged: {}; copy or export it again", name(), what);
}

void FileCursor::skip(uint64_t bytes) {
  file_->require(offset_, bytes);
  offset_ += bytes;
}

std::span<const std::byte> FileCursor::peek(uint64_t ahead, std::size_t bytes) {
  const uint64_t begin = offset_ + ahead;
  const bool inside = begin >= window_offset_ && begin - window_offset_ <= window_.size() &&
                      bytes <= window_.size() - (begin - window_offset_);
  if (!inside) {
    file_->require(begin, bytes);
    const bool onward = begin >= window_offset_ && begin <= window_offset_ + window_.size();
    wish_ = onward && wish_ > 0 ? std::min(kWindow, 4 * wish_) : kFirstWindow;
    window_.resize(std::max<uint64_t>(bytes, std::min<uint64_t>(wish_, file_->size() - begin)));
    file_->read(begin, window_);
    window_offset_ = begin;
  }
  return std::span(window_).subspan(begin - window_offset_, bytes);
}

std::string FileCursor::take_string() {
  const auto length = take<uint32_t>();
  if (length > kLongestString) {
    file_->fail_damaged(fmt::format("a string of {} bytes at byte {}", length, offset_ - 4));
  }
  const auto bytes = peek(0, length);
  offset_ += length;
  return {reinterpret_cast<const char*>(bytes.data()), length};
}

}  // namespace freepath::io
