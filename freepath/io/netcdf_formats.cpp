// The library of freepath's that reads NetCDF files (netcdf_codec.h).

#include <H5Epublic.h>
#include <netcdf.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "freepath/base/version.h"
#include "freepath/io/netcdf_codec.h"

namespace freepath::io {
namespace {

/// A thread that may call NetCDF and HDF5, which only one may at a time. While it does, HDF5 prints
/// nothing: it would tell of attributes that NetCDF looks for, and NetCDF silences the thread alone
/// that was the first.
class NetcdfCaller {
 public:
  NetcdfCaller() : lock_(mutex()) {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~NetcdfCaller() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  NetcdfCaller(const NetcdfCaller&) = delete;
  NetcdfCaller& operator=(const NetcdfCaller&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }

  std::scoped_lock<std::mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// The name of a type of numbers; empty for others.
std::string type_name(nc_type type) {
  switch (type) {
    case NC_BYTE:
      return "int8";
    case NC_UBYTE:
      return "uint8";
    case NC_SHORT:
      return "int16";
    case NC_USHORT:
      return "uint16";
    case NC_INT:
      return "int32";
    case NC_UINT:
      return "uint32";
    case NC_INT64:
      return "int64";
    case NC_UINT64:
      return "uint64";
    case NC_FLOAT:
      return "float";
    case NC_DOUBLE:
      return "double";
    default:
      return {};
  }
}

class OpenNetcdf : public NetcdfHandle {
 public:
  /// @param bytes of the file
  OpenNetcdf(int file, std::uintmax_t bytes)
      : file_(file),
        name_(std::make_unique_for_overwrite<char[]>(
            std::max<std::size_t>(std::min(bytes, kLongestName), NC_MAX_NAME) + 1)) {}
  ~OpenNetcdf() override {
    const NetcdfCaller caller;
    nc_close(file_);
  }

  /// @return the status of the library
  int list(NetcdfContents& contents) {
    int dimensions = 0, variables = 0;
    if (const int status = nc_inq(file_, &dimensions, &variables, nullptr, nullptr)) return status;
    // Numbers of dimensions need not be in a row where there are groups.
    std::vector<int> ids(static_cast<std::size_t>(dimensions));
    if (const int status = nc_inq_dimids(file_, &dimensions, ids.data(), 0)) return status;
    for (const int id : ids) {
      std::size_t size = 0;
      if (const int status = nc_inq_dim(file_, id, name_.get(), &size)) return status;
      if (is_too_long()) return NC_EMAXNAME;
      contents.dimensions.push_back({name_.get(), size});
    }
    for (int id = 0; id < variables; ++id) {
      NetcdfVariable variable;
      if (const int status = describe(id, ids, variable)) return status;
      contents.variables.push_back(std::move(variable));
    }
    return NC_NOERR;
  }

  std::string read(std::size_t variable, std::span<const std::size_t> first,
                   std::span<const std::size_t> counts, std::span<double> values) override {
    const NetcdfCaller caller;
    const int status = nc_get_vara_double(file_, static_cast<int>(variable), first.data(),
                                          counts.data(), values.data());
    // What no double holds is infinite in the result already.
    return status == NC_NOERR || status == NC_ERANGE ? std::string() : nc_strerror(status);
  }

 private:
  int describe(int id, const std::vector<int>& dimension_ids, NetcdfVariable& variable) const {
    nc_type type = NC_NAT;
    int rank = 0, attributes = 0;
    if (const int status = nc_inq_varndims(file_, id, &rank)) return status;
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    if (const int status =
            nc_inq_var(file_, id, name_.get(), &type, nullptr, dimensions.data(), &attributes)) {
      return status;
    }
    if (is_too_long()) return NC_EMAXNAME;
    variable.name = name_.get();
    variable.type = type_name(type);
    for (int i = 0; i < rank; ++i) {
      const int dimension = dimensions[static_cast<std::size_t>(i)];
      const auto found = std::find(dimension_ids.begin(), dimension_ids.end(), dimension);
      if (found == dimension_ids.end()) return NC_EBADDIM;
      variable.dimensions.push_back(static_cast<int>(found - dimension_ids.begin()));
    }
    for (int i = 0; i < attributes; ++i) {
      if (const int status = nc_inq_attname(file_, id, i, name_.get())) return status;
      if (is_too_long()) return NC_EMAXNAME;
      if (const int status = read_attribute(id, name_.get(), variable)) return status;
    }
    return NC_NOERR;
  }

  int read_attribute(int id, const char* name, NetcdfVariable& variable) const {
    nc_type type = NC_NAT;
    std::size_t size = 0;
    if (const int status = nc_inq_att(file_, id, name, &type, &size)) return status;
    constexpr std::size_t kLongestText = 1 << 16;
    if (type == NC_CHAR && size <= kLongestText) {
      std::string text(size, '\0');
      if (const int status = nc_get_att_text(file_, id, name, text.data())) return status;
      while (!text.empty() && text.back() == '\0') text.pop_back();
      variable.texts[name] = std::move(text);
    } else if (type == NC_STRING && size == 1) {
      char* text = nullptr;
      if (const int status = nc_get_att_string(file_, id, name, &text)) return status;
      if (text != nullptr) variable.texts[name] = text;
      nc_free_string(1, &text);
    } else if (!type_name(type).empty() && size == 1) {
      double number = 0;
      const int status = nc_get_att_double(file_, id, name, &number);
      if (status != NC_NOERR && status != NC_ERANGE) return status;
      variable.numbers[name] = number;
    }
    return NC_NOERR;
  }

  /// Whether the name that was read is longer than names may be.
  bool is_too_long() const { return std::strlen(name_.get()) > NC_MAX_NAME; }

  /// The library copies names of classic files whole, however long they are; none is longer than
  /// its file. Memory is taken as it is written, that of names alone.
  static constexpr std::uintmax_t kLongestName = 1 << 30;
  int file_;
  std::unique_ptr<char[]> name_;  // NOLINT(modernize-avoid-c-arrays): not to be cleared
};

std::unique_ptr<NetcdfHandle> open_netcdf_file(const std::string& path, NetcdfContents& contents,
                                               std::string& reason) {
  std::unique_ptr<OpenNetcdf> opened;
  int status = NC_NOERR;
  {
    const NetcdfCaller caller;
    int file = -1;
    status = nc_open(path.c_str(), NC_NOWRITE, &file);
    if (status == NC_NOERR) {
      std::error_code unknown;
      opened = std::make_unique<OpenNetcdf>(file, std::filesystem::file_size(path, unknown));
      status = opened->list(contents);
    }
  }
  if (status == NC_NOERR) return opened;
  reason = nc_strerror(status);
  return nullptr;
}

}  // namespace
}  // namespace freepath::io

extern "C" const freepath::io::NetcdfCodec* freepath_netcdf_codec() {
  static const freepath::io::NetcdfCodec kCodec{freepath::version(),
                                                freepath::io::open_netcdf_file};
  return &kCodec;
}
