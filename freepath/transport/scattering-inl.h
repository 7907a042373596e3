// Scatterings in lanes: ScatteringKernels.

#if defined(FREEPATH_TRANSPORT_SCATTERING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRANSPORT_SCATTERING_INL_H_
#undef FREEPATH_TRANSPORT_SCATTERING_INL_H_
#else
#define FREEPATH_TRANSPORT_SCATTERING_INL_H_
#endif

#include "freepath/media/phase/henyey_greenstein-inl.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/transport/scattering_stream.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

inline void draw_scattering_numbers(ScatteringStream& scatterings, uint64_t seed) {
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const VecU stream = hn::Load(kUint, &scatterings.stream[i]);
    const VecU sample = hn::Load(kUint, &scatterings.sample[i]);
    const VecU pixel = hn::Load(kUint, &scatterings.pixel[i]);
    for (uint32_t n = 0; n < kScatteringBlocks; ++n) {
      const VecU block = hn::Set(kUint, n);
      const RandomWords random = philox_lanes(block, stream, sample, pixel, seed);
      for (uint32_t w = 0; w < 4 && 4 * n + w < kScatteringNumbers; ++w) {
        const auto second = [&] {
          return second_words(block, stream, sample, pixel, seed).words[w];
        };
        hn::Store(uniform_lanes(random.words[w], all_lanes(), second), kFloat,
                  &scatterings.numbers[4 * n + w][i]);
      }
    }
  }
}

inline void scatter_lanes(ScatteringStream& scatterings) {
  const auto load = [](const std::array<ScatteringStream::Row<float>, 3>& rows, std::size_t i) {
    return VectorLanes{hn::Load(kFloat, &rows[0][i]), hn::Load(kFloat, &rows[1][i]),
                       hn::Load(kFloat, &rows[2][i])};
  };
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const HenyeyGreensteinLanes phase(hn::Load(kFloat, &scatterings.g[i]));
    const VectorLanes before = load(scatterings.direction, i);
    hn::Store(phase.evaluate(before, load(scatterings.to_light, i)), kFloat,
              &scatterings.light_value[i]);
    VecF pdf;
    const VectorLanes after =
        phase.sample(before, hn::Load(kFloat, &scatterings.numbers[kPhaseNumber][i]),
                     hn::Load(kFloat, &scatterings.numbers[kPhaseNumber + 1][i]), pdf);
    hn::Store(after.x, kFloat, &scatterings.next[0][i]);
    hn::Store(after.y, kFloat, &scatterings.next[1][i]);
    hn::Store(after.z, kFloat, &scatterings.next[2][i]);
    hn::Store(pdf, kFloat, &scatterings.next_pdf[i]);
  }
}

inline ScatteringKernels make_scattering_kernels() {
  return {&draw_scattering_numbers, &scatter_lanes};
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRANSPORT_SCATTERING_INL_H_
