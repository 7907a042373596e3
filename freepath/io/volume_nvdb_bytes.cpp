#include "freepath/io/volume_nvdb_bytes.h"

#include <blosc.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr std::size_t kZipInput = std::size_t{1} << 18;
constexpr uint64_t kBloscChunk = uint64_t{1} << 30;

std::variant<PlainBytes, ZipBytes, BloscBytes> bytes_of(const VolumeFile& file,
                                                        const NvdbExtent& extent) {
  file.require(extent.begin, extent.stored_size);
  switch (extent.codec) {
    case NvdbCodec::kZip:
      return ZipBytes(file, extent);
    case NvdbCodec::kBlosc:
      return BloscBytes(file, extent);
    case NvdbCodec::kNone:
      break;
  }
  return PlainBytes(file, extent);
}

/// The 64-bit size in front of a compressed block, which must fit into what is left.
uint64_t take_block_size(const VolumeFile& file, uint64_t offset, uint64_t end) {
  FileCursor cursor(file, offset);
  const auto size = cursor.take<uint64_t>();
  if (offset + sizeof(size) > end || size > end - offset - sizeof(size)) {
    file.fail_damaged(fmt::format("a compressed block of {} bytes at byte {}", size, offset));
  }
  return size;
}

}  // namespace

void PlainBytes::read(uint64_t offset, std::span<std::byte> bytes) {
  file_->read(extent_.begin + offset, bytes);
}

void ZipBytes::EndStream::operator()(z_stream* stream) const {
  inflateEnd(stream);
  delete stream;
}

ZipBytes::ZipBytes(const VolumeFile& file, const NvdbExtent& extent)
    : file_(&file), next_(extent.begin + sizeof(uint64_t)), input_(kZipInput) {
  end_ = next_ + take_block_size(file, extent.begin, extent.begin + extent.stored_size);
  auto stream = std::make_unique<z_stream>();
  if (inflateInit(stream.get()) != Z_OK) throw std::bad_alloc();
  stream_.reset(stream.release());
}

void ZipBytes::read(uint64_t offset, std::span<std::byte> bytes) {
  std::vector<std::byte> skipped(std::min<uint64_t>(kZipInput, offset - position_));
  while (position_ < offset) {
    inflate_into(std::span(skipped).first(std::min<uint64_t>(skipped.size(), offset - position_)));
  }
  inflate_into(bytes);
}

void ZipBytes::inflate_into(std::span<std::byte> bytes) {
  position_ += bytes.size();
  stream_->next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream_->avail_out = static_cast<uInt>(bytes.size());
  while (stream_->avail_out > 0) {
    if (stream_->avail_in == 0) {
      const auto input = std::span(input_).first(std::min<uint64_t>(kZipInput, end_ - next_));
      if (input.empty()) file_->fail_damaged("its zip stream ends too early");
      file_->read(next_, input);
      next_ += input.size();
      stream_->next_in = reinterpret_cast<Bytef*>(input.data());
      stream_->avail_in = static_cast<uInt>(input.size());
    }
    const int status = inflate(stream_.get(), Z_NO_FLUSH);
    const bool ended = status == Z_STREAM_END && stream_->avail_out > 0;
    if (ended || (status != Z_OK && status != Z_STREAM_END)) {
      file_->fail_damaged("its zip stream is broken");
    }
  }
}

BloscBytes::BloscBytes(const VolumeFile& file, const NvdbExtent& extent)
    : file_(&file), extent_(extent), next_(extent.begin) {}

void BloscBytes::load_next_chunk() {
  chunk_begin_ += chunk_size_;
  chunk_size_ = std::min(kBloscChunk, extent_.size - chunk_begin_);
  const uint64_t stored = take_block_size(*file_, next_, extent_.begin + extent_.stored_size);
  chunk_ = decltype(chunk_)();
  chunk_.resize(stored);
  file_->read(next_ + sizeof(uint64_t), chunk_);
  next_ += sizeof(uint64_t) + stored;
  std::size_t size = 0, compressed = 0;
  int flags = 0;
  if (blosc_cbuffer_validate(chunk_.data(), chunk_.size(), &size) != 0 || size != chunk_size_) {
    file_->fail_damaged("its blosc buffer is broken");
  }
  blosc_cbuffer_sizes(chunk_.data(), &size, &compressed, &block_size_);
  blosc_cbuffer_metainfo(chunk_.data(), &item_size_, &flags);
  if (block_size_ == 0 || item_size_ == 0 || 32 % item_size_ != 0) {
    file_->fail_damaged("its blosc buffer is of no known layout");
  }
  // Behind the header stands where each block begins, in order as a single thread wrote them.
  released_ = 0;
  in_order_ = (flags & 0x2) == 0;  // not merely copied
  const std::size_t blocks = (size + block_size_ - 1) / block_size_;
  if (!in_order_ || BLOSC_MIN_HEADER_LENGTH + 4 * blocks > chunk_.size()) return;
  int32_t last = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    int32_t start;
    std::memcpy(&start, chunk_.data() + BLOSC_MIN_HEADER_LENGTH + 4 * block, sizeof(start));
    in_order_ = in_order_ && start >= last;
    last = start;
  }
}

void BloscBytes::release_before(uint64_t begin) {
  if (!in_order_) return;
  int32_t start;
  const std::size_t block = begin / block_size_;
  std::memcpy(&start, chunk_.data() + BLOSC_MIN_HEADER_LENGTH + 4 * block, sizeof(start));
  // The header and the starts of blocks stay; so does a partial page at either end.
  const std::size_t first =
      std::max(released_, BLOSC_MIN_HEADER_LENGTH + 4 * (chunk_size_ / block_size_ + 1));
  constexpr std::size_t kWorthIt = std::size_t{4} << 20;
  if (start < 0 || static_cast<std::size_t>(start) < first + kWorthIt) return;
  release_pages(
      std::span(chunk_).first(std::min<std::size_t>(start, chunk_.size())).subspan(first));
  released_ = static_cast<std::size_t>(start);
}

void BloscBytes::read_from_chunk(uint64_t begin, std::span<std::byte> bytes) {
  const int count = blosc_getitem(chunk_.data(), static_cast<int>(begin / item_size_),
                                  static_cast<int>(bytes.size() / item_size_), bytes.data());
  if (count < 0 || static_cast<std::size_t>(count) != bytes.size()) {
    file_->fail_damaged("its blosc buffer is broken");
  }
  release_before(begin);
}

void BloscBytes::read(uint64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    while (offset >= chunk_begin_ + chunk_size_) load_next_chunk();
    const uint64_t begin = offset - chunk_begin_;
    const auto part = bytes.first(std::min<uint64_t>(bytes.size(), chunk_size_ - begin));
    read_from_chunk(begin, part);
    bytes = bytes.subspan(part.size());
    offset += part.size();
  }
}

NvdbBytes::NvdbBytes(const VolumeFile& file, const NvdbExtent& extent)
    : file_(&file), size_(extent.size), bytes_(bytes_of(file, extent)) {}

void NvdbBytes::read(uint64_t offset, std::span<std::byte> bytes) {
  if (offset > size_ || bytes.size() > size_ - offset) {
    file_->fail_damaged(fmt::format("a grid of {} bytes refers to bytes {} to {}", size_, offset,
                                    offset + bytes.size()));
  }
  std::visit([&](auto& source) { source.read(offset, bytes); }, bytes_);
}

}  // namespace freepath::io
