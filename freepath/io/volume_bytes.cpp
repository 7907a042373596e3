#include "freepath/io/volume_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/gzip.h"
#include "freepath/base/memory_budget.h"

namespace freepath::io {
namespace {

constexpr std::size_t kByteWindow = std::size_t{1} << 16;

class FileBytes : public ByteSource {
 public:
  FileBytes(const VolumeFile& file, uint64_t begin, uint64_t end)
      : ByteSource(file), next_(begin), end_(std::min(end, file.size())) {
    if (begin > file.size()) file.require(begin, 0);
  }

  std::size_t read_some(std::span<std::byte> bytes) override {
    const auto count = std::min<uint64_t>(bytes.size(), end_ - std::min(next_, end_));
    file().read(next_, bytes.first(count));
    next_ += count;
    return count;
  }

 private:
  uint64_t next_, end_;
};

class MemoryBytes : public ByteSource {
 public:
  MemoryBytes(const VolumeFile& file, std::string_view bytes) : ByteSource(file), left_(bytes) {}

  std::size_t read_some(std::span<std::byte> bytes) override {
    const std::size_t count = std::min(bytes.size(), left_.size());
    std::copy_n(reinterpret_cast<const std::byte*>(left_.data()), count, bytes.begin());
    left_.remove_prefix(count);
    return count;
  }

 private:
  std::string_view left_;
};

/// Numbers of the characters of base64; others, blanks and padding are told apart.
constexpr int kNoCharacter = -1, kBlank = -2, kPadding = -3;

constexpr std::array<int, 256> base64_numbers() {
  std::array<int, 256> numbers{};
  numbers.fill(kNoCharacter);
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
    numbers[static_cast<uint8_t>(kAlphabet[i])] = static_cast<int>(i);
  }
  for (const char c : {' ', '\t', '\n', '\r'}) numbers[static_cast<uint8_t>(c)] = kBlank;
  numbers['='] = kPadding;
  return numbers;
}

class Base64Bytes : public ByteSource {
 public:
  explicit Base64Bytes(ByteSourcePointer text)
      : ByteSource(text->file()), text_(std::move(text)), window_(kByteWindow) {}

  std::size_t read_some(std::span<std::byte> bytes) override {
    std::size_t done = 0;
    while (done < bytes.size()) {
      if (first_ == last_ && !decode_group()) break;
      bytes[done++] = decoded_[first_++];
    }
    return done;
  }

 private:
  /// The number of the next character that is no blank; kNoCharacter at the end.
  int next_character() {
    static constexpr std::array<int, 256> kNumbers = base64_numbers();
    while (true) {
      if (offset_ == size_) {
        size_ = text_->read_some(window_);
        offset_ = 0;
        if (size_ == 0) return kNoCharacter;
      }
      const int number = kNumbers[static_cast<uint8_t>(window_[offset_])];
      if (number == kNoCharacter) return number;  // stays there
      ++offset_;
      if (number != kBlank) return number;
    }
  }

  /// Decodes four characters. @return false at the end
  bool decode_group() {
    uint32_t bits = 0;
    std::size_t padding = 0;
    for (int i = 0; i < 4; ++i) {
      const int number = next_character();
      if (number == kNoCharacter && i == 0) return false;
      if (number == kNoCharacter || (number != kPadding && padding > 0) ||
          (number == kPadding && i < 2)) {
        file().fail_damaged("its base64 characters don't come in fours");
      }
      if (number == kPadding) ++padding;
      bits = bits << 6U | (number == kPadding ? 0U : static_cast<uint32_t>(number));
    }
    for (std::size_t i = 0; i < 3; ++i) decoded_[i] = static_cast<std::byte>(bits >> (16 - 8 * i));
    first_ = 0;
    last_ = 3 - padding;
    return true;
  }

  ByteSourcePointer text_;
  std::vector<std::byte> window_;
  std::size_t offset_ = 0, size_ = 0;  // in the window
  std::array<std::byte, 3> decoded_{};
  std::size_t first_ = 0, last_ = 0;  // of those decoded
};

class GzipBytes : public ByteSource {
 public:
  GzipBytes(const VolumeFile& file, uint64_t begin, uint64_t end)
      : ByteSource(file), packed_(packed_bytes(file, begin, end)), reader_(packed_) {}

  std::size_t read_some(std::span<std::byte> bytes) override {
    std::size_t done = 0;
    while (done < bytes.size()) {
      if (offset_ == unpacked_.size() && !unpack_more()) break;
      const std::size_t count = std::min(bytes.size() - done, unpacked_.size() - offset_);
      std::copy_n(reinterpret_cast<const std::byte*>(unpacked_.data()) + offset_, count,
                  bytes.begin() + static_cast<std::ptrdiff_t>(done));
      offset_ += count;
      done += count;
    }
    return done;
  }

  void check_end() override {
    if (offset_ == unpacked_.size()) unpack_more();
  }

 private:
  static std::string packed_bytes(const VolumeFile& file, uint64_t begin, uint64_t end) {
    end = std::min(end, file.size());
    if (begin >= end) file.fail_damaged("its packed values are missing");
    check_memory_present(file.name(), "its packed values", static_cast<double>(end - begin));
    std::string packed(end - begin, '\0');
    file.read(begin, std::as_writable_bytes(std::span(packed)));
    return packed;
  }

