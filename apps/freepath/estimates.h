#pragma once
/// @file Means and their errors, as slab and flux say them.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "freepath/base/moments.h"

namespace freepath::program {

/// "reflectance  0.097390  +- 0.000123", or an upper limit.
void print_estimate(const std::string& name, const Estimate& estimate, uint64_t paths);

/// NAME and NAME_error; where there is none, null and NAME_upper.
void put_estimate(nlohmann::ordered_json& json, const std::string& name, const Estimate& estimate);

}  // namespace freepath::program
