// Tracking in overlapping volumes, one look-up a collision.

#if defined(FREEPATH_TRACKING_MULTI_VOLUME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_MULTI_VOLUME_INL_H_
#undef FREEPATH_TRACKING_MULTI_VOLUME_INL_H_
#else
#define FREEPATH_TRACKING_MULTI_VOLUME_INL_H_
#endif

#include "freepath/tracking/analog_collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// The components' rates add up; a tentative collision belongs to one of them with probability
/// rate_k/rate, and is delta tracking within that one, by its own rate [Galtier16]. No other
/// component's density is looked up.
struct MultiVolume : DeltaLaw {
  static constexpr MethodInfo kInfo = {"multi-volume",
                                       "delta tracking that looks one component up a collision",
                                       "",
                                       "if the rate bounds the extinction, as super-voxels do",
                                       "[Galtier16]",
                                       {}};
  static constexpr bool kOneComponent = true;

  explicit MultiVolume(std::span<const float> /*options*/) {}
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_MULTI_VOLUME_INL_H_
