#include "freepath/io/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/printable.h"

namespace freepath::io {
namespace {

constexpr std::array<uint8_t, 4> kMagic = {0x76, 0x2f, 0x31, 0x01};

/// Types whose values have one size [bytes], which OpenEXR reads whatever the file says.
struct FixedType {
  std::string_view name;
  uint32_t bytes;
};
constexpr std::array<FixedType, 25> kFixedTypes{{
    {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
    {"m44d", 128},      {"m44f", 64},    {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
    {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
    {"v3f", 12},        {"v3i", 12},     {"deepImageState", 1},
    {"half", 2},
}};

/// A number, little-endian as this machine.
int32_t number_at(std::span<const std::byte> bytes, std::size_t at) {
  int32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

/// A list of channels: a name that ends in 0 and 16 bytes for each, and an empty name.
bool is_channel_list(std::span<const std::byte> value) {
  constexpr std::size_t kBehindName = 16;
  for (std::size_t at = 0; at < value.size();) {
    const auto* const begin = value.data() + at;
    const void* const end = std::memchr(begin, 0, value.size() - at);
    if (end == nullptr) return false;
    const auto length = static_cast<std::size_t>(static_cast<const std::byte*>(end) - begin);
    if (length == 0) return at + 1 == value.size();
    at += length + 1 + kBehindName;
  }
  return false;
}

/// Texts, each behind its length.
bool is_text_list(std::span<const std::byte> value) {
  std::size_t at = 0;
  while (at + sizeof(int32_t) <= value.size()) {
    const int32_t length = number_at(value, at);
    if (length < 0) return false;
    at += sizeof(int32_t) + static_cast<std::size_t>(length);
  }
  return at == value.size();
}

/// A small picture: width, height and four bytes for each pixel.
bool is_preview(std::span<const std::byte> value) {
  constexpr std::size_t kHead = 8;
  if (value.size() < kHead) return false;
  const int64_t width = number_at(value, 0);
  const int64_t height = number_at(value, 4);
  return width >= 0 && height >= 0 &&
         (width == 0 || height <= static_cast<int64_t>(value.size()) / width) &&
         static_cast<std::size_t>(4 * width * height) == value.size() - kHead;
}

/// Whether a value of this type can have this size and these bytes.
bool is_value(std::string_view type, std::span<const std::byte> value) {
  if (type == "chlist") return is_channel_list(value);
  if (type == "stringvector") return is_text_list(value);
  if (type == "preview") return is_preview(value);
  if (type == "floatvector") return value.size() % sizeof(float) == 0;
  const auto* const fixed = std::find_if(kFixedTypes.begin(), kFixedTypes.end(),
                                         [&](const FixedType& f) { return f.name == type; });
  return fixed == kFixedTypes.end() || value.size() == fixed->bytes;
}

/// Goes through the attributes of headers, which lie one behind the other: name, type, size, value.
class HeaderWalk {
 public:
  explicit HeaderWalk(const InputFile& file) : file_(file) {}

  void run() {
    uint32_t version = 0;
    if (!take(kMagic.size(), version)) return;
    constexpr uint32_t kSeveralParts = 0x1000;
    do {
      if (!walk_header()) return;
    } while ((version & kSeveralParts) != 0 && !is_at_end_of_headers());
  }

 private:
  /// @return false where the file ends or a name is too long: that is OpenEXR's to tell
  bool walk_header() {
    for (;;) {
      std::string name, type;
      if (!take_text(name)) return false;
      if (name.empty()) return true;
      int32_t size = 0;
      if (!take_text(type) || !take(0, size)) return false;
      const uint64_t left = file_.size() - at_;
      if (size < 0 || static_cast<uint64_t>(size) > left) {
        fail(
            "{}: the attribute {} in its header is said to take {} bytes, but {} follow it; the "
            "file is damaged or was cut off, fetch or write it anew",
            file_.name(), printable(name), static_cast<uint32_t>(size), left);
      }
      std::vector<std::byte> value(static_cast<std::size_t>(size));
      file_.read(at_, value);
      if (!is_value(type, value)) {
        fail(
            "{}: the attribute {} in its header is no {} of {} bytes; the file is damaged, fetch "
            "or write it anew",
            file_.name(), printable(name), printable(type), size);
      }
      at_ += value.size();
    }
  }

  /// Of several parts: an empty header.
  bool is_at_end_of_headers() {
    uint8_t next = 0;
    const uint64_t before = at_;
    const bool ends = !take(0, next) || next == 0;
    if (!ends) at_ = before;
    return ends;
  }

  template <class T>
  bool take(uint64_t skipped, T& value) {
    at_ += skipped;
    std::array<std::byte, sizeof(T)> bytes{};
    if (file_.read(at_, bytes) < bytes.size()) return false;
    std::memcpy(&value, bytes.data(), sizeof(T));  // little-endian, as this machine
    at_ += sizeof(T);
    return true;
  }

  /// A text that ends in 0.
  bool take_text(std::string& text) {
    std::array<std::byte, 256> bytes{};
    const std::size_t count = file_.read(at_, bytes);
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    const auto* const end = static_cast<const char*>(std::memchr(begin, 0, count));
    if (end == nullptr) return false;
    text.assign(begin, end);
    at_ += text.size() + 1;
    return true;
  }

  const InputFile& file_;
  uint64_t at_ = 0;
};

}  // namespace

void check_exr_header(const InputFile& file) {
  std::array<uint8_t, kMagic.size()> magic{};
  file.read(0, std::as_writable_bytes(std::span(magic)));
  if (magic == kMagic) HeaderWalk(file).run();
}

}  // namespace freepath::io
