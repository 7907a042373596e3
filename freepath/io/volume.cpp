#include "freepath/io/volume.h"

#include <array>
#include <cstring>
#include <memory>
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

/// Calls a function with a file's reader, and gives errors that aren't about the contents the
/// file's name.
template <class Use>
auto with_reader(const std::filesystem::path& path, Use use) {
  const io::VolumeFile file(path);
  try {
    const std::unique_ptr<io::VolumeReader> reader =
        format_of(file) == Format::kVdb ? io::open_vdb(file) : io::open_nvdb(file);
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
  return with_reader(path, [](const io::VolumeFile& /*file*/, const io::VolumeReader& reader) {
    return reader.heads();
  });
}

std::vector<GridInfo> list_grids(const std::filesystem::path& path) {
  return with_reader(path, [](const io::VolumeFile& file, const io::VolumeReader& reader) {
    std::vector<GridInfo> grids = reader.heads();
    for (GridInfo& info : grids) visit_grid(file, reader, {}, false, info);
    return grids;
  });
}

void visit_grids(const std::filesystem::path& path, const std::optional<GridSelection>& only,
                 const LoadOptions& options, const GridVisitor& use) {
  with_reader(path, [&](const io::VolumeFile& file, const io::VolumeReader& reader) {
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
  return with_reader(path, [&](const io::VolumeFile& file, const io::VolumeReader& reader) {
    const std::vector<GridInfo> grids = reader.heads();
    const GridInfo& info = find_grid(file.name(), grids, options.selection);
    io::check_selected(file.name(), info, options);
    io::AssembledGrid read = reader.read(info, options, true);
    return finish(reader, info, std::move(read));
  });
}

}  // namespace freepath
