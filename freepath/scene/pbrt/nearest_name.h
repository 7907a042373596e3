#pragma once
/// @file What a misspelt name in a scene may have meant.

#include <span>
#include <string>
#include <string_view>

#include "freepath/base/nearest_name.h"

namespace freepath {

/// "; did you mean 'x'?" for the nearest name, or nothing.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> names);

}  // namespace freepath
