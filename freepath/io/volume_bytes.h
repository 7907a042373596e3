#pragma once
/// @file Bytes of a volume file that are read once from front to back, unpacked on the way.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "freepath/io/volume_file.h"

namespace freepath::io {

/// Bytes that come one after the other.
class ByteSource {
 public:
  /// @param file named in errors; must outlive the source
  explicit ByteSource(const VolumeFile& file) : file_(&file) {}
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  const VolumeFile& file() const { return *file_; }

  /// Fills the front of `bytes`.
  /// @return how many bytes there were: fewer only at the end
  /// @throws Error if the file is damaged
  virtual std::size_t read_some(std::span<std::byte> bytes) = 0;

  /// Looks, behind the bytes that are wanted, whether a sum over all that were packed is right, if
  /// it stands there.
  /// @throws Error if it is wrong or missing
  virtual void check_end() {}

  /// Fills `bytes`.
  /// @throws Error if they end before
  void read(std::span<std::byte> bytes);

 private:
  const VolumeFile* file_;
};

using ByteSourcePointer = std::unique_ptr<ByteSource>;

/// Bytes of a file from one place to another, or to its end.
ByteSourcePointer file_bytes(const VolumeFile& file, uint64_t begin, uint64_t end = UINT64_MAX);

/// Bytes in memory, which must outlive the source.
/// @param file named in errors
ByteSourcePointer memory_bytes(const VolumeFile& file, std::string_view bytes);

/// What base64 characters stand for: blanks are skipped, padding may stand anywhere, and the first
/// character that is none of the alphabet ends them.
ByteSourcePointer base64_bytes(ByteSourcePointer text);

/// What gzip or zlib has packed into the bytes of a file from one place to another, or to its end.
/// @throws Error if there is no memory for the packed bytes
ByteSourcePointer gzip_bytes(const VolumeFile& file, uint64_t begin, uint64_t end = UINT64_MAX);

/// The data of an array in VTK's XML formats behind its head: the number of its bytes; or, if it is
/// packed, the numbers of blocks, of bytes in a block, in the last one, and in each as it is packed
/// by zlib.
/// @param word bytes of each number in the head, 4 or 8
/// @param bytes of the array, as its extents and type have it
/// @throws Error if the head says something else
ByteSourcePointer vtk_array_bytes(ByteSourcePointer stored, bool packed, std::size_t word,
                                  std::endian order, uint64_t bytes);

}  // namespace freepath::io
