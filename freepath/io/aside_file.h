#pragma once
/// @file Files that appear whole or not at all.

#include <filesystem>
#include <string>
#include <string_view>

namespace freepath {

/// Checks that a file could be written, before the time for its contents is spent: the folder
/// exists and can be written to, and what stands there already is a file that is not read-only.
/// @throws Error that names the file and what to do
void check_file_place(const std::string& path);

/// A file beside the target, which replaces it when it is complete and else disappears: a reader
/// never sees half of it, and an old one survives a failure.
class AsideFile {
 public:
  /// @throws Error as check_file_place
  explicit AsideFile(const std::string& path);
  AsideFile(const AsideFile&) = delete;
  AsideFile& operator=(const AsideFile&) = delete;
  ~AsideFile();

  /// What to write to.
  std::string name() const { return aside_.string(); }
  /// @throws Error that names the target and the reason, always
  [[noreturn]] void give_up(const std::string& reason) const;
  void replace_target() const;

 private:
  std::string path_;
  std::filesystem::path target_, aside_;
};

/// Writes a whole file, aside and then renamed.
/// @throws Error that names the file
void write_file(const std::string& path, std::string_view contents);

}  // namespace freepath
