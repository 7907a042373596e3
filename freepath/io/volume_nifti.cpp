// Reads NIfTI-1 and NIfTI-2 files of one part (.nii), packed by gzip or not.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/volume_dense.h"

namespace freepath::io {
namespace {

constexpr std::size_t kNifti1Header = 348, kNifti2Header = 540;

/// Where the fields of a header stand [bytes], which differs between the versions.
struct NiftiOffsets {
  std::size_t magic, dim, datatype, bitpix, pixdim, vox_offset, slope, qform, sform, quatern,
      qoffset, rows, units;
};
constexpr NiftiOffsets kNifti1{344, 40, 70, 72, 76, 108, 112, 252, 254, 256, 268, 280, 123};
constexpr NiftiOffsets kNifti2{4, 16, 12, 14, 104, 168, 176, 344, 348, 352, 376, 400, 500};

/// A header, of which numbers are taken in the order of its bytes.
class NiftiHeader {
 public:
  NiftiHeader(const VolumeFile& file, std::vector<std::byte> bytes)
      : file_(file), bytes_(std::move(bytes)) {
    const auto first = [&](std::endian order) {
      return number<int32_t>(0, order) == static_cast<int32_t>(bytes_.size());
    };
    order_ = first(std::endian::little) ? std::endian::little : std::endian::big;
    if (!first(order_)) file.fail_damaged("the size of its header is neither 348 nor 540");
    const std::string_view magic(reinterpret_cast<const char*>(bytes_.data()) + offsets().magic, 4);
    if (magic == std::string_view("ni1\0", 4) || magic == std::string_view("ni2\0", 4)) {
      fail("{}: its values stand in another file (.img); write both as one (.nii)", file.name());
    }
    if (magic.substr(1) != std::string_view("+1\0", 3) &&
        magic.substr(1) != std::string_view("+2\0", 3)) {
      file.fail_damaged("the mark of NIfTI is not in its header");
    }
  }

  const VolumeFile& file() const { return file_; }
  bool second() const { return bytes_.size() == kNifti2Header; }
  const NiftiOffsets& offsets() const { return second() ? kNifti2 : kNifti1; }
  std::endian order() const { return order_; }

  /// A whole number of 16 bits in the first version, of 64 or 32 in the second.
  int64_t dim(std::size_t i) const {
    return second() ? number<int64_t>(offsets().dim + 8 * i)
                    : number<int16_t>(offsets().dim + 2 * i);
  }
  int code(std::size_t offset) const {
    return second() ? number<int32_t>(offset) : number<int16_t>(offset);
  }
  int datatype() const { return number<int16_t>(offsets().datatype); }
  int bitpix() const { return number<int16_t>(offsets().bitpix); }
  int units() const {
    return second() ? number<int32_t>(offsets().units)
                    : std::to_integer<int>(bytes_[offsets().units]);
  }
  /// Number i of a row of reals, of 32 bits in the first version, of 64 in the second.
  double real(std::size_t offset, std::size_t i = 0) const {
    return second() ? number<double>(offset + 8 * i)
                    : static_cast<double>(number<float>(offset + 4 * i));
  }
  /// The same where it must be finite. @throws Error that names the field
  double finite(std::string_view what, std::size_t offset, std::size_t i = 0) const {
    const double value = real(offset, i);
    if (!std::isfinite(value)) {
      fail("{}: {} in its header is {}; correct it", file_.name(), what, value);
    }
    return value;
  }
  /// Where the values begin.
  double begin() const {
    return second() ? static_cast<double>(number<int64_t>(offsets().vox_offset))
                    : static_cast<double>(number<float>(offsets().vox_offset));
  }

 private:
  template <class T>
  T number(std::size_t offset, std::endian order) const {
    std::array<std::byte, sizeof(T)> stored;
    std::memcpy(stored.data(), bytes_.data() + offset, sizeof(T));
    if (order != std::endian::native) std::reverse(stored.begin(), stored.end());
    return std::bit_cast<T>(stored);
  }
  template <class T>
  T number(std::size_t offset) const {
    return number<T>(offset, order_);
  }

