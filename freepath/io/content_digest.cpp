// Before OpenImageIO's headers, which bring an fmt of their own.
#include "freepath/base/error.h"

#include <OpenImageIO/hash.h>

#include <array>
#include <fstream>

#include "freepath/io/content_digest.h"

namespace freepath {

void ContentDigest::add(std::string_view text) {
  parts_ += OIIO::SHA1(text.data(), text.size()).digest();
}

void ContentDigest::add_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  OIIO::SHA1 digest;
  std::array<char, 1 << 16> buffer;
  while (file) {
    file.read(buffer.data(), buffer.size());
    digest.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.eof()) fail("{}: can't read the file", path);
  parts_ += digest.digest();
}

std::string ContentDigest::hex() const { return OIIO::SHA1(parts_.data(), parts_.size()).digest(); }

}  // namespace freepath
