#pragma once
/// @file The bytes of a volume file, read at given places and never past the end.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "freepath/base/input_file.h"

namespace freepath::io {

/// An open file. Every error names it.
class VolumeFile {
 public:
  /// @throws Error as InputFile, and if it is empty
  explicit VolumeFile(const std::filesystem::path& path);

  const std::string& name() const { return file_.name(); }
  uint64_t size() const { return file_.size(); }

  /// Fills `bytes` from `offset` on; may be called by several threads.
  /// @throws Error if the file ends before
  void read(uint64_t offset, std::span<std::byte> bytes) const;

  /// @throws Error if the file ends before `bytes` from `offset` on
  void require(uint64_t offset, uint64_t bytes) const;

  /// Throws the Error of a file that ends too early or contradicts itself.
  [[noreturn]] void fail_damaged(const std::string& what) const;

 private:
  InputFile file_;
};

/// Reads a file forward through a window, with every length checked. The window grows to a megabyte
/// as long as reading goes on where it ended.
class FileCursor {
 public:
  FileCursor(const VolumeFile& file, uint64_t offset) : file_(&file), offset_(offset) {}

  const VolumeFile& file() const { return *file_; }
  uint64_t offset() const { return offset_; }
  void seek(uint64_t offset) { offset_ = offset; }
  /// @throws Error if the file ends before
  void skip(uint64_t bytes);

  /// The bytes at a place at or behind the cursor, which stays. Valid until the next call.
  std::span<const std::byte> peek(uint64_t ahead, std::size_t bytes);

  /// Takes one value.
  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, peek(0, sizeof(T)).data(), sizeof(T));
    offset_ += sizeof(T);
    return value;
  }
  /// Takes a string behind its 32-bit length.
  std::string take_string();

 private:
  const VolumeFile* file_;
  uint64_t offset_;
  uint64_t window_offset_ = 0;
  std::size_t wish_ = 0;  // for the window
  std::vector<std::byte> window_;
};

}  // namespace freepath::io
