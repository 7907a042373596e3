#pragma once
/// @file The methods that are no null-collision walks, behind the same interface as the walks. They
/// are scalar code, and the same for every SIMD target.

#include "freepath/transport/kernels.h"

namespace freepath {

KernelTable make_reference_kernels();

}  // namespace freepath
