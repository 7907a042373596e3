#include "freepath/io/volume_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr std::size_t kWindow = std::size_t{1} << 20;
constexpr std::size_t kLongestString = std::size_t{1} << 16;

std::string message_of_errno() { return std::generic_category().message(errno); }

}  // namespace

VolumeFile::VolumeFile(const std::filesystem::path& path) : name_(path.string()) {
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    if (errno == ENOENT) fail("{}: no such file; check the path", name_);
    fail("{}: can't be opened: {}", name_, message_of_errno());
  }
  struct stat status {};
  const bool known = fstat(descriptor_, &status) == 0;
  const bool regular = known && S_ISREG(status.st_mode);
  if (!regular || status.st_size == 0) {
    close(descriptor_);
    if (known && S_ISDIR(status.st_mode)) fail("{}: is a directory; name a volume file", name_);
    if (!regular) fail("{}: is not a regular file; name a volume file", name_);
    fail("{}: the file is empty; copy or export it again", name_);
  }
  size_ = static_cast<uint64_t>(status.st_size);
}

VolumeFile::~VolumeFile() { close(descriptor_); }

void VolumeFile::require(uint64_t offset, uint64_t bytes) const {
  if (offset > size_ || bytes > size_ - offset) {
    fail_damaged(fmt::format("it ends at byte {}, where {} bytes from {} on are needed", size_,
                             bytes, offset));
  }
}

void VolumeFile::read(uint64_t offset, std::span<std::byte> bytes) const {
  require(offset, bytes.size());
  while (!bytes.empty()) {
    const ssize_t count =
        pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("{}: reading failed: {}", name_, message_of_errno());
    if (count == 0) fail_damaged("it became shorter while it was read");
    offset += static_cast<uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void VolumeFile::fail_damaged(const std::string& what) const {
  fail("{}: the file is truncated or damaged: {}; copy or export it again", name_, what);
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
    window_.resize(std::max<uint64_t>(bytes, std::min<uint64_t>(kWindow, file_->size() - begin)));
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
