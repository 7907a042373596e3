// The trackers and transmittance estimators there are. A new one is a new file and a line here.

#if defined(FREEPATH_TRANSPORT_REGISTRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRANSPORT_REGISTRY_INL_H_
#undef FREEPATH_TRANSPORT_REGISTRY_INL_H_
#else
#define FREEPATH_TRANSPORT_REGISTRY_INL_H_
#endif

#include "freepath/tracking/trackers/delta-inl.h"
#include "freepath/tracking/trackers/weighted_delta-inl.h"
#include "freepath/tracking/transmittance/delta_transmittance-inl.h"
#include "freepath/tracking/transmittance/ratio-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

template <class... Methods>
struct MethodList {};

using TrackerList = MethodList<Delta,  //
                               WeightedDelta>;

using TransmittanceList = MethodList<DeltaTransmittance,  //
                                     Ratio>;

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRANSPORT_REGISTRY_INL_H_
