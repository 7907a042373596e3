// Delta tracking.

#if defined(FREEPATH_TRACKING_DELTA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_DELTA_INL_H_
#undef FREEPATH_TRACKING_DELTA_INL_H_
#else
#define FREEPATH_TRACKING_DELTA_INL_H_
#endif

#include "freepath/tracking/analog_collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// P_e = mu_e/rate [Woodcock65]: real collisions happen with their own probability, and the weight
/// of a null collision is exactly 1. Channels that share one extinction share the path.
struct Delta : DeltaLaw {
  static constexpr MethodInfo kInfo = {"delta",
                                       "Woodcock's tracking: real collisions by rejection",
                                       "",
                                       "if the rate bounds the extinction, as super-voxels do",
                                       "[Woodcock65]",
                                       {}};

  explicit Delta(std::span<const float> /*options*/) {}
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_DELTA_INL_H_
