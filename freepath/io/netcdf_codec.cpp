#include "freepath/io/netcdf_codec.h"

#include "freepath/io/format_library.h"

namespace freepath::io {

const NetcdfCodec& netcdf_codec() {
  static const auto& codec =
      load_codec<NetcdfCodec>("libfreepath_netcdf.so", kNetcdfCodecFunction, "NetCDF files");
  return codec;
}

}  // namespace freepath::io
