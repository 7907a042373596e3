#include "apps/freepath/report_folder.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "freepath/base/error.h"
#include "freepath/io/atomic_file.h"

namespace freepath::program {
namespace {

namespace fs = std::filesystem;

std::string& remembered_command() {
  static std::string command;
  return command;
}

}  // namespace

ReportFolder::ReportFolder(const std::string& path) : path_(path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error)) {
    fail("-o {}: exists and is not a folder; name a folder for the report", path);
  }
  fs::create_directories(path, error);
  if (error) fail("-o {}: can't make the folder: {}", path, error.message());
  if (access(path.c_str(), W_OK | X_OK) != 0) fail("-o {}: the folder can't be written to", path);
  const AtomicFile trial(file("report.html"));
}

std::string ReportFolder::file(const std::string& name) const {
  return (fs::path(path_) / name).string();
}

void ReportFolder::write(const std::string& name, std::string_view contents) {
  attempts_.attempt([&] { write_file(file(name), contents); });
}

void ReportFolder::write(const std::string& name, const Image& image) {
  attempts_.attempt([&] { write_exr(file(name), image); });
}

std::string command_line() { return remembered_command(); }

void set_command_line(int argc, const char* const* argv) {
  std::string command = "freepath";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    constexpr const char* kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
    const bool plain = !argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos;
    command += ' ';
    if (plain) {
      command += argument;
      continue;
    }
    command += '\'';
    for (const char c : argument) command += c == '\'' ? std::string("'\\''") : std::string(1, c);
    command += '\'';
  }
  remembered_command() = command;
}

}  // namespace freepath::program
