// Any bytes as an image of a format that environments and textures come in: EXR, HDR, PNG, PFM or
// QOI, told by the first bytes.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "freepath/io/image.h"
#include "freepath/io/image_codec.h"
#include "tests/fuzz/fuzz_checks.h"

extern "C" const freepath::ImageCodec* freepath_image_codec();

namespace freepath {

// In place of that which loads it: it is part of this program.
const ImageCodec& image_codec() { return *freepath_image_codec(); }

namespace fuzz {
namespace {

namespace fs = std::filesystem;

/// A name for the file whose extension OpenImageIO goes by, or nothing for other formats.
std::string name_for(std::string_view bytes) {
  using namespace std::string_view_literals;
  const auto begins = [&](std::string_view magic) {
    return bytes.substr(0, magic.size()) == magic;
  };
  if (begins("\x76\x2f\x31\x01"sv)) return "image.exr";
  if (begins("#?"sv)) return "image.hdr";
  if (begins("\x89PNG"sv)) return "image.png";
  if (begins("PF"sv) || begins("Pf"sv)) return "image.pfm";
  if (begins("qoif"sv)) return "image.qoi";
  return {};
}

/// A folder in which each name is a link to a file in memory.
class Links {
 public:
  Links() {
    std::string folder = fs::temp_directory_path() / "freepath_fuzz_XXXXXX";
    require(mkdtemp(folder.data()) != nullptr, "there is a folder for links");
    folder_ = folder;
    for (const char* name : {"image.exr", "image.hdr", "image.png", "image.pfm", "image.qoi"}) {
      fs::create_symlink(file_.path(), folder_ / name);
    }
  }
  ~Links() { fs::remove_all(folder_); }
  Links(const Links&) = delete;
  Links& operator=(const Links&) = delete;

  const FileInMemory& file() const { return file_; }
  std::string path(const std::string& name) const { return folder_ / name; }

 private:
  FileInMemory file_;
  fs::path folder_;
};

void check_image(std::string_view bytes) {
  static const Links links;
  const std::string name = name_for(bytes);
  if (name.empty()) return;
  links.file().set(bytes);
  const std::string path = links.path(name);
  attempt(path, [&] {
    Image image = read_image(path);
    require(image.width > 0 && image.height > 0 && !image.channels.empty(), "there are pixels");
    require(image.values.size() == image.pixel_count() * image.channels.size(),
            "there are as many values as pixels and channels");
    image = in_srgb(std::move(image));
    colour_channels(image, path);
  });
}

}  // namespace
}  // namespace fuzz
}  // namespace freepath

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  freepath::fuzz::check_image({reinterpret_cast<const char*>(data), size});
  return 0;
}
