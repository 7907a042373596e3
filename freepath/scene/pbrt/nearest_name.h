#pragma once
/// @file What a misspelt name in a scene may have meant.

#include <span>
#include <string>
#include <string_view>

#include "freepath/base/nearest_name.h"
#include "freepath/scene/pbrt/source_location.h"

namespace freepath {

/// "; did you mean 'x'?" for the nearest name, or nothing.
inline std::string did_you_mean(std::string_view name, std::span<const std::string_view> names) {
  const std::string_view nearest = nearest_name(name, names);
  return nearest.empty() ? std::string() : "; did you mean " + in_quotes(nearest) + "?";
}

}  // namespace freepath
