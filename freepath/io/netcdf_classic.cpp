#include "freepath/io/netcdf_classic.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"

namespace freepath::io {
namespace {

constexpr uint64_t kStreaming = std::numeric_limits<uint64_t>::max();

/// Walks through a header, of which only sizes and places are wanted: versions 1, 2 and 5 of the
/// NetCDF classic format specification.
class ClassicHeader {
 public:
  ClassicHeader(const VolumeFile& file, int version)
      : file_(file), cursor_(file, 4), version_(version) {}

  void check() {
    const uint64_t records = count_or_streaming();
    read_dimensions();
    skip_attributes();
    read_variables();
    // Where one variable alone has records, they are not padded.
    if (record_variables_ == 1) record_bytes_ = last_record_bytes_;
    for (const Variable& variable : variables_) {
      require(variable.begin, 0);
      if (!variable.records) {
        require(variable.begin, variable.bytes);
      } else if (records != kStreaming && records > 0) {
        const double before = static_cast<double>(records - 1) * static_cast<double>(record_bytes_);
        if (before > static_cast<double>(file_.size())) require(file_.size(), 1);
        require(variable.begin + (records - 1) * record_bytes_, variable.bytes);
      }
    }
  }

 private:
  struct Variable {
    uint64_t begin = 0;
    uint64_t bytes = 0;  ///< Of all, or of one record.
    bool records = false;
  };

  template <class T>
  T number() {
    auto bytes = cursor_.take<std::array<std::byte, sizeof(T)>>();
    if (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }
  uint64_t count() { return version_ == 5 ? number<uint64_t>() : number<uint32_t>(); }
  uint64_t count_or_streaming() {
    const uint64_t value = count();
    return version_ != 5 && value == std::numeric_limits<uint32_t>::max() ? kStreaming : value;
  }

  static uint64_t padded(uint64_t bytes) { return (bytes + 3) / 4 * 4; }
  /// Skips what is declared, which may be more than a number holds.
  void skip(uint64_t elements, uint64_t size) {
    require(cursor_.offset(), elements > file_.size() ? elements : elements * size);
    cursor_.skip(std::min(padded(elements * size), file_.size() - cursor_.offset()));
  }
  void require(uint64_t offset, uint64_t bytes) const { file_.require(offset, bytes); }

  /// Number of the elements of a list behind its tag.
  uint64_t list(uint32_t tag) {
    const auto found = number<uint32_t>();
    const uint64_t elements = count();
    if ((found != tag && found != 0) || (found == 0 && elements != 0) || elements > file_.size()) {
      file_.fail_damaged(fmt::format("its header has no list where one belongs, before byte {}",
                                     cursor_.offset()));
    }
    return elements;
  }

  void skip_name() { skip(count(), 1); }

  uint64_t type_size() {
    constexpr std::array<uint64_t, 12> kSizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const auto type = number<uint32_t>();
    if (type == 0 || type >= kSizes.size()) {
      file_.fail_damaged(fmt::format("type {} in its header", type));
    }
    return kSizes[type];
  }

  void read_dimensions() {
    constexpr uint32_t kDimensions = 10;
    for (uint64_t left = list(kDimensions); left > 0; --left) {
      skip_name();
      dimensions_.push_back(count());
    }
  }

  void skip_attributes() {
    constexpr uint32_t kAttributes = 12;
    for (uint64_t left = list(kAttributes); left > 0; --left) {
      skip_name();
      const uint64_t size = type_size();
      skip(count(), size);
    }
  }

  void read_variables() {
    constexpr uint32_t kVariables = 11;
    for (uint64_t left = list(kVariables); left > 0; --left) {
      skip_name();
      Variable variable;
      double values = 1;
      const uint64_t rank = count();
      for (uint64_t i = 0; i < rank; ++i) {
        const uint64_t dimension = count();
        if (dimension >= dimensions_.size()) {
          file_.fail_damaged(fmt::format("a variable along dimension {}", dimension));
        }
        const uint64_t length = dimensions_[dimension];
        if (length == 0 && i == 0) {
          variable.records = true;
        } else {
          values *= static_cast<double>(length);
        }
      }
      skip_attributes();
      const double bytes = values * static_cast<double>(type_size());
      count();  // the same once more, which is too small for large variables
      variable.begin = version_ == 1 ? number<uint32_t>() : number<uint64_t>();
      if (bytes > static_cast<double>(file_.size())) require(file_.size(), 1);
      variable.bytes = static_cast<uint64_t>(bytes);
      if (variable.records) {
        ++record_variables_;
        record_bytes_ += padded(variable.bytes);
        last_record_bytes_ = variable.bytes;
      }
      variables_.push_back(variable);
    }
  }

  const VolumeFile& file_;
  FileCursor cursor_;
  int version_;
  std::vector<uint64_t> dimensions_;
  std::vector<Variable> variables_;
  uint64_t record_bytes_ = 0, last_record_bytes_ = 0;
  int record_variables_ = 0;
};

}  // namespace

void check_netcdf_whole(const VolumeFile& file) {
  std::array<char, 4> mark{};
  if (file.size() < mark.size()) return;
  file.read(0, std::as_writable_bytes(std::span(mark)));
  if (std::string_view(mark.data(), 3) != "CDF") return;
  ClassicHeader(file, mark[3]).check();
}

}  // namespace freepath::io
