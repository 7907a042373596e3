#pragma once
/// @file Data that gzip or zlib has packed.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace freepath {

/// Whether data begin as a gzip file does.
bool is_gzip(std::string_view bytes);

/// Unpacks a gzip file, or a stream of zlib's, piece by piece, as it is asked for. A file may have
/// several members.
class GzipReader {
 public:
  /// @param packed must outlive the reader
  explicit GzipReader(std::string_view packed);
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;
  ~GzipReader();

  /// Unpacks up to 64 KiB more.
  /// @return false at the end
  /// @throws Error, without a place, if the file is damaged or cut off
  bool append_to(std::string& text);

  /// Unpacked bytes for each packed one, at most: a match takes two bits at least, and stands for
  /// 258 bytes at most.
  static constexpr std::size_t kLargestRatio = std::size_t{4} * 258;
  /// Unpacked bytes of so many packed ones, at most.
  static std::size_t largest_size(std::size_t packed);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A whole gzip file, unpacked.
/// @throws Error, without a place, if it is damaged, cut off, or has more than `limit` bytes
/// unpacked
std::string unpack_gzip(std::string_view bytes, std::size_t limit);

}  // namespace freepath