  const VolumeFile& file_;
  std::vector<std::byte> bytes_;
  std::endian order_ = std::endian::little;
};

ByteSourcePointer nifti_bytes(const VolumeFile& file, bool packed, uint64_t begin) {
  if (!packed) return file_bytes(file, begin);
  ByteSourcePointer bytes = gzip_bytes(file, 0);
  std::array<std::byte, 4096> skipped;
  for (uint64_t left = begin; left > 0;) {
    const auto part = std::span(skipped).first(std::min<uint64_t>(left, skipped.size()));
    bytes->read(part);
    left -= part.size();
  }
  return bytes;
}

NiftiHeader read_nifti_header(const VolumeFile& file, bool packed) {
  const ByteSourcePointer bytes = nifti_bytes(file, packed, 0);
  std::vector<std::byte> header(kNifti2Header);
  header.resize(bytes->read_some(header));
  if (header.size() < kNifti1Header) file.fail_damaged("it ends within its header");
  const int first = std::to_integer<int>(header[0]), last = std::to_integer<int>(header[3]);
  // 348 is 0x15C, 540 is 0x21C: told apart by their low bytes in either order and the next.
  const bool little = first == 0x5C || first == 0x1C;
  if (packed && !little && last != 0x5C && last != 0x1C) {
    fail("{}: gzip has packed something else than NIfTI in it; unpack it first (gunzip)",
         file.name());
  }
  const bool second = (little ? first : last) == 0x1C;
  if (second && header.size() < kNifti2Header) file.fail_damaged("it ends within its header");
  header.resize(second ? kNifti2Header : kNifti1Header);
  return {file, std::move(header)};
}

std::optional<NumberType> nifti_number_type(int code) {
  constexpr std::pair<int, NumberType> kTypes[] = {
      {2, NumberType::kUint8},    {4, NumberType::kInt16},    {8, NumberType::kInt32},
      {16, NumberType::kFloat},   {64, NumberType::kDouble},  {256, NumberType::kInt8},
      {512, NumberType::kUint16}, {768, NumberType::kUint32}, {1024, NumberType::kInt64},
      {1280, NumberType::kUint64}};
  for (const auto& [number, type] : kTypes) {
    if (number == code) return type;
  }
  return std::nullopt;
}

/// Positions of voxel centres by a rotation, as a quaternion without its first number.
Matrix4d nifti_qform(const NiftiHeader& header) {
  const NiftiOffsets& offsets = header.offsets();
  const double b = header.finite("quatern_b", offsets.quatern, 0);
  const double c = header.finite("quatern_c", offsets.quatern, 1);
  const double d = header.finite("quatern_d", offsets.quatern, 2);
  const double square = b * b + c * c + d * d;
  constexpr double kRounding = 1e-4;
  if (square > 1 + kRounding) {
    fail(
        "{}: its qform is no rotation: its quaternion has the length {:.6g}; correct it, or give "
        "it an sform",
        header.file().name(), std::sqrt(square));
  }
  const double a = std::sqrt(std::max(0.0, 1 - square));
  const double rotation[3][3] = {
      {a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
      {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
      {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}};
  const double handed = header.finite("pixdim[0]", offsets.pixdim, 0) < 0 ? -1 : 1;
  Matrix4d matrix;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double step = header.finite("pixdim", offsets.pixdim, 1 + i) * (axis == 2 ? handed : 1);
    for (int k = 0; k < 3; ++k) matrix[axis][k] = rotation[k][axis] * step;
    matrix[3][axis] = header.finite("qoffset", offsets.qoffset, i);
  }
  return matrix;
}

Matrix4d nifti_transform(const NiftiHeader& header) {
  const NiftiOffsets& offsets = header.offsets();
  Matrix4d matrix;
  if (header.code(offsets.sform) > 0) {
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 4; ++axis) {
        matrix[axis][k] = header.finite(
            "srow", offsets.rows, 4 * static_cast<std::size_t>(k) + static_cast<std::size_t>(axis));
      }
    }
  } else if (header.code(offsets.qform) > 0) {
    return nifti_qform(header);
  } else {
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      matrix[axis][axis] = header.finite("pixdim", offsets.pixdim, 1 + i);
    }
  }
  return matrix;
}

std::string nifti_length_unit(const NiftiHeader& header) {
  switch (header.units() & 7) {
    case 1:
      return "m";
    case 2:
      return "mm";
    case 3:
      return "um";
    default:
      return {};
  }
}

