#pragma once
/// @file The SIMD targets that kernels are compiled for; to be included before Highway.

// Machines with SSSE3 but no SSE4 are older than this kind of work. A build with sanitizers, which
// takes minutes for each target, names fewer (CMakeLists.txt).
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
