// Any bytes as a volume file.
//
// The smallest grids have 10 kB and 300 kB, nearly all of them 0 in masks and tables of nodes, so
// that an input says what to change in one of the files of the folder FREEPATH_FUZZ_BASES (in the
// environment): its first byte is the number of the file, and records of a 16-bit place, a length
// and so many bytes follow. Places are counted over the bytes near such that are not 0. A length of
// 255 cuts the file off there. A first byte of 255 means that the rest is the file itself.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/io/netcdf_codec.h"
#include "tests/fuzz/volume_checks.h"

extern "C" const freepath::io::NetcdfCodec* freepath_netcdf_codec();

// In place of that which loads it: it is part of this program.
const freepath::io::NetcdfCodec& freepath::io::netcdf_codec() { return *freepath_netcdf_codec(); }

namespace freepath::fuzz {
namespace {

namespace fs = std::filesystem;

/// A file to be damaged.
struct Base {
  std::string bytes;
  std::vector<std::size_t> offsets;  ///< Bytes near such that are not 0.
};

Base read_base(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  Base base;
  base.bytes.assign(std::istreambuf_iterator<char>(stream), {});
  constexpr std::size_t kNear = 8;
  std::size_t next = 0;
  for (std::size_t i = 0; i < base.bytes.size(); ++i) {
    if (base.bytes[i] == 0) continue;
    for (next = std::max(next, i - std::min(i, kNear)); next < i + kNear; ++next) {
      if (next < base.bytes.size()) base.offsets.push_back(next);
    }
  }
  return base;
}

/// In the order of their names.
std::vector<Base> read_bases() {
  std::vector<fs::path> paths;
  const char* const folder = std::getenv("FREEPATH_FUZZ_BASES");  // NOLINT(concurrency-mt-unsafe)
  require(folder != nullptr, "FREEPATH_FUZZ_BASES is a folder of files");
  for (const auto& entry : fs::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Base> bases;
  for (const fs::path& path : paths) bases.push_back(read_base(path));
  require(!bases.empty() && !bases[0].offsets.empty(), "there are files to be damaged");
  return bases;
}

std::string damaged(std::string_view input) {
  static const std::vector<Base> bases = read_bases();
  const auto byte = [&](std::size_t i) { return static_cast<uint8_t>(input[i]); };
  constexpr uint8_t kMark = 255;
  if (input.empty()) return {};
  if (byte(0) == kMark) return std::string(input.substr(1));
  const Base& base = bases[byte(0) % bases.size()];
  std::string bytes = base.bytes;
  input.remove_prefix(1);
  constexpr std::size_t kHead = 3;
  while (input.size() > kHead) {
    const std::size_t number = std::size_t{byte(0)} | std::size_t{byte(1)} << 8U;
    const std::size_t offset = base.offsets[number % base.offsets.size()];
    if (byte(2) == kMark) {
      bytes.resize(std::min(bytes.size(), offset));
      break;
    }
    const std::size_t count = std::min<std::size_t>(byte(2), input.size() - kHead);
    for (std::size_t i = 0; i < count && offset + i < bytes.size(); ++i) {
      bytes[offset + i] = input[kHead + i];
    }
    input.remove_prefix(kHead + count);
  }
  return bytes;
}

}  // namespace
}  // namespace freepath::fuzz

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  freepath::fuzz::check_volume(
      freepath::fuzz::damaged({reinterpret_cast<const char*>(data), size}));
  return 0;
}
