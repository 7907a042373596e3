#include "freepath/io/format_library.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

namespace freepath {
namespace {

/// By the search path of this program and the system's; else, since not every loader knows of the
/// former, beside the folder that the program lies in.
void* open_library(const std::string& library, std::string_view what) {
  if (void* const opened = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL)) return opened;
  const std::string reason = dlerror();
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path beside = program.parent_path() / FREEPATH_LIBRARY_FOLDER / library;
  if (void* const opened = dlopen(beside.c_str(), RTLD_LAZY | RTLD_LOCAL)) return opened;
  fail(
      "can't load the library that reads {}: {}. It is installed together with "
      "freepath; if it was moved, name its folder in LD_LIBRARY_PATH",
      what, std::filesystem::exists(beside, ignored) ? dlerror() : reason);
}

}  // namespace

void* load_format_library(const std::string& library, const std::string& function,
                          std::string_view what) {
  void* const found = dlsym(open_library(library, what), function.c_str());
  if (found == nullptr) fail("{}: no library of freepath's", library);
  return found;
}

}  // namespace freepath
