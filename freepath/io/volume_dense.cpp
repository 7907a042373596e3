#include "freepath/io/volume_dense.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/gzip.h"
#include "freepath/base/memory_budget.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_text.h"

namespace freepath::io {
namespace {

constexpr int kSlab = BrickMap::kBrickSize;  // planes in work at a time

/// The numbers of a voxel that holds three densities, in the form that ValueChannels takes.
struct VoxelVector {
  using ValueType = double;
  std::array<double, kMaxGridChannels> values{};
  double operator[](int channel) const { return values[static_cast<std::size_t>(channel)]; }
  bool operator==(const VoxelVector& other) const = default;
};

/// The 512 voxels of a block, in the order of a brick; those outside of the grid are 0.
template <class T>
struct Block {
  std::array<T, kLeafVoxels> values{};
  std::array<uint64_t, 8> mask{};  ///< Voxels that are not 0.
  bool whole = false;              ///< No voxel of it lies outside.

  bool empty() const {
    return std::ranges::all_of(mask, [](uint64_t word) { return word == 0; });
  }
  /// Whether it is a tile: of one value, which isn't NaN.
  bool constant() const {
    return whole && std::ranges::all_of(values, [&](const T& value) { return value == values[0]; });
  }
};

/// Eight planes at a time of a grid.
template <class T>
class Slabs {
 public:
  static constexpr int kChannels = ValueChannels<T>::kCount;

  Slabs(const DenseGrid& grid, const GridInfo& head)
      : counts_(grid.counts), planes_(grid.open(head)) {
    plane_size_ = static_cast<std::size_t>(counts_.x) * static_cast<std::size_t>(counts_.y) *
                  static_cast<std::size_t>(kChannels);
    values_.resize(plane_size_ * static_cast<std::size_t>(std::min(kSlab, counts_.z)));
  }

  /// Reads the planes from `z` on, the next ones.
  void read(int z) {
    z_ = z;
    planes_in_ = std::min(kSlab, counts_.z - z);
    for (int i = 0; i < planes_in_; ++i) {
      planes_->next(
          std::span(values_).subspan(plane_size_ * static_cast<std::size_t>(i), plane_size_));
    }
  }

  void check_end() const { planes_->check_end(); }

  /// The block whose first voxel is given.
  Block<T> block(const Vec3i& origin) const {
    Block<T> block;
    block.whole =
        origin.x + kSlab <= counts_.x && origin.y + kSlab <= counts_.y && planes_in_ == kSlab;
    for (int offset = 0; offset < kLeafVoxels; ++offset) {
      const int x = origin.x + (offset >> 6), y = origin.y + (offset >> 3 & 7), z = offset & 7;
      if (x >= counts_.x || y >= counts_.y || z >= planes_in_) continue;
      const T value = voxel(x, y, z);
      block.values[static_cast<std::size_t>(offset)] = value;
      if (!(value == T{})) {
        block.mask[static_cast<std::size_t>(offset >> 6)] |= uint64_t{1} << (offset & 63);
      }
    }
    return block;
  }

  /// First voxels of all blocks of the slab, in order.
  std::vector<Vec3i> blocks() const {
    std::vector<Vec3i> origins;
    for (int y = 0; y < counts_.y; y += kSlab) {
      for (int x = 0; x < counts_.x; x += kSlab) origins.emplace_back(x, y, z_);
    }
    return origins;
  }

 private:
  T voxel(int x, int y, int plane) const {
    const double* const first = values_.data() + plane_size_ * static_cast<std::size_t>(plane) +
                                (static_cast<std::size_t>(y) * static_cast<std::size_t>(counts_.x) +
                                 static_cast<std::size_t>(x)) *
                                    static_cast<std::size_t>(kChannels);
    if constexpr (kChannels == 1) {
      return *first;
    } else {
      return {{first[0], first[1], first[2]}};
    }
  }

  Vec3i counts_;
  PlaneSourcePointer planes_;
  std::size_t plane_size_ = 0;
  std::vector<double> values_;
  int z_ = 0, planes_in_ = 0;
};

/// Finds tiles and leaves, slab by slab.
template <class T>
GridLayout find_layout(const DenseGrid& grid, const GridInfo& head, std::vector<Vec3i>& leaves) {
  GridLayout layout(Slabs<T>::kChannels);
  layout.set_background(T{});
  Slabs<T> slabs(grid, head);
  for (int z = 0; z < grid.counts.z; z += kSlab) {
    slabs.read(z);
    const std::vector<Vec3i> blocks = slabs.blocks();
    enum class Kind : uint8_t { kEmpty, kTile, kLeaf };
    std::vector<Kind> kinds(blocks.size());
    std::vector<T> values(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
      const Block<T> block = slabs.block(blocks[i]);
      kinds[i] = block.empty() ? Kind::kEmpty : block.constant() ? Kind::kTile : Kind::kLeaf;
      values[i] = block.values[0];
    });
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (kinds[i] == Kind::kTile) layout.add_tile(blocks[i], kSlab, values[i], true);
      if (kinds[i] != Kind::kLeaf) continue;
      layout.add_leaf(blocks[i]);
      leaves.push_back(blocks[i]);
    }
  }
  slabs.check_end();
  return layout;
}

