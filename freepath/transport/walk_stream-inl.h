// Where trackers and media meet: a method's walk over a stream of rays.

#if defined(FREEPATH_TRANSPORT_WALK_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRANSPORT_WALK_STREAM_INL_H_
#undef FREEPATH_TRANSPORT_WALK_STREAM_INL_H_
#else
#define FREEPATH_TRANSPORT_WALK_STREAM_INL_H_
#endif

#include <vector>

#include "freepath/media/field_sum-inl.h"
#include "freepath/media/segments-inl.h"
#include "freepath/tracking/walk-inl.h"
#include "freepath/transport/entry-inl.h"
#include "freepath/transport/kernels.h"
#include "freepath/transport/registry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

template <int N, class Method>
void walk_stream(const MediumView& medium, std::span<const float> options, const WalkModes& modes,
                 uint64_t seed, const RayStream& rays, FlightStream& flights,
                 WalkStatistics& statistics) {
  MediumEntry entry(medium, rays);
  const Method method(options);
  const SuperVoxelSegments segments(medium);
  const FieldSum<N> fields(medium);
  Walk<N, Method, SuperVoxelSegments, FieldSum<N>, MediumEntry>(
      method, segments, fields, modes, seed, rays, entry, flights, statistics)
      .run();
}

template <class Method>
WalkTable walks_of() {
  return walk_table([]<int N>() -> WalkFunction { return &walk_stream<N, Method>; });
}

template <class... Methods>
std::vector<Kernel> make_kernels(MethodList<Methods...> /*list*/) {
  static_assert((has_room_for(Methods::kInfo) && ...), "raise kMaxMethodOptions");
  return {Kernel{Methods::kInfo, walks_of<Methods>()}...};
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRANSPORT_WALK_STREAM_INL_H_
