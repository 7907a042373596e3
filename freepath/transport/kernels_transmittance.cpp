// The TransmittanceEstimators of the registry, compiled for every SIMD target.

#include "freepath/transport/simd_targets.h"
// simd_targets.h comes first: it says which targets there are.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "freepath/transport/kernels_transmittance.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes next: it includes this file once for each target.
#include <hwy/highway.h>

#include "freepath/transport/walk_stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

std::vector<Kernel> make_transmittance_kernels() { return make_kernels(TransmittanceEstimators{}); }

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
