#include "freepath/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

#include "freepath/base/error.h"

namespace freepath {

namespace fs = std::filesystem;

namespace {

std::string reason_of(int number) { return std::generic_category().message(number); }

/// The file that a path stands for: links are followed, even to what is not there yet, so that
/// renaming replaces their target.
fs::path resolved(const std::string& path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  fs::path target = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, error)); ++links) {
    if (links == kMostLinks) fail("{}: a link that leads to itself; choose another name", path);
    // What /dev/stdout leads to is open elsewhere, and would not see that it is replaced.
    if (target.string().starts_with("/proc/")) fail("{}: a stream, not a file; name a file", path);
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) fail("{}: can't follow the link: {}", path, error.message());
  }
  const fs::path real = fs::weakly_canonical(target, error);
  return error ? target : real;
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// The name of an open file among those of the process.
std::string process_name(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

}  // namespace

std::string random_word() {
  uint64_t bits = 0;
  if (getrandom(&bits, sizeof(bits), 0) != sizeof(bits)) {
    bits = static_cast<uint64_t>(getpid()) << 32U ^ reinterpret_cast<uintptr_t>(&bits);
  }
  return fmt::format("{:016x}", bits);
}

void check_file_target(const std::string& path) {
  const fs::path target = resolved(path);
  const fs::path folder = folder_of(target);
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    fail("{}: the folder {} does not exist; create it first", path, folder.string());
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    fail("{}: the folder {} can't be written to: {}", path, folder.string(), reason_of(errno));
  }
  const fs::file_status status = fs::status(target, error);
  if (status.type() == fs::file_type::not_found) return;
  if (!fs::exists(status)) {
    fail("{}: can't be written: {}; choose another name", path, error.message());
  }
  if (fs::is_directory(status)) fail("{}: is a directory; name the file to write", path);
  if (!fs::is_regular_file(status)) {
    fail("{}: exists and is not a file; choose another name", path);
  }
  // Renaming would replace a read-only file, and root may write to any: its mode is what counts.
  constexpr fs::perms kAnyWrite =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if ((status.permissions() & kAnyWrite) == fs::perms::none || access(target.c_str(), W_OK) != 0) {
    fail("{}: the file exists and is read-only; remove it or choose another name", path);
  }
}

template <class Take>
bool AtomicFile::take_name(Take take) {
  constexpr int kMostTries = 100;
  for (int i = 0; i < kMostTries; ++i) {
    const fs::path name = folder_of(target_) / fmt::format(".freepath-{}.partial", random_word());
    if (take(name)) {
      aside_ = name;
      return true;
    }
    if (errno != EEXIST) return false;
  }
  return false;
}

AtomicFile::AtomicFile(const std::string& path, AtomicKind kind)
    : path_(path), target_(resolved(path)) {
  check_file_target(path);
  if (kind == AtomicKind::kNamed || !open_nameless()) open_named();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      aside_(std::exchange(other.aside_, fs::path())),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!aside_.empty()) unlink(aside_.c_str());
}

bool AtomicFile::open_nameless() {
  descriptor_ = open(folder_of(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor_ < 0) return false;
  // It is written to, and gets its name, by the name that the process has for it.
  if (access(process_name(descriptor_).c_str(), W_OK) == 0) return true;
  close(std::exchange(descriptor_, -1));
  return false;
}

void AtomicFile::open_named() {
  const bool made = take_name([&](const fs::path& name) {
    descriptor_ = open(name.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR | O_CLOEXEC, 0666);
    return descriptor_ >= 0;
  });
  if (!made) give_up(reason_of(errno));
}

void AtomicFile::retarget(const std::string& path) {
  check_file_target(path);
  path_ = path;
  target_ = resolved(path);
}

std::string AtomicFile::name() const {
  const std::string own = process_name(descriptor_);
  return aside_.empty() || access(own.c_str(), W_OK) == 0 ? own : aside_.string();
}

void AtomicFile::write(std::string_view contents) const {
  if (ftruncate(descriptor_, 0) != 0 || lseek(descriptor_, 0, SEEK_SET) != 0) {
    give_up(reason_of(errno));
  }
  while (!contents.empty()) {
    const ssize_t count = ::write(descriptor_, contents.data(), contents.size());
    if (count < 0 && errno != EINTR) give_up(reason_of(errno));
    if (count > 0) contents.remove_prefix(static_cast<std::size_t>(count));
  }
}

void AtomicFile::give_up(const std::string& reason) const {
  std::string text = reason;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  fail("{}: can't write it: {}", path_, text.empty() ? "unknown reason" : text);
}

void AtomicFile::replace_target() {
  const bool nameless = aside_.empty();
  if (nameless) {
    const bool named = take_name([&](const fs::path& name) {
      return linkat(AT_FDCWD, process_name(descriptor_).c_str(), AT_FDCWD, name.c_str(),
                    AT_SYMLINK_FOLLOW) == 0;
    });
    if (!named) give_up(reason_of(errno));
  }
  // Where others may write, they had the time to put something else in its place.
  struct stat own {};
  struct stat found {};
  if (!nameless && (fstat(descriptor_, &own) != 0 || lstat(aside_.c_str(), &found) != 0)) {
    give_up(reason_of(errno));
  }
  if (own.st_ino != found.st_ino || own.st_dev != found.st_dev) {
    give_up("somebody else changes the files of its folder");
  }
  if (rename(aside_.c_str(), target_.c_str()) != 0) give_up(reason_of(errno));
  aside_.clear();
}

void write_file(const std::string& path, std::string_view contents) {
  AtomicFile file(path);
  file.write(contents);
  file.replace_target();
}

}  // namespace freepath
