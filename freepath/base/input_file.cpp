#include "freepath/base/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "freepath/base/error.h"

namespace freepath {
namespace {

std::string reason_of(int number) { return std::generic_category().message(number); }

std::atomic<InputFileLog*> current_log = nullptr;

}  // namespace

InputFileLog::InputFileLog() { current_log = this; }

InputFileLog::~InputFileLog() { current_log = nullptr; }

std::vector<std::string> InputFileLog::names() const {
  const std::lock_guard lock(mutex_);
  return {names_.begin(), names_.end()};
}

void InputFileLog::note(const std::filesystem::path& path) {
  InputFileLog* const log = current_log;
  if (log == nullptr) return;
  std::error_code error;
  const std::filesystem::path name = std::filesystem::weakly_canonical(path, error);
  const std::lock_guard lock(log->mutex_);
  log->names_.insert((error ? path : name).string());
}

InputFile::InputFile(const std::filesystem::path& path, std::string_view kind)
    : name_(path.string()) {
  // Opening a pipe without O_NONBLOCK would wait for a writer; regular files don't mind.
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor_ < 0) {
    const int number = errno;
    if (number == ENOENT) fail("{}: no such file; check the path", name_);
    fail("{}: can't be opened: {}", name_, reason_of(number));
  }
  struct stat status {};
  const bool known = fstat(descriptor_, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    close(descriptor_);
    if (known && S_ISDIR(status.st_mode)) fail("{}: is a directory; name {}", name_, kind);
    fail("{}: is a pipe or a device, not a regular file; name {}", name_, kind);
  }
  size_ = static_cast<uint64_t>(status.st_size);
  InputFileLog::note(path);
}

InputFile::~InputFile() { close(descriptor_); }

std::size_t InputFile::read(uint64_t offset, std::span<std::byte> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("{}: reading failed: {}", name_, reason_of(errno));
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

std::string read_input_file(const std::filesystem::path& path, std::string_view kind,
                            uint64_t limit) {
  const InputFile file(path, kind);
  if (file.size() > limit) {
    fail("{}: it has {} bytes, more than the {} that are read", file.name(), file.size(), limit);
  }
  std::string bytes(file.size(), '\0');
  bytes.resize(file.read(0, std::as_writable_bytes(std::span(bytes))));
  return bytes;
}

}  // namespace freepath
