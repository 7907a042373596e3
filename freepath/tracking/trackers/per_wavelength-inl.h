// Delta tracking, a path for each channel.

#if defined(FREEPATH_TRACKING_PER_WAVELENGTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRACKING_PER_WAVELENGTH_INL_H_
#undef FREEPATH_TRACKING_PER_WAVELENGTH_INL_H_
#else
#define FREEPATH_TRACKING_PER_WAVELENGTH_INL_H_
#endif

#include "freepath/tracking/analog_collision-inl.h"
#include "freepath/tracking/method.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Each channel by a path of its own, by delta tracking [Raab08; Eymet13]: the baseline of the
/// spectral trackers. Also in media where channels could share a path.
struct PerWavelength : DeltaLaw {
  static constexpr MethodInfo kInfo = {"per-wavelength",
                                       "delta tracking with a path for each channel",
                                       "",
                                       "if the rate bounds the extinction, as super-voxels do",
                                       "[Raab08]",
                                       {},
                                       /*chromatic=*/false,
                                       /*biased=*/false,
                                       /*one_channel=*/true};

  explicit PerWavelength(std::span<const float> /*options*/) {}
};

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRACKING_PER_WAVELENGTH_INL_H_
