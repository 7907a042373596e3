#pragma once
/// @file What an input may cost: no more than it delivers, and no more than the machine has.

#include <cstdint>
#include <string_view>

namespace freepath {

/// The memory that this program may take: that of the machine, of its control group, or its own
/// limit of address space, whichever is least [bytes].
uint64_t memory_present();

/// Checks, before memory is taken for something, that the machine has it.
/// @param name the beginning of the message: the file
/// @param what what needs it, in the plural: "100000x100000 pixels"
/// @param needed [bytes]; double, since the counts in a file may overflow integers
/// @throws Error if it is more than the machine can give
void check_memory_present(std::string_view name, std::string_view what, double needed);

/// Checks that what a file declares can come out of it. Formats pack runs of one value well,
/// deflate by 1032 to 1 and some formats of images by ten times more; beyond 65536 to 1, and more
/// than 64 MiB, the declaration is wrong. Below, memory is to be taken as the file delivers.
/// @param decoded bytes of what is declared, as the file's format unpacks them
/// @param stored bytes of the file
/// @throws Error if the file is too short
void check_declared(std::string_view name, std::string_view what, double decoded, uint64_t stored);

}  // namespace freepath