template <class T>
AssembledGrid read_dense(const VolumeFile& file, const DenseGrid& grid, const GridInfo& head,
                         const LoadOptions& options, bool keep_values) {
  std::vector<Vec3i> leaves;
  AssembledGrid result;
  GridLayout layout = find_layout<T>(grid, head, leaves);
  result.assembly = std::make_unique<GridAssembly>(file.name(), head.name, options,
                                                   std::move(layout), keep_values);
  Slabs<T> slabs(grid, head);
  std::size_t leaf = 0;
  for (int z = 0; z < grid.counts.z && leaf < leaves.size(); z += kSlab) {
    slabs.read(z);
    const std::size_t first = leaf;
    while (leaf < leaves.size() && leaves[leaf].z == z) ++leaf;
    result.scan.merge(tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(first, leaf), GridScan{},
        [&](const tbb::blocked_range<std::size_t>& range, GridScan scan) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const Block<T> block = slabs.block(leaves[i]);
            result.assembly->take_leaf(i, block.values.data(), block.mask.data(), scan);
          }
          return scan;
        },
        [](GridScan a, const GridScan& b) {
          a.merge(b);
          return a;
        }));
  }
  return result;
}

class DenseReader : public VolumeReader {
 public:
  DenseReader(const VolumeFile& file, std::vector<DenseGrid> grids)
      : file_(file), grids_(std::move(grids)) {
    std::vector<GridInfo> infos;
    infos.reserve(grids_.size());
    for (DenseGrid& grid : grids_) {
      GridInfo& info = grid.info;
      info.index = static_cast<int>(infos.size());
      if (info.reason.empty()) info.reason = reason_against_transform(info.index_to_world);
      info.loadable = info.reason.empty();
      infos.push_back(std::move(info));
    }
    make_names_unique(infos);
    heads_ = std::move(infos);
  }

  std::vector<GridInfo> heads() const override { return heads_; }

  bool is_readable(const GridInfo& head) const override {
    return grid_of(head).open != nullptr && head.loadable;
  }

  AssembledGrid read(const GridInfo& head, const LoadOptions& options,
                     bool keep_values) const override {
    const DenseGrid& grid = grid_of(head);
    return head.channels == 1 ? read_dense<double>(file_, grid, head, options, keep_values)
                              : read_dense<VoxelVector>(file_, grid, head, options, keep_values);
  }

  void finish(const GridInfo& head, std::vector<LoadedField>& fields) const override {
    const std::string& note = grid_of(head).note;
    if (!note.empty()) {
      fields.front().warnings.push_back(
          fmt::format("{}: {}", grid_label(file_.name(), head.name), note));
    }
    if (head.times > 1 && !head.time_chosen) {
      fields.front().warnings.push_back(
          fmt::format("{}: it has {} times; the first is read, and --grid {}@1 takes the next",
                      grid_label(file_.name(), head.name), head.times, head.name));
    }
  }

 private:
  const DenseGrid& grid_of(const GridInfo& head) const {
    return grids_[static_cast<std::size_t>(head.index)];
  }

  const VolumeFile& file_;
  std::vector<DenseGrid> grids_;
  std::vector<GridInfo> heads_;
};

class NumberPlanes : public PlaneSource {
 public:
  NumberPlanes(ByteSourcePointer bytes, const StoredNumbers& numbers)
      : bytes_(std::move(bytes)), numbers_(numbers) {}

  void next(std::span<double> values) override {
    stored_.resize(values.size() * size_of(numbers_.type));
    bytes_->read(stored_);
    decode_numbers(numbers_.type, numbers_.order, stored_, values);
    if (numbers_.slope == 1 && numbers_.intercept == 0) return;
    for (double& value : values) value = numbers_.slope * value + numbers_.intercept;
  }

  void check_end() override { bytes_->check_end(); }

 private:
  ByteSourcePointer bytes_;
  StoredNumbers numbers_;
  std::vector<std::byte> stored_;
};

class TextPlanes : public PlaneSource {
 public:
  explicit TextPlanes(ByteSourcePointer text) : text_(std::move(text)), window_(kTextWindow) {}

  void next(std::span<double> values) override {
    for (double& value : values) value = next_number();
  }

 private:
  static constexpr std::size_t kTextWindow = std::size_t{1} << 16;
  static constexpr std::size_t kLongestNumber = 64;

  static bool is_between(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ',';
  }

