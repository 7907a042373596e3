#include "freepath/io/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"
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

/// Bytes of a pixel in a list of channels, of which each has a name that ends in 0 and 16 bytes:
/// its type, and behind four bytes in how many columns and rows it has one value. Behind the last
/// there is an empty name. Nothing if it is no such list.
std::optional<double> pixel_bytes(std::span<const std::byte> value) {
  constexpr std::size_t kBehindName = 16;
  constexpr int32_t kHalf = 1;
  double bytes = 0;
  for (std::size_t at = 0; at < value.size();) {
    const auto* const begin = value.data() + at;
    const void* const end = std::memchr(begin, 0, value.size() - at);
    if (end == nullptr) return std::nullopt;
    const auto length = static_cast<std::size_t>(static_cast<const std::byte*>(end) - begin);
    if (length == 0) return at + 1 == value.size() ? std::optional(bytes) : std::nullopt;
    at += length + 1;
    if (at + kBehindName > value.size()) return std::nullopt;
    const double columns = std::max(1, number_at(value, at + 8));
    const double rows = std::max(1, number_at(value, at + 12));
    bytes += (number_at(value, at) == kHalf ? 2 : 4) / (columns * rows);
    at += kBehindName;
  }
  return std::nullopt;
}

/// Rows that are packed together, by the number of a compression.
int rows_together(std::byte compression) {
  constexpr std::array kRows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  const auto number = std::to_integer<std::size_t>(compression);
  return number < kRows.size() ? kRows[number] : 1;
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
  if (type == "chlist") return pixel_bytes(value).has_value();
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
    constexpr uint32_t kDeep = 0x800;
    do {
      part_ = {};
      if (!walk_header()) return;
      if ((version & kDeep) == 0) check_size();  // of deep ones pixels have no size
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
      note(name, value);
      at_ += value.size();
    }
  }

  /// Keeps what tells how large the part is.
  void note(const std::string& name, std::span<const std::byte> value) {
    const auto number = [&](std::size_t i) { return double{1} * number_at(value, 4 * i); };
    if (name == "dataWindow" && value.size() == 16) {
      part_.width = number(2) - number(0) + 1;
      part_.height = number(3) - number(1) + 1;
    } else if (name == "channels") {
      part_.pixel = pixel_bytes(value).value_or(0);
    } else if (name == "compression" && value.size() == 1) {
      part_.rows = rows_together(value[0]);
    } else if (name == "tiles" && value.size() == 9) {
      const auto unsigned_number = [&](std::size_t i) {
        return double{1} * static_cast<uint32_t>(number_at(value, 4 * i));
      };
      part_.tile = unsigned_number(0) * unsigned_number(1);
    }
  }

  /// OpenEXR takes memory for all that is packed together as it opens a file.
  void check_size() const {
    if (!(part_.width >= 1 && part_.height >= 1)) return;  // OpenEXR's to tell
    const double bytes = part_.width * part_.height * part_.pixel;
    check_declared(file_.name(), fmt::format("{:.0f}x{:.0f} pixels", part_.width, part_.height),
                   bytes, file_.size());
    const double together = (part_.tile != 0 ? part_.tile : part_.rows * part_.width) * part_.pixel;
    constexpr double kMuch = 0x1p27;
    constexpr double kDeflate = 1032;  // to 1, at best
    if (together <= std::max(kMuch, kDeflate * static_cast<double>(file_.size()))) return;
    fail(
        "{}: its pixels are packed in parts that take {:.0f} MB each, out of {} bytes; the file is "
        "damaged, or has to be written with smaller tiles or a compression of single rows (zips)",
        file_.name(), together / 1e6, file_.size());
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
  /// Size of the part that a header tells of [pixels, bytes].
  struct {
    double width = 0, height = 0, pixel = 0, tile = 0;
    int rows = 1;
  } part_;
};

}  // namespace

void check_exr_header(const InputFile& file) {
  std::array<uint8_t, kMagic.size()> magic{};
  file.read(0, std::as_writable_bytes(std::span(magic)));
  if (magic == kMagic) HeaderWalk(file).run();
}

}  // namespace freepath::io
