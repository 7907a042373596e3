#pragma once
/// @file NetCDF files, by the library of that name, in a library of freepath's that is loaded when
/// the first such file is read: HDF5 comes with it, and takes longer to load than most runs take.

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace freepath::io {

/// A variable of a NetCDF file, or the attributes of the whole file.
struct NetcdfVariable {
  std::string name;
  std::string type;             ///< "float", "double", "int16", ...; empty if it holds no numbers.
  std::vector<int> dimensions;  ///< Places among the file's dimensions, the slowest first.
  std::map<std::string, std::string> texts;  ///< Attributes that are text.
  std::map<std::string, double> numbers;     ///< Attributes that are one number.

  /// An attribute's text; empty where there is none.
  std::string text(const std::string& attribute) const {
    const auto found = texts.find(attribute);
    return found == texts.end() ? std::string() : found->second;
  }
  std::optional<double> number(const std::string& attribute) const {
    const auto found = numbers.find(attribute);
    if (found == numbers.end()) return std::nullopt;
    return found->second;
  }
};

struct NetcdfDimension {
  std::string name;
  std::size_t size = 0;
};

/// The variables of a file's root group, and its dimensions.
struct NetcdfContents {
  std::vector<NetcdfDimension> dimensions;
  std::vector<NetcdfVariable> variables;
};

/// An open file. Reading is done by one thread at a time, of all that read such files.
class NetcdfHandle {
 public:
  NetcdfHandle() = default;
  NetcdfHandle(const NetcdfHandle&) = delete;
  NetcdfHandle& operator=(const NetcdfHandle&) = delete;
  virtual ~NetcdfHandle() = default;

  /// Reads a box of a variable's numbers, as they are stored, in the order of its dimensions.
  /// @param variable its place in the contents
  /// @return the reason why it could not; empty: it is done
  virtual std::string read(std::size_t variable, std::span<const std::size_t> first,
                           std::span<const std::size_t> counts, std::span<double> values) = 0;
};

/// Functions of the library.
struct NetcdfCodec {
  /// The version of freepath that it was built with.
  const char* version;
  /// Opens a file.
  /// @return null if it could not, with the reason
  std::unique_ptr<NetcdfHandle> (*open)(const std::string& path, NetcdfContents& contents,
                                        std::string& reason);
};

/// The function that the library exports; it returns the table of functions.
inline constexpr const char* kNetcdfCodecFunction = "freepath_netcdf_codec";

/// The library, loaded by the first call; from any thread.
/// @throws Error that says what to do, if it is missing or of another version
const NetcdfCodec& netcdf_codec();

}  // namespace freepath::io