  bool unpack_more() {
    unpacked_.clear();
    offset_ = 0;
    try {
      while (unpacked_.empty()) {
        if (!reader_.append_to(unpacked_)) return false;
      }
    } catch (const Error& error) {
      file().fail_damaged(error.what());
    }
    return true;
  }

  std::string packed_;
  GzipReader reader_;
  std::string unpacked_;
  std::size_t offset_ = 0;  // in what is unpacked
};

uint64_t take_word(ByteSource& stored, std::size_t word, std::endian order) {
  std::array<std::byte, 8> bytes{};
  const auto used = std::span(bytes).first(word);
  stored.read(used);
  if (order != std::endian::little) std::reverse(used.begin(), used.end());
  uint64_t value = 0;
  for (std::size_t i = word; i-- > 0;) value = value << 8U | std::to_integer<uint64_t>(bytes[i]);
  return value;
}

/// Blocks that zlib has packed, each by itself.
class ZlibBlocks : public ByteSource {
 public:
  ZlibBlocks(ByteSourcePointer stored, std::size_t word, std::endian order, uint64_t bytes)
      : ByteSource(stored->file()), stored_(std::move(stored)) {
    const uint64_t count = take_word(*stored_, word, order);
    block_ = take_word(*stored_, word, order);
    const uint64_t partial = take_word(*stored_, word, order);
    const uint64_t last = partial == 0 ? block_ : partial;
    // Whole blocks and the last make the array; products may overflow, hence the quotient.
    if (count == 0 || block_ == 0 || last > block_ || last > bytes || block_ > UINT32_MAX ||
        (bytes - last) % block_ != 0 || (bytes - last) / block_ != count - 1) {
      file().fail_damaged(
          fmt::format("an array in {} blocks of {} bytes, the last of {}, where {} bytes belong",
                      count, block_, last, bytes));
    }
    last_ = last;
    for (uint64_t i = 0; i < count; ++i) {  // grows with what the file delivers
      packed_sizes_.push_back(take_word(*stored_, word, order));
    }
  }

  std::size_t read_some(std::span<std::byte> bytes) override {
    std::size_t done = 0;
    while (done < bytes.size()) {
      if (offset_ == unpacked_.size() && !unpack_block()) break;
      const std::size_t count = std::min(bytes.size() - done, unpacked_.size() - offset_);
      std::copy_n(unpacked_.begin() + static_cast<std::ptrdiff_t>(offset_), count,
                  bytes.begin() + static_cast<std::ptrdiff_t>(done));
      offset_ += count;
      done += count;
    }
    return done;
  }

 private:
  bool unpack_block() {
    if (next_ == packed_sizes_.size()) return false;
    const uint64_t size = next_ + 1 == packed_sizes_.size() ? last_ : block_;
    const uint64_t packed_size = packed_sizes_[next_++];
    if (packed_size > file().size()) {
      file().fail_damaged(fmt::format("a packed block of {} bytes", packed_size));
    }
    packed_.resize(packed_size);
    stored_->read(packed_);
    unpacked_.resize(size);
    offset_ = 0;
    uLongf unpacked_size = size;
    const int status = uncompress(reinterpret_cast<Bytef*>(unpacked_.data()), &unpacked_size,
                                  reinterpret_cast<const Bytef*>(packed_.data()), packed_.size());
    if (status != Z_OK || unpacked_size != size) {
      file().fail_damaged(fmt::format("block {} of an array can't be unpacked by zlib", next_ - 1));
    }
    return true;
  }

  ByteSourcePointer stored_;
  uint64_t block_ = 0, last_ = 0;  // bytes
  std::vector<uint64_t> packed_sizes_;
  std::size_t next_ = 0;  // block
  std::vector<std::byte> packed_, unpacked_;
  std::size_t offset_ = 0;  // in what is unpacked
};

}  // namespace

void ByteSource::read(std::span<std::byte> bytes) {
  const std::size_t count = read_some(bytes);
  if (count < bytes.size()) {
    file().fail_damaged(
        fmt::format("its values end {} bytes too soon or earlier", bytes.size() - count));
  }
}

ByteSourcePointer file_bytes(const VolumeFile& file, uint64_t begin, uint64_t end) {
  return std::make_unique<FileBytes>(file, begin, end);
}

ByteSourcePointer memory_bytes(const VolumeFile& file, std::string_view bytes) {
  return std::make_unique<MemoryBytes>(file, bytes);
}

ByteSourcePointer base64_bytes(ByteSourcePointer text) {
  return std::make_unique<Base64Bytes>(std::move(text));
}

ByteSourcePointer gzip_bytes(const VolumeFile& file, uint64_t begin, uint64_t end) {
  return std::make_unique<GzipBytes>(file, begin, end);
}

ByteSourcePointer vtk_array_bytes(ByteSourcePointer stored, bool packed, std::size_t word,
                                  std::endian order, uint64_t bytes) {
  if (packed) return std::make_unique<ZlibBlocks>(std::move(stored), word, order, bytes);
  const uint64_t declared = take_word(*stored, word, order);
  if (declared != bytes) {
    stored->file().fail_damaged(fmt::format(
        "an array of {} bytes, where its type and the extents make {}", declared, bytes));
  }
  return stored;
}

}  // namespace freepath::io
