#pragma once
/// @file A NetCDF file as volumes see it: which dimensions are axes of space and time, where the
/// coordinates lie, and levels of variables.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/io/netcdf_codec.h"
#include "freepath/io/volume_file.h"

namespace freepath::io {

/// What a dimension stands for.
enum class NetcdfAxis { kX, kY, kZ, kTime, kOther };

/// Coordinates along an axis of space.
struct NetcdfCoordinates {
  std::string name;               ///< Name of the dimension.
  std::vector<double> positions;  ///< Positions of the samples [m].
  double step = 0;                ///< Distance of neighbouring samples, if uniform [m].
  bool uniform = false;
};

/// The dimensions of a variable that are axes; -1: it has none.
struct NetcdfAxes {
  std::array<int, 3> space{-1, -1, -1};  ///< x, y and z.
  int time = -1;

  bool in_space() const { return space[0] >= 0 && space[1] >= 0 && space[2] >= 0; }
};

/// An open file.
class NetcdfFile {
 public:
  /// @param file must outlive it
  /// @throws Error if it is damaged
  explicit NetcdfFile(const VolumeFile& file);

  const VolumeFile& file() const { return *file_; }
  const std::vector<NetcdfVariable>& variables() const { return contents_.variables; }
  const NetcdfVariable& variable(std::size_t index) const { return contents_.variables[index]; }
  std::size_t size(int dimension) const {
    return contents_.dimensions[static_cast<std::size_t>(dimension)].size;
  }

  /// The place of the first variable that has one of some names, whatever their case, or one of
  /// some standard names.
  std::optional<std::size_t> find(std::span<const std::string_view> names,
                                  std::span<const std::string_view> standard_names) const;

  /// The axes of a variable. @throws Error, without a place, if it has one twice
  NetcdfAxes axes(std::size_t variable) const;

  /// Coordinates along a dimension.
  /// @throws Error, without a place, if there are none, their unit is none of length, or they are
  /// neither rising nor falling
  NetcdfCoordinates coordinates(int dimension) const;

  /// A level of a variable at a time: values for x and y of some axes, x fastest, the same along an
  /// axis that it doesn't have. Packed ones are unpacked; missing ones are NaN.
  /// @throws Error if it can't be read
  std::vector<double> level(std::size_t variable, const NetcdfAxes& axes, std::size_t z,
                            std::size_t time) const;

 private:
  std::optional<std::size_t> coordinate_variable(int dimension) const;
  NetcdfAxis axis_of(int dimension) const;
  std::vector<double> read(std::size_t variable, std::span<const std::size_t> first,
                           std::span<const std::size_t> counts) const;

  const VolumeFile* file_;
  NetcdfContents contents_;
  std::unique_ptr<NetcdfHandle> handle_;
};

}  // namespace freepath::io
