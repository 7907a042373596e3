#include "freepath/scene/pbrt/file_reader.h"

#include <string>
#include <system_error>

#include "freepath/base/error.h"
#include "freepath/base/input_file.h"

namespace freepath {

bool DiskFileReader::exists(const std::filesystem::path& path) const {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

std::string DiskFileReader::read(const std::filesystem::path& path, std::size_t limit) const {
  try {
    return read_input_file(path, "a scene file", limit);
  } catch (const Error& error) {  // whose place and name are the caller's to say
    const std::string text = error.what();
    const std::string name = path.string() + ": ";
    throw Error(text.starts_with(name) ? text.substr(name.size()) : text);
  }
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
