#pragma once
/// @file How the parser gets at files, so that a scene can come from memory as well as from a disk.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace freepath {

/// A source of files.
class FileReader {
 public:
  virtual ~FileReader() = default;
  virtual bool exists(const std::filesystem::path& path) const = 0;
  /// All bytes of a file.
  /// @throws Error with the reason, without the name, if it can't be read or has more than `limit`
  ///   bytes
  virtual std::string read(const std::filesystem::path& path, std::size_t limit) const = 0;
};

/// Reads files of the file system.
class DiskFileReader final : public FileReader {
 public:
  bool exists(const std::filesystem::path& path) const override;
  std::string read(const std::filesystem::path& path, std::size_t limit) const override;
};

/// Where a file may be that is named in a scene: beside the file that names it, or else beside the
/// scene's main file, where pbrt looks. The first of these that exists, else the first.
std::filesystem::path locate_file(const FileReader& reader, const std::filesystem::path& name,
                                  const std::filesystem::path& named_in,
                                  const std::filesystem::path& main_file);

}  // namespace freepath
