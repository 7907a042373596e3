#pragma once
/// @file Means and their errors, as slab and flux say them.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "freepath/base/moments.h"

namespace freepath::program {

/// "reflectance  0.097390  +- 0.000123", or an upper limit.
void print_estimate(const std::string& name, const Estimate& estimate, uint64_t paths);

/// NAME and NAME_error; where there is none, null and NAME_upper.
void put_estimate(nlohmann::ordered_json& json, const std::string& name, const Estimate& estimate);

/// A pilot that tells how many paths an error takes, and has no part in the result.
inline constexpr uint64_t kPilotPaths = 65536;
/// Its seed.
constexpr uint64_t pilot_seed(uint64_t seed) { return seed ^ 0x9E3779B97F4A7C15U; }
/// Number of paths for a standard error.
/// @param option that asks for it
/// @param pilot_error largest standard error of the pilot
/// @throws Error for more paths than anybody waits for
uint64_t paths_for_error(double error, double pilot_error, std::string_view option);
/// One number between 0 and 1: a standard error to reach. @throws Error naming the option
double parse_error(const std::string& text, std::string_view option);

}  // namespace freepath::program
