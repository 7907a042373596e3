// Writes NanoVDB files, by NanoVDB itself.

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <exception>
#include <fstream>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/io/volume_write.h"
#include "freepath/io/volume_write_grid.h"

namespace freepath {
namespace {

nanovdb::GridHandle<> nanovdb_grid_of(const Field& field, bool half) {
  const auto grid = io::openvdb_grid_of(field);
  if (half) {
    return nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, nanovdb::Fp16>(*grid);
  }
  return nanovdb::openToNanoVDB(*grid);
}

}  // namespace

void write_nvdb(AtomicFile& file, std::span<const Field* const> fields,
                const VdbWriteOptions& options) {
  if (fields.empty()) fail("{}: there is no field to write", file.path());
  openvdb::initialize();
  try {
    std::vector<nanovdb::GridHandle<>> grids;
    for (const Field* field : fields) grids.push_back(nanovdb_grid_of(*field, options.half));
    std::ofstream stream(file.name(), std::ios::binary | std::ios::trunc);
    nanovdb::io::writeGrids(stream, grids, nanovdb::io::Codec::ZIP);
    stream.close();
    if (!stream) fail("it came out cut short; is the disk full, or the size of files limited?");
  } catch (const std::exception& error) {
    file.give_up(error.what());
  }
  file.replace_target();
}

}  // namespace freepath
