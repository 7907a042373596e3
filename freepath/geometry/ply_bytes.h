#pragma once
/// @file The bytes of a PLY file, packed by gzip or not. Internal to this folder.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "freepath/base/gzip.h"

namespace freepath {

/// Bytes in their order, unpacked as they are asked for: what a header does not declare is never
/// unpacked, however much there is of it.
class PlyBytes {
 public:
  /// @param content of the file, which must outlive this
  /// @param name of the file, for messages
  PlyBytes(std::string_view content, const std::string& name);

  /// What comes next: `size` bytes at least, unless the file ends before.
  /// @throws Error if the file is damaged, or unpacks to far more than meshes do
  std::string_view ahead(std::size_t size) {
    if (ahead_.size() < size && packed_) unpack(size);
    return ahead_;
  }
  void skip(std::size_t size) { ahead_.remove_prefix(size); }

  /// Looks whether the file goes on, or ends, as it should.
  /// @throws Error if it is damaged or was cut off
  void check_end() { ahead(ahead_.size() + 1); }

  /// Bytes that there can be at most.
  std::size_t largest_size() const { return largest_size_; }

 private:
  void unpack(std::size_t size);

  const std::string& name_;
  std::optional<GzipReader> packed_;  ///< Nothing once all is unpacked.
  std::string unpacked_;
  std::string_view ahead_;
  std::size_t largest_size_;
  std::size_t total_ = 0;  ///< Unpacked so far [bytes].
};

}  // namespace freepath
