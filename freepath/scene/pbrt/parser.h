#pragma once
/// @file From a pbrt-v4 scene file to its description.

#include <cstddef>
#include <filesystem>
#include <string>

#include "freepath/scene/pbrt/diagnostics.h"
#include "freepath/scene/pbrt/file_reader.h"
#include "freepath/scene/pbrt/scene.h"

namespace freepath {

/// What bounds the work that a scene can ask for, however it is made.
struct ParseLimits {
  int include_depth = 32;               ///< Files open at once.
  int attribute_depth = 1000;           ///< AttributeBegin inside one another.
  std::size_t files = 100000;           ///< Read in all.
  std::size_t file_bytes = 2000000000;  ///< Size of one file, unpacked; at most 2^31 - 1.
};

/// Parses a scene with all that it includes. Directives, the types and counts of parameters,
/// transforms and references by name are checked; what an implementation makes of its parameters is
/// not. Files may be packed by gzip; which ones are is told by their first bytes.
/// @throws Error, one sentence beginning "file:line:column: ", or "file: " where it is about the
///   whole of the main file
PbrtScene parse_pbrt_file(const std::filesystem::path& path, Diagnostics& diagnostics,
                          const FileReader& reader = DiskFileReader(),
                          const ParseLimits& limits = {});

/// Parses the text of a main file.
/// @param name of that file, for messages and for finding files beside it
PbrtScene parse_pbrt_text(std::string text, const std::string& name, Diagnostics& diagnostics,
                          const FileReader& reader = DiskFileReader(),
                          const ParseLimits& limits = {});

}  // namespace freepath
