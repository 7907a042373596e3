// The null-collision trackers and transmittance estimators there are. A new one is a new file and a
// line here. Lists are compiled apart (kernels_*.cpp) and make one table, in this order.

#if defined(FREEPATH_TRANSPORT_REGISTRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRANSPORT_REGISTRY_INL_H_
#undef FREEPATH_TRANSPORT_REGISTRY_INL_H_
#else
#define FREEPATH_TRANSPORT_REGISTRY_INL_H_
#endif

#include "freepath/tracking/trackers/decomposition-inl.h"
#include "freepath/tracking/trackers/delta-inl.h"
#include "freepath/tracking/trackers/hero_wavelength-inl.h"
#include "freepath/tracking/trackers/multi_volume-inl.h"
#include "freepath/tracking/trackers/per_wavelength-inl.h"
#include "freepath/tracking/trackers/spectral-inl.h"
#include "freepath/tracking/trackers/spectral_decomposition-inl.h"
#include "freepath/tracking/trackers/weighted_decomposition-inl.h"
#include "freepath/tracking/trackers/weighted_delta-inl.h"
#include "freepath/tracking/transmittance/delta_transmittance-inl.h"
#include "freepath/tracking/transmittance/next_flight-inl.h"
#include "freepath/tracking/transmittance/ratio-inl.h"
#include "freepath/tracking/transmittance/residual_ratio-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

template <class... Methods>
struct MethodList {};

using DeltaTrackers = MethodList<Delta,          //
                                 WeightedDelta,  //
                                 MultiVolume,    //
                                 PerWavelength>;

using DecompositionTrackers = MethodList<Decomposition,  //
                                         WeightedDecomposition>;

using SpectralTrackers = MethodList<Spectral,               //
                                    SpectralDecomposition,  //
                                    HeroWavelength>;

using TransmittanceEstimators = MethodList<DeltaTransmittance,  //
                                           Ratio,               //
                                           ResidualRatio,       //
                                           NextFlight>;

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRANSPORT_REGISTRY_INL_H_