  /// The next character; 0 at the end.
  char peek() {
    if (offset_ == size_) {
      size_ = text_->read_some(std::as_writable_bytes(std::span(window_)));
      offset_ = 0;
      if (size_ == 0) return 0;
    }
    return window_[offset_];
  }

  double next_number() {
    while (is_between(peek())) ++offset_;
    word_.clear();
    for (char c = peek(); c != 0 && !is_between(c) && word_.size() < kLongestNumber; c = peek()) {
      word_ += c;
      ++offset_;
    }
    const std::optional<double> number = number_of(word_);
    if (word_.empty()) text_->file().fail_damaged("its values end too soon");
    if (!number) {
      text_->file().fail_damaged(fmt::format("'{}' among its values is no number", excerpt(word_)));
    }
    return *number;
  }

  ByteSourcePointer text_;
  std::vector<char> window_;
  std::size_t offset_ = 0, size_ = 0;
  std::string word_;
};

}  // namespace

VolumeReaderPointer make_dense_reader(const VolumeFile& file, std::vector<DenseGrid> grids) {
  return std::make_unique<DenseReader>(file, std::move(grids));
}

VolumeReaderPointer make_dense_reader(const VolumeFile& file, DenseGrid grid) {
  std::vector<DenseGrid> grids;
  grids.push_back(std::move(grid));
  return make_dense_reader(file, std::move(grids));
}

void set_voxel_type(std::optional<NumberType> type, std::string_view type_name, int components,
                    DenseGrid& grid) {
  GridInfo& info = grid.info;
  info.type = type ? name_of(*type) : type_name;
  if (components == kMaxGridChannels && type == NumberType::kFloat) {
    info.type = "vec3s";
  } else if (components == kMaxGridChannels && type == NumberType::kDouble) {
    info.type = "vec3d";
  } else if (components != 1) {
    info.type += fmt::format(" x {}", components);
  }
  const bool known = type && (components == 1 || components == kMaxGridChannels);
  if (!known) {
    info.reason = reason_against_type(info.type);
    grid.open = nullptr;
    return;
  }
  info.channels = components;
}

Vec3i checked_counts(const VolumeFile& file, std::string_view what, std::span<const double> sizes) {
  constexpr double kMost = 1 << 24;
  Vec3i counts;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = sizes[static_cast<std::size_t>(axis)];
    if (!(size >= 1 && size <= kMost) || size != std::floor(size)) {
      fail("{}: {} {} of voxels along {} is not a whole number from 1 to {}; correct its header",
           file.name(), what, size, "xyz"[axis], kMost);
    }
    counts[axis] = static_cast<int>(size);
  }
  return counts;
}

void check_dense_size(const VolumeFile& file, const Vec3i& counts, std::size_t voxel_bytes,
                      DensePacking packing) {
  const double voxels =
      static_cast<double>(counts.x) * static_cast<double>(counts.y) * static_cast<double>(counts.z);
  const double bytes = voxels * static_cast<double>(voxel_bytes);
  const auto size = static_cast<double>(file.size());
  const std::string what = fmt::format("{} x {} x {} voxels", counts.x, counts.y, counts.z);
  const bool fits = packing == DensePacking::kNone   ? bytes <= size
                    : packing == DensePacking::kText ? 2 * voxels <= size + 1
                    : packing == DensePacking::kDeflate
                        ? bytes <= static_cast<double>(GzipReader::kLargestRatio) * size
                        : true;
  if (!fits) {
    file.fail_damaged(fmt::format("it declares {}, but has only {} bytes", what, file.size()));
  }
  check_declared(file.name(), what, bytes, file.size());
  check_memory_present(file.name(), fmt::format("eight planes of its {}", what),
                       static_cast<double>(counts.x) * static_cast<double>(counts.y) * kSlab *
                           kMaxGridChannels * sizeof(double));
}

uint64_t dense_bytes(const Vec3i& counts, std::size_t voxel_bytes) {
  return static_cast<uint64_t>(counts.x) * static_cast<uint64_t>(counts.y) *
         static_cast<uint64_t>(counts.z) * voxel_bytes;
}

PlaneSourcePointer number_planes(ByteSourcePointer bytes, const StoredNumbers& numbers) {
  return std::make_unique<NumberPlanes>(std::move(bytes), numbers);
}

PlaneSourcePointer text_planes(ByteSourcePointer text) {
  return std::make_unique<TextPlanes>(std::move(text));
}

PlaneSourcePointer file_planes(const VolumeFile& file, uint64_t begin, DensePacking packing,
                               const StoredNumbers& numbers) {
  if (packing == DensePacking::kText) return text_planes(file_bytes(file, begin));
  const bool packed = packing == DensePacking::kDeflate;
  return number_planes(packed ? gzip_bytes(file, begin) : file_bytes(file, begin), numbers);
}

}  // namespace freepath::io
