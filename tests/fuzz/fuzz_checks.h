#pragma once
/// @file What fuzz targets share: promises that end the program if they are broken, and inputs as
/// files.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "freepath/base/error.h"

namespace freepath::fuzz {

/// Ends the program, which the fuzzer takes for a finding, if a promise is broken.
inline void require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

/// Checks that an error or a warning about a file names it first and is of some length.
inline void check_message(const std::string& message, const std::string& name) {
  require(message.rfind(name + ":", 0) == 0, "a message begins with the name of the file");
  require(message.size() < 4000, "a message is not very long");
}

/// Calls a reader of the file, which may end in an Error about it and in nothing else.
template <class Read>
void attempt(const std::string& name, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    check_message(error.what(), name);
  }
}

/// A file in memory alone, for readers that take paths.
class FileInMemory {
 public:
  FileInMemory() : descriptor_(memfd_create("fuzz", 0)) {
    require(descriptor_ >= 0, "there is memory for a file");
  }
  ~FileInMemory() { close(descriptor_); }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
  void set(std::string_view bytes) const {
    require(ftruncate(descriptor_, 0) == 0, "the file can be emptied");
    require(
        pwrite(descriptor_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()),
        "the file can be written");
  }

 private:
  int descriptor_;
};

}  // namespace freepath::fuzz
