#pragma once
/// @file Files that are read: the one place where they are opened.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freepath {

/// While one of these lives, keeps the names of the files that are opened; one at a time.
class InputFileLog {
 public:
  InputFileLog();
  ~InputFileLog();
  InputFileLog(const InputFileLog&) = delete;
  InputFileLog& operator=(const InputFileLog&) = delete;

  /// Their absolute names, without links, sorted.
  std::vector<std::string> names() const;
  /// Called for each file that is opened, by any thread.
  static void note(const std::filesystem::path& path);

 private:
  mutable std::mutex mutex_;
  std::set<std::string> names_;
};

/// An open regular file. Pipes and devices are refused, since they may make a reader wait or never
/// end. Every error names the file.
class InputFile {
 public:
  /// @param kind what to name instead, in messages: "an image", "a volume file"
  /// @throws Error if it doesn't exist, is no regular file or can't be opened
  explicit InputFile(const std::filesystem::path& path, std::string_view kind = "a file");
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& name() const { return name_; }
  /// Bytes it had when it was opened.
  uint64_t size() const { return size_; }

  /// Fills `bytes` from `offset` on; may be called by several threads.
  /// @return how many bytes there were: fewer only where the file ends
  /// @throws Error if reading fails
  std::size_t read(uint64_t offset, std::span<std::byte> bytes) const;

 private:
  std::string name_;
  uint64_t size_ = 0;
  int descriptor_ = -1;
};

/// The contents of a file.
/// @param limit the most bytes that are taken
/// @throws Error as InputFile, and for a file of more than `limit` bytes
std::string read_input_file(const std::filesystem::path& path, std::string_view kind = "a file",
                            uint64_t limit = std::numeric_limits<uint64_t>::max());

}  // namespace freepath
