#pragma once
/// @file Folders that reports are written to.

#include <string>
#include <string_view>

#include "apps/freepath/attempts.h"
#include "freepath/io/image.h"

namespace freepath::program {

/// A folder that is there and can be written to. Files appear in it whole or not at all.
class ReportFolder {
 public:
  /// Makes it where it is missing.
  /// @throws Error that says what to do, if there is a file of that name or it can't be made or
  ///   written to, or takes no file
  explicit ReportFolder(const std::string& path);

  /// Where a file of that name is.
  std::string file(const std::string& name) const;
  /// Writes a file, whatever became of those before.
  void write(const std::string& name, std::string_view contents);
  void write(const std::string& name, const Image& image);
  /// @throws Error that names the files that could not be written
  void finish() const { attempts_.finish(); }

 private:
  std::string path_;
  Attempts attempts_;
};

/// The command as it was typed, for reports, with quotes where a shell needs them.
std::string command_line();
/// Remembers it.
void set_command_line(int argc, const char* const* argv);

}  // namespace freepath::program
