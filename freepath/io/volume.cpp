#include "freepath/io/volume.h"

#include <array>
#include <cstring>
#include <new>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/io/volume_formats.h"

namespace freepath {
namespace {

enum class Format { kVdb, kNvdb };

Format format_of(const io::VolumeFile& file) {
  std::array<char, 8> magic{};
  if (file.size() >= magic.size()) file.read(0, std::as_writable_bytes(std::span(magic)));
  if (std::memcmp(magic.data(), " BDV\0\0\0\0", 8) == 0) return Format::kVdb;
  // "NanoVDB0" of the format's first years; "NanoVDB1" (a bare grid) and "NanoVDB2" (a file) since.
  if (std::memcmp(magic.data(), "NanoVDB", 7) == 0) return Format::kNvdb;
  fail("{}: is not a volume file; .vdb (OpenVDB) and .nvdb (NanoVDB) can be read", file.name());
}

/// Calls a reader of a format, and gives errors that aren't about the contents the file's name.
template <class Vdb, class Nvdb>
auto read_volume(const std::filesystem::path& path, Vdb read_vdb, Nvdb read_nvdb) {
  const io::VolumeFile file(path);
  try {
    return format_of(file) == Format::kVdb ? read_vdb(file) : read_nvdb(file);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("{}: not enough memory to read it; crop or resample the grid", file.name());
  } catch (const std::exception& error) {
    file.fail_damaged(error.what());
  }
}

}  // namespace

std::vector<GridInfo> list_grids(const std::filesystem::path& path) {
  return read_volume(path, io::list_vdb_grids, io::list_nvdb_grids);
}

LoadedField load_field(const std::filesystem::path& path, const LoadOptions& options) {
  LoadOptions scalar = options;
  scalar.scalar_only = true;
  return std::move(load_fields(path, scalar).front());
}

std::vector<LoadedField> load_fields(const std::filesystem::path& path,
                                     const LoadOptions& options) {
  return read_volume(
      path, [&](const io::VolumeFile& file) { return io::load_vdb_fields(file, options); },
      [&](const io::VolumeFile& file) { return io::load_nvdb_fields(file, options); });
}

}  // namespace freepath
