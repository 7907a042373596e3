#include "freepath/scene/pbrt/file_reader.h"

#include <fstream>
#include <system_error>

#include "freepath/base/error.h"

namespace freepath {

bool DiskFileReader::exists(const std::filesystem::path& path) const {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

std::string DiskFileReader::read(const std::filesystem::path& path, std::size_t limit) const {
  std::error_code trouble;
  const std::filesystem::file_status status = std::filesystem::status(path, trouble);
  if (!std::filesystem::exists(status)) fail("there is no such file");
  // A directory, or a device or pipe that may never end.
  if (!std::filesystem::is_regular_file(status)) fail("it is no regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, trouble);
  if (trouble) fail("it cannot be read: {}", trouble.message());
  if (size > limit) fail("it has {} bytes, more than the {} that are read", size, limit);
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) fail("it cannot be read; may you read it?");
  return bytes;
}

std::filesystem::path locate_file(const FileReader& reader, const std::filesystem::path& name,
                                  const std::filesystem::path& named_in,
                                  const std::filesystem::path& main_file) {
  std::filesystem::path beside = (named_in.parent_path() / name).lexically_normal();
  if (reader.exists(beside)) return beside;
  std::filesystem::path beside_main = (main_file.parent_path() / name).lexically_normal();
  return reader.exists(beside_main) ? beside_main : beside;
}

}  // namespace freepath
