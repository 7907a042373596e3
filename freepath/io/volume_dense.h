#pragma once
/// @file Volume files that hold a value for every voxel of a box, in planes of z: what the readers
/// of such formats share. A reader says what its header tells of each grid, and how to open the
/// values; planes are read twice, first for where voxels are 0 or constant, then for the rest.

#include <bit>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/io/volume_bytes.h"
#include "freepath/io/volume_formats.h"
#include "freepath/io/volume_numbers.h"

namespace freepath::io {

/// The planes of a grid, from the first to the last.
class PlaneSource {
 public:
  PlaneSource() = default;
  PlaneSource(const PlaneSource&) = delete;
  PlaneSource& operator=(const PlaneSource&) = delete;
  virtual ~PlaneSource() = default;

  /// Reads the next plane.
  /// @param values those of a voxel together, voxels x fastest
  /// @throws Error if they end before or are damaged
  virtual void next(std::span<double> values) = 0;

  /// Looks whether they were whole, behind the last.
  /// @throws Error if it turns out that they are damaged
  virtual void check_end() {}
};

using PlaneSourcePointer = std::unique_ptr<PlaneSource>;

/// A grid as a header has it.
struct DenseGrid {
  GridInfo info;     ///< Name, type, transform of indices that begin with 0, channels, bytes.
  Vec3i counts{0};   ///< Voxels along each axis.
  std::string note;  ///< A warning for those who load it; empty: none.
  /// Begins anew with the values of a grid: its info, with the time that was chosen. Empty where
  /// the type isn't known.
  std::function<PlaneSourcePointer(const GridInfo& head)> open{};
};

/// A reader of such grids. Voxels that are 0 are inactive, all others active.
/// @param file must outlive it
VolumeReaderPointer make_dense_reader(const VolumeFile& file, std::vector<DenseGrid> grids);
/// A reader of one grid.
VolumeReaderPointer make_dense_reader(const VolumeFile& file, DenseGrid grid);

/// Completes a grid: sets channels and type from the numbers in a voxel and, if the grid can't be
/// loaded, the reason why.
/// @param components numbers in a voxel
void set_voxel_type(std::optional<NumberType> type, std::string_view type_name, int components,
                    DenseGrid& grid);

/// Checks the numbers of voxels along each axis.
/// @param sizes three of them
/// @throws Error that names the file if one is below 1 or too large
Vec3i checked_counts(const VolumeFile& file, std::string_view what, std::span<const double> sizes);

/// How values stand in a file.
enum class DensePacking {
  kNone,     ///< Bytes as they are, or longer.
  kText,     ///< Text: a digit and a blank each, at least.
  kDeflate,  ///< Packed by gzip or zlib.
  kUnknown   ///< Left out, perhaps, where they are alike.
};

/// Checks that a file may hold so many voxels, before memory is taken for them.
/// @param voxel_bytes in a voxel
/// @throws Error that names the file
void check_dense_size(const VolumeFile& file, const Vec3i& counts, std::size_t voxel_bytes,
                      DensePacking packing);

/// Bytes of all voxels, of which check_dense_size has been called.
uint64_t dense_bytes(const Vec3i& counts, std::size_t voxel_bytes);

/// How numbers are stored.
struct StoredNumbers {
  NumberType type = NumberType::kFloat;
  std::endian order = std::endian::native;
  double slope = 1, intercept = 0;  ///< value = slope · stored + intercept
};

/// Planes of binary numbers.
PlaneSourcePointer number_planes(ByteSourcePointer bytes, const StoredNumbers& numbers);

/// Planes of numbers as text, blanks or commas between them.
PlaneSourcePointer text_planes(ByteSourcePointer text);

/// Planes of the rest of a file, as it is packed.
/// @param file must outlive them
/// @param packing not kUnknown
/// @param numbers how binary ones are stored
PlaneSourcePointer file_planes(const VolumeFile& file, uint64_t begin, DensePacking packing,
                               const StoredNumbers& numbers);

}  // namespace freepath::io
