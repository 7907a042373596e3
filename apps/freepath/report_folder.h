#pragma once
/// @file Folders that reports are written to.

#include <string>
#include <string_view>

namespace freepath::program {

/// A folder that is there and can be written to. Files appear in it whole or not at all.
class ReportFolder {
 public:
  /// Makes it where it is missing.
  /// @throws Error that says what to do, if there is a file of that name or it can't be made or
  ///   written to
  explicit ReportFolder(const std::string& path);

  /// Where a file of that name is.
  std::string file(const std::string& name) const;
  /// @throws Error that names the file
  void write(const std::string& name, std::string_view contents) const;

 private:
  std::string path_;
};

/// The command as it was typed, for reports, with quotes where a shell needs them.
std::string command_line();
/// Remembers it.
void set_command_line(int argc, const char* const* argv);

}  // namespace freepath::program
