#pragma once
/// @file Phase functions as users write them, on a command line or in a scene.

#include <filesystem>
#include <istream>
#include <span>
#include <string_view>
#include <vector>

#include "freepath/media/phase/phase_function.h"

namespace freepath {

/// The names that parse_phase_function() knows.
std::span<const std::string_view> phase_function_names();

/// The phase function that a text describes:
///
///     isotropic
///     henyey-greenstein:g=0.8
///     rayleigh
///     draine:g=0.5,alpha=1
///     droplets:diameter=20                        micrometres
///     tabulated:FILE                              see read_phase_table()
///     0.7*henyey-greenstein:g=0.8+0.3*rayleigh    a mixture; the weights sum to 1
///
/// @param folder what the name of a table's file is relative to
/// @throws Error that says what is wrong and what would be right
PhaseFunction parse_phase_function(std::string_view text, const std::filesystem::path& folder = {});

/// The files that such a text names.
std::vector<std::filesystem::path> phase_function_files(std::string_view text,
                                                        const std::filesystem::path& folder = {});

/// A tabulated phase function from lines "angle value": the angle between the directions of travel
/// before and after [degrees], which rises from 0 to 180, and a value on any scale. What follows a
/// # is a comment; empty lines are skipped.
/// @param name of the input in messages
/// @throws Error that begins with name:line
PhaseFunction read_phase_table(std::istream& input, std::string_view name);

}  // namespace freepath
