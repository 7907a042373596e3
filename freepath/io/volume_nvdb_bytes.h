#pragma once
/// @file The bytes of one grid of a NanoVDB file, uncompressed on the way and read forward, so that
/// the grid is never in memory as a whole.

#include <zlib.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "freepath/base/page_allocator.h"
#include "freepath/io/volume_file.h"

namespace freepath::io {

/// Codecs as the file numbers them.
enum class NvdbCodec : uint16_t { kNone = 0, kZip = 1, kBlosc = 2 };

/// Where a grid stands in the file, and how.
struct NvdbExtent {
  NvdbCodec codec = NvdbCodec::kNone;
  uint64_t begin = 0;        ///< First byte in the file.
  uint64_t stored_size = 0;  ///< Bytes in the file.
  uint64_t size = 0;         ///< Bytes uncompressed.
};

/// Uncompressed: read where it stands.
class PlainBytes {
 public:
  PlainBytes(const VolumeFile& file, const NvdbExtent& extent) : file_(&file), extent_(extent) {}
  void read(uint64_t offset, std::span<std::byte> bytes);

 private:
  const VolumeFile* file_;
  NvdbExtent extent_;
};

/// One zlib stream behind its 64-bit size.
class ZipBytes {
 public:
  ZipBytes(const VolumeFile& file, const NvdbExtent& extent);
  void read(uint64_t offset, std::span<std::byte> bytes);

 private:
  void inflate_into(std::span<std::byte> bytes);

  struct EndStream {
    void operator()(z_stream* stream) const;
  };
  const VolumeFile* file_;
  uint64_t next_ = 0, end_ = 0;  // compressed bytes still to be read from the file
  uint64_t position_ = 0;        // in the uncompressed grid
  std::vector<std::byte> input_;
  std::unique_ptr<z_stream, EndStream> stream_;
};

/// Blosc buffers, each of a gigabyte (the last less) behind its 64-bit size.
class BloscBytes {
 public:
  BloscBytes(const VolumeFile& file, const NvdbExtent& extent);
  void read(uint64_t offset, std::span<std::byte> bytes);

 private:
  void load_next_chunk();
  void read_from_chunk(uint64_t begin, std::span<std::byte> bytes);
  void release_before(uint64_t begin);

  const VolumeFile* file_;
  NvdbExtent extent_;
  uint64_t next_ = 0;                           // of the next chunk in the file
  uint64_t chunk_begin_ = 0, chunk_size_ = 0;   // uncompressed
  std::size_t item_size_ = 1, block_size_ = 1;  // of the chunk
  std::size_t released_ = 0;                    // compressed bytes given back
  bool in_order_ = false;                       // whether its blocks stand in order
  std::vector<std::byte, PageAllocator<std::byte>> chunk_;
};

/// The bytes of a grid. Offsets must not decrease from call to call.
class NvdbBytes {
 public:
  /// @throws Error if the codec's framing contradicts the extent
  NvdbBytes(const VolumeFile& file, const NvdbExtent& extent);

  uint64_t size() const { return size_; }

  /// Fills `bytes` from `offset` in the grid on; offsets and sizes are multiples of 32.
  /// @throws Error if the grid ends before, or its compressed bytes are damaged
  void read(uint64_t offset, std::span<std::byte> bytes);

 private:
  const VolumeFile* file_;
  uint64_t size_;
  std::variant<PlainBytes, ZipBytes, BloscBytes> bytes_;
};

}  // namespace freepath::io
