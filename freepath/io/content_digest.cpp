#include <OpenImageIO/hash.h>

#include <array>

#include "freepath/base/input_file.h"
#include "freepath/io/content_digest.h"

namespace freepath {

void ContentDigest::add(std::string_view text) {
  parts_ += OIIO::SHA1(text.data(), text.size()).digest();
}

void ContentDigest::add_file(const std::string& path) {
  const InputFile file(path);
  OIIO::SHA1 digest;
  std::array<std::byte, 1 << 16> buffer;
  uint64_t offset = 0;
  while (const std::size_t count = file.read(offset, buffer)) {
    digest.append(buffer.data(), count);
    offset += count;
  }
  parts_ += digest.digest();
}

std::string ContentDigest::hex() const { return OIIO::SHA1(parts_.data(), parts_.size()).digest(); }

}  // namespace freepath
