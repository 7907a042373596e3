#include "freepath/io/aside_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "freepath/base/error.h"

namespace freepath {

namespace fs = std::filesystem;

namespace {

/// The file that a path stands for: a link is followed, so that renaming replaces its target.
fs::path resolved(const std::string& path) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  return error ? fs::path(path) : real;
}

}  // namespace

void check_file_place(const std::string& path) {
  const fs::path target = resolved(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    fail("{}: the folder {} does not exist; create it first", path, folder.string());
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    fail("{}: the folder {} can't be written to", path, folder.string());
  }
  const fs::file_status status = fs::status(target, error);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status)) fail("{}: exists and is not a file", path);
  // Renaming would replace a read-only file, and root may write to any: its mode is what counts.
  constexpr fs::perms kAnyWrite =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if ((status.permissions() & kAnyWrite) == fs::perms::none || access(target.c_str(), W_OK) != 0) {
    fail("{}: the file exists and is read-only; remove it or choose another name", path);
  }
}

AsideFile::AsideFile(const std::string& path) : path_(path), target_(resolved(path)) {
  check_file_place(path);
  aside_ =
      target_.parent_path() / fmt::format(".{}.{}.partial", target_.filename().string(), getpid());
}

AsideFile::~AsideFile() {
  std::error_code ignored;
  fs::remove(aside_, ignored);
}

void AsideFile::give_up(const std::string& reason) const {
  std::string text = reason;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  fail("{}: can't write it: {}", path_, text.empty() ? "unknown reason" : text);
}

void AsideFile::replace_target() const {
  std::error_code error;
  fs::rename(aside_, target_, error);
  if (error) give_up(error.message());
}

void write_file(const std::string& path, std::string_view contents) {
  const AsideFile file(path);
  std::ofstream stream(file.name(), std::ios::binary);
  stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
  stream.close();
  if (!stream) file.give_up(std::generic_category().message(errno));
  file.replace_target();
}

}  // namespace freepath
