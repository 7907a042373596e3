#pragma once
/// @file Bytes in memory as a stream, for libraries that read streams.

#include <algorithm>
#include <cstddef>
#include <span>
#include <streambuf>

namespace freepath::io {

/// A stream over bytes in memory.
class MemoryBuffer : public std::streambuf {
 public:
  void reset(std::span<const std::byte> bytes) {
    char* const begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    setg(begin, begin, begin + bytes.size());  // never written to: a streambuf is not const-correct
  }
  std::size_t taken() const { return static_cast<std::size_t>(gptr() - eback()); }

 protected:
  std::streamsize xsgetn(char* destination, std::streamsize count) override {
    count = std::min<std::streamsize>(count, egptr() - gptr());
    std::copy_n(gptr(), count, destination);
    setg(eback(), gptr() + count, egptr());
    return count;
  }
};

}  // namespace freepath::io
