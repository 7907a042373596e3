#include "freepath/io/image_codec.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "freepath/base/error.h"
#include "freepath/base/version.h"

namespace freepath {
namespace {

/// By the search path of this program and the system's; else, since not every loader knows of the
/// former, beside the folder that the program lies in.
void* open_library() {
  if (void* const library = dlopen(FREEPATH_IMAGE_LIBRARY, RTLD_LAZY | RTLD_LOCAL)) return library;
  const std::string reason = dlerror();
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path beside =
      program.parent_path() / FREEPATH_LIBRARY_FOLDER / FREEPATH_IMAGE_LIBRARY;
  if (void* const library = dlopen(beside.c_str(), RTLD_LAZY | RTLD_LOCAL)) return library;
  fail(
      "can't load the library that reads images: {}. It is installed together with "
      "freepath; if it was moved, name its folder in LD_LIBRARY_PATH",
      std::filesystem::exists(beside, ignored) ? dlerror() : reason);
}

const ImageCodec& load() {
  void* const library = open_library();
  const auto function = reinterpret_cast<ImageCodecFunction>(dlsym(library, kImageCodecFunction));
  if (function == nullptr) fail("{}: no library of freepath's", FREEPATH_IMAGE_LIBRARY);
  const ImageCodec* const codec = function();
  if (std::string_view(codec->version) != version()) {
    fail("{} is of freepath {}, and this is {}; install both together", FREEPATH_IMAGE_LIBRARY,
         codec->version, version());
  }
  return *codec;
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec& codec = load();
  return codec;
}

}  // namespace freepath