/// Sets the numbers of voxels and of times.
void read_nifti_dimensions(const NiftiHeader& header, DenseGrid& grid) {
  const VolumeFile& file = header.file();
  const int64_t rank = header.dim(0);
  if (rank < 3 || rank > 7) {
    fail("{}: it has {} dimensions; volumes have 3, or 4 with time", file.name(), rank);
  }
  std::array<double, 3> sizes{};
  for (std::size_t i = 0; i < 3; ++i) sizes[i] = static_cast<double>(header.dim(i + 1));
  grid.counts = checked_counts(file, "dim with", sizes);
  for (std::size_t i = 5; i <= static_cast<std::size_t>(rank); ++i) {
    if (header.dim(i) > 1) {
      fail("{}: its dimension {} has {} values, so that voxels hold several; write them apart",
           file.name(), i, header.dim(i));
    }
  }
  const int64_t times = rank >= 4 ? header.dim(4) : 1;
  constexpr int64_t kMostTimes = 1 << 24;
  if (times < 1 || times > kMostTimes) {
    fail("{}: it has {} times; correct its header", file.name(), times);
  }
  grid.info.times = static_cast<int>(times);
}

}  // namespace

bool is_nifti(const VolumeFile& file) {
  const auto has = [&](std::size_t offset, std::string_view mark) {
    std::string found(mark.size(), '\0');
    if (file.size() < offset + mark.size()) return false;
    file.read(offset, std::as_writable_bytes(std::span(found)));
    return found == mark;
  };
  const bool sized =
      has(0, std::string_view("\x5C\x01\0\0", 4)) || has(0, std::string_view("\0\0\x01\x5C", 4));
  return (sized && (has(kNifti1.magic, "n+1") || has(kNifti1.magic, "ni1"))) ||
         has(kNifti2.magic, "n+2") || has(kNifti2.magic, "ni2");
}

VolumeReaderPointer open_nifti(const VolumeFile& file, bool packed) {
  const NiftiHeader header = read_nifti_header(file, packed);
  DenseGrid grid;
  grid.info.name = "density";
  grid.info.grid_class = "samples";
  read_nifti_dimensions(header, grid);
  const std::optional<NumberType> type = nifti_number_type(header.datatype());
  set_voxel_type(type, fmt::format("of NIfTI's code {}", header.datatype()), 1, grid);
  if (!grid.info.reason.empty()) fail("{}: {}", file.name(), grid.info.reason);
  const std::size_t voxel_bytes = size_of(*type);
  if (header.bitpix() != static_cast<int>(8 * voxel_bytes)) {
    file.fail_damaged(fmt::format("bitpix is {}, and a voxel of type {} has {}", header.bitpix(),
                                  grid.info.type, 8 * voxel_bytes));
  }
  grid.info.index_to_world = nifti_transform(header);
  grid.info.length_unit = nifti_length_unit(header);
  StoredNumbers numbers{*type, header.order()};
  const double slope = header.finite("scl_slope", header.offsets().slope, 0);
  if (slope != 0) {  // 0: values are as they are stored
    numbers.slope = slope;
    numbers.intercept = header.finite("scl_inter", header.offsets().slope, 1);
  }
  const double begin = header.begin();
  const auto least = static_cast<double>(header.second() ? kNifti2Header : kNifti1Header);
  constexpr double kMost = 1e15;
  if (!(begin >= least && begin <= kMost) || begin != std::floor(begin)) {
    file.fail_damaged(fmt::format("vox_offset is {}", begin));
  }
  check_dense_size(file, grid.counts, voxel_bytes,
                   packed ? DensePacking::kDeflate : DensePacking::kNone);
  const uint64_t bytes = dense_bytes(grid.counts, voxel_bytes);
  const auto first = static_cast<uint64_t>(begin);
  const auto times = static_cast<uint64_t>(grid.info.times);
  if (!packed) {
    file.require(first, bytes);
    if (times > (file.size() - first) / bytes) {
      file.fail_damaged(fmt::format("it ends before the last of its {} times", times));
    }
  }
  grid.info.stored_bytes = packed ? file.size() : bytes;
  grid.open = [&file, packed, first, bytes, numbers](const GridInfo& head) {
    const uint64_t offset = first + static_cast<uint64_t>(head.time) * bytes;
    return number_planes(nifti_bytes(file, packed, offset), numbers);
  };
  return make_dense_reader(file, std::move(grid));
}

}  // namespace freepath::io
