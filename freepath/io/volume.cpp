#include "freepath/io/volume.h"

#include <algorithm>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/gzip.h"
#include "freepath/io/volume_formats.h"

namespace freepath {
namespace {

/// Opens a file by what it begins with.
io::VolumeReaderPointer open_reader(const io::VolumeFile& file, const LoadOptions& options) {
  if (options.raw) return io::open_raw(file, *options.raw);
  constexpr std::size_t kLongestMark = 16;
  std::string head(std::min<uint64_t>(file.size(), kLongestMark), '\0');
  file.read(0, std::as_writable_bytes(std::span(head)));
  const auto begins = [&](std::string_view mark) { return head.starts_with(mark); };
  if (begins(std::string_view(" BDV\0\0\0\0", 8))) return io::open_vdb(file);
  // "NanoVDB0" of the format's first years; "NanoVDB1" (a bare grid) and "NanoVDB2" (a file) since.
  if (begins("NanoVDB")) return io::open_nvdb(file);
  if (begins("# vtk DataFile")) return io::open_vtk_legacy(file);
  if (begins("NRRD")) return io::open_nrrd(file);
  if (begins("CDF\x01") || begins("CDF\x02") || begins("CDF\x05") || begins("\x89HDF\r\n\x1a\n")) {
    return io::open_netcdf(file, options);
  }
  if (is_gzip(head)) return io::open_nifti(file, true);
  if (io::is_nifti(file)) return io::open_nifti(file, false);
  if (io::is_vti(file)) return io::open_vti(file);
  if (io::is_metaimage(file)) return io::open_metaimage(file);
  if (std::filesystem::path(file.name()).extension() == ".raw") {
    fail(
        "{}: raw values say nothing of their size and type; write a header beside it (.nhdr or "
        ".mhd), or give both to freepath convert (--raw-size, --raw-type)",
        file.name());
  }
  fail(
      "{}: is not a volume file; OpenVDB, NanoVDB, VTI, legacy VTK, NRRD, MetaImage, NIfTI and "
      "NetCDF can be read",
      file.name());
}

/// Calls a function with a file's reader, and gives errors that aren't about the contents the
/// file's name.
template <class Use>
auto with_reader(const std::filesystem::path& path, const LoadOptions& options, Use use) {
  const std::filesystem::path header =
      options.raw ? std::filesystem::path() : io::raw_header_beside(path);
  const io::VolumeFile file(header.empty() ? path : header);
  try {
    const io::VolumeReaderPointer reader = open_reader(file, options);
    return use(file, *reader);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("{}: not enough memory to read it; crop or resample the grid", file.name());
  } catch (const std::exception& error) {
    file.fail_damaged(error.what());
  }
}

std::vector<LoadedField> finish(const io::VolumeReader& reader, const GridInfo& info,
                                io::AssembledGrid read) {
  std::vector<LoadedField> fields = std::move(*read.assembly).finish(info, read.scan);
  reader.finish(info, fields);
  for (LoadedField& field : fields) {
    field.length_unit = info.length_unit;
    field.value_unit = info.value_unit;
  }
  return fields;
}

/// Reads a grid for its listing, and its fields too if they are to be kept.
std::vector<LoadedField> visit_grid(const io::VolumeFile& file, const io::VolumeReader& reader,
                                    const LoadOptions& options, bool keep_values, GridInfo& info) {
  if (!reader.is_readable(info)) return {};
  try {
    io::AssembledGrid read = reader.read(info, options, keep_values && info.loadable);
    read.assembly->describe(read.scan, info);
    if (!keep_values || !info.loadable) return {};
    std::vector<LoadedField> fields = finish(reader, info, std::move(read));
    const Field& field = fields.front().field;
    if (field.index_to_world != info.index_to_world) {  // it was resampled
      info.index_to_world = field.index_to_world;
      info.active_min = field.voxels.active_min();
      info.active_max = field.voxels.active_max();
    }
    return fields;
  } catch (const std::exception& error) {
    io::set_failure(file.name(), error.what(), info);
    return {};
  }
}

}  // namespace

std::vector<GridInfo> list_grid_heads(const std::filesystem::path& path) {
  return with_reader(path, {}, [](const io::VolumeFile& /*file*/, const io::VolumeReader& reader) {
    return reader.heads();
  });
}

std::vector<GridInfo> list_grids(const std::filesystem::path& path) {
  return with_reader(path, {}, [](const io::VolumeFile& file, const io::VolumeReader& reader) {
    std::vector<GridInfo> grids = reader.heads();
    for (GridInfo& info : grids) visit_grid(file, reader, {}, false, info);
    return grids;
  });
}

void visit_grids(const std::filesystem::path& path, const std::optional<GridSelection>& only,
                 const LoadOptions& options, const GridVisitor& use) {
  with_reader(path, options, [&](const io::VolumeFile& file, const io::VolumeReader& reader) {
    std::vector<GridInfo> grids = reader.heads();
    if (only) grids = {find_grid(path, grids, *only)};
    for (GridInfo& info : grids) {
      std::vector<LoadedField> fields = visit_grid(file, reader, options, true, info);
      use(info, std::move(fields));
    }
  });
}

LoadedField load_field(const std::filesystem::path& path, const LoadOptions& options) {
  LoadOptions scalar = options;
  scalar.scalar_only = true;
  return std::move(load_fields(path, scalar).front());
}

std::vector<LoadedField> load_fields(const std::filesystem::path& path,
                                     const LoadOptions& options) {
  return with_reader(path, options,
                     [&](const io::VolumeFile& file, const io::VolumeReader& reader) {
                       const std::vector<GridInfo> grids = reader.heads();
                       const GridInfo info = find_grid(file.name(), grids, options.selection);
                       io::check_selected(file.name(), info, options);
                       io::AssembledGrid read = reader.read(info, options, true);
                       return finish(reader, info, std::move(read));
                     });
}

}  // namespace freepath
