#pragma once
/// @file Libraries of formats that are loaded when the first such file is read, since what they
/// bring takes longer to load than most runs of the program take.

#include <string>
#include <string_view>

#include "freepath/base/error.h"
#include "freepath/base/version.h"

namespace freepath {

/// Loads a library and finds its function.
/// @param what the library reads, in the plural, for messages
/// @throws Error that says what to do, if it is missing or another library of that name
void* load_format_library(const std::string& library, const std::string& function,
                          std::string_view what);

/// The table of functions that a library returns, loaded with it by the first call.
/// @throws Error as load_format_library, and if the library is of another version
template <class Codec>
const Codec& load_codec(const std::string& library, const std::string& function,
                        std::string_view what) {
  using Function = const Codec* (*)();
  const Codec* const codec =
      reinterpret_cast<Function>(load_format_library(library, function, what))();
  if (std::string_view(codec->version) != version()) {
    fail("{} is of freepath {}, and this is {}; install both together", library, codec->version,
         version());
  }
  return *codec;
}

}  // namespace freepath
