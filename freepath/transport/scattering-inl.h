// Scatterings in lanes: ScatteringKernels.

#if defined(FREEPATH_TRANSPORT_SCATTERING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FREEPATH_TRANSPORT_SCATTERING_INL_H_
#undef FREEPATH_TRANSPORT_SCATTERING_INL_H_
#else
#define FREEPATH_TRANSPORT_SCATTERING_INL_H_
#endif

#include <array>
#include <bit>
#include <vector>

#include "freepath/base/direction_disc.h"
#include "freepath/media/phase/henyey_greenstein-inl.h"
#include "freepath/tracking/random-inl.h"
#include "freepath/tracking/streams.h"
#include "freepath/transport/scattering_kernels.h"
#include "freepath/transport/scattering_stream.h"
#include "freepath/transport/shadow_roulette.h"

HWY_BEFORE_NAMESPACE();
namespace freepath::HWY_NAMESPACE {

/// Packs values of the scatterings' rays, which mostly follow each other: a vector of sixteen is
/// read at a time, where a gather would take each by itself. Of fewer lanes gathers take less.
class RayPacking {
 public:
  /// Room for the lanes behind the last scattering.
  static constexpr std::size_t kSize = ScatteringStream::kCapacity + kLanes;

  explicit RayPacking(const ScatteringStream& scatterings) : scatterings_(scatterings) {
    if constexpr (kGathers) return;
    const std::size_t count = scatterings.count;
    for (std::size_t i = 0; i < count;) {
      Window& window = windows_[window_count_++];
      window = {scatterings.ray[i], static_cast<uint32_t>(i), 0};
      for (uint32_t offset = 0, last = 0; offset < kLanes && offset >= last;) {
        window.lanes |= 1U << offset;
        if (++i == count) break;
        last = offset + 1;
        offset = scatterings.ray[i] - window.first;
      }
    }
  }

  /// @param values of all rays; may be read up to kLanes - 1 behind the last
  template <class T>
  HWY_INLINE void pack(const std::vector<T>& values, T (&packed)[kSize]) const {
    if constexpr (kGathers) {
      const std::size_t count = scatterings_.count;
      for (std::size_t i = 0; i < count; i += kLanes) {
        const VecI ray = hn::BitCast(
            kInt, hn::MaskedLoad(hn::FirstN(kUint, count - i), kUint, &scatterings_.ray[i]));
        hn::Store(hn::GatherIndex(hn::ScalableTag<T>(), values.data(), ray), hn::ScalableTag<T>(),
                  packed + i);
      }
      return;
    }
    for (std::size_t w = 0; w < window_count_; ++w) {
      const Window& window = windows_[w];
      const auto row = hn::LoadU(hn::ScalableTag<T>(), values.data() + window.first);
      Packing(window.lanes).write(row, packed + window.slot);
    }
  }

 private:
  /// kLanes rays from one on.
  struct Window {
    uint32_t first;
    uint32_t slot;   ///< Of the first of them that scatters.
    uint32_t lanes;  ///< Those that scatter.
  };
  static constexpr bool kGathers = kLanes < 16;
  const ScatteringStream& scatterings_;
  std::array<Window, ScatteringStream::kCapacity> windows_;
  std::size_t window_count_ = 0;
};

inline void gather_scatterings(const RayStream& rays, const FlightStream& flights,
                               ScatteringStream& scatterings) {
  constexpr uint32_t kFromWalk =
      stream_number(StreamPurpose::kScatter, 0) - stream_number(StreamPurpose::kWalk, 0);
  const RayPacking packing(scatterings);
  HWY_ALIGN_MAX float t[RayPacking::kSize];
  HWY_ALIGN_MAX float origin[RayPacking::kSize];
  HWY_ALIGN_MAX float direction[RayPacking::kSize];
  packing.pack(flights.t, t);
  for (int axis = 0; axis < 3; ++axis) {
    packing.pack(rays.origin[axis], origin);
    packing.pack(rays.direction[axis], direction);
    for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
      // Lanes behind the last scattering are at the origin.
      const MaskF some = hn::FirstN(kFloat, scatterings.count - i);
      const VecF along = hn::MaskedLoad(some, kFloat, direction + i);
      hn::Store(along, kFloat, &scatterings.direction[axis][i]);
      hn::Store(mul_add(along, hn::MaskedLoad(some, kFloat, t + i),
                        hn::MaskedLoad(some, kFloat, origin + i)),
                kFloat, &scatterings.position[axis][i]);
    }
  }
  HWY_ALIGN_MAX uint32_t words[RayPacking::kSize];
  const auto copy = [&](const std::vector<uint32_t>& values, uint32_t step, uint32_t* row) {
    packing.pack(values, words);
    for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
      const VecU some = hn::MaskedLoad(hn::FirstN(kUint, scatterings.count - i), kUint, words + i);
      hn::Store(hn::Add(some, hn::Set(kUint, step)), kUint, row + i);
    }
  };
  copy(rays.pixel, 0, scatterings.pixel.data());
  copy(rays.sample, 0, scatterings.sample.data());
  copy(rays.stream, kFromWalk, scatterings.stream.data());
}

inline void draw_scattering_numbers(ScatteringStream& scatterings, uint64_t seed, uint32_t blocks) {
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const VecU stream = hn::Load(kUint, &scatterings.stream[i]);
    const VecU sample = hn::Load(kUint, &scatterings.sample[i]);
    const VecU pixel = hn::Load(kUint, &scatterings.pixel[i]);
    for (uint32_t n = 0; n < blocks; ++n) {
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

/// Rows of vectors from lane i on.
HWY_INLINE VectorLanes vectors_at(const std::array<ScatteringStream::Row<float>, 3>& rows,
                                  std::size_t i) {
  return {hn::Load(kFloat, &rows[0][i]), hn::Load(kFloat, &rows[1][i]),
          hn::Load(kFloat, &rows[2][i])};
}

/// The same vector in all lanes.
HWY_INLINE VectorLanes set_vector(const Vec3f& v) { return {set(v.x), set(v.y), set(v.z)}; }

HWY_INLINE VectorLanes difference_of(const VectorLanes& a, const VectorLanes& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

/// DirectionDisc::sample(), lane by lane.
HWY_INLINE VectorLanes sample_disc(const DirectionDisc& disc, VecF u0, VecF u1) {
  const VecF one = set(1.0F);
  const VecF drop = hn::Mul(hn::Mul(u0, set(0.5F)), set(disc.largest_distance2));
  const VecF reach = hn::Sqrt(hn::Mul(drop, hn::Sub(set(2.0F), drop)));
  VecF sine;
  VecF cosine;
  sincos_of_turn_lanes(u1, sine, cosine);
  const VectorLanes middle = set_vector(disc.middle());
  const VectorLanes direction =
      sum_of(sum_of(scaled(set_vector(disc.frame.tangent), hn::Mul(reach, cosine)),
                    scaled(set_vector(disc.frame.bitangent), hn::Mul(reach, sine))),
             scaled(middle, hn::Sub(one, drop)));
  const VectorLanes off = difference_of(direction, middle);
  const MaskF contained = hn::Le(squared_length(off), set(disc.largest_distance2));
  if (hn::AllTrue(kFloat, contained)) return direction;
  const VectorLanes inside = sum_of(middle, scaled(off, set(DirectionDisc::kInside)));
  const VectorLanes unit = scaled(inside, hn::Div(one, hn::Sqrt(squared_length(inside))));
  return {hn::IfThenElse(contained, direction.x, unit.x),
          hn::IfThenElse(contained, direction.y, unit.y),
          hn::IfThenElse(contained, direction.z, unit.z)};
}

inline void play_lanes(ScatteringStream& scatterings, float threshold) {
  const VecF one = set(1.0F);
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const VecF magnitude = hn::Load(kFloat, &scatterings.magnitude[i]);
    const MaskF is_branch =
        hn::Gt(hn::Load(kFloat, &scatterings.lobe_roulette[i]), hn::Zero(kFloat));
    const MaskF enough =
        hn::And(hn::Ge(magnitude, set(threshold)), hn::Gt(magnitude, hn::Zero(kFloat)));
    const VecF survival =
        hn::IfThenElse(hn::Or(is_branch, enough), one, hn::Div(magnitude, set(threshold)));
    hn::Store(survival, kFloat, &scatterings.survival[i]);
  }
}

inline void aim_lanes(ScatteringStream& scatterings, const DirectionDisc& disc) {
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const VectorLanes to_light =
        sample_disc(disc, hn::Load(kFloat, &scatterings.numbers[kLightNumber][i]),
                    hn::Load(kFloat, &scatterings.numbers[kLightNumber + 1][i]));
    hn::Store(to_light.x, kFloat, &scatterings.to_light[0][i]);
    hn::Store(to_light.y, kFloat, &scatterings.to_light[1][i]);
    hn::Store(to_light.z, kFloat, &scatterings.to_light[2][i]);
  }
}

/// Number of the cell along an axis, a whole number.
HWY_INLINE VecF cell_along(VecF position, float corner, float per_cell, int count) {
  const VecF at = hn::Mul(hn::Sub(position, set(corner)), set(per_cell));
  const VecF last = set(static_cast<float>(count - 1));
  return hn::Floor(hn::Min(hn::Max(at, hn::Zero(kFloat)), last));
}

/// Part of ShadowRoulette that concerns some scatterings and the directions to their lights.
struct DominantLanes {
  VecF root;   ///< Of the cells' transmittances.
  MaskF same;  ///< Whether the light is the dominant one.
};

HWY_INLINE DominantLanes dominant_lanes(const ShadowRoulette& roulette, const VectorLanes& position,
                                        const VectorLanes& to_light) {
  if (roulette.roots == nullptr) {
    const VecF one = set(1.0F);
    return {one, hn::Lt(one, one)};
  }
  const VecF cosine = hn::Add(hn::Add(hn::Mul(to_light.x, set(roulette.dominant.x)),
                                      hn::Mul(to_light.y, set(roulette.dominant.y))),
                              hn::Mul(to_light.z, set(roulette.dominant.z)));
  const Vec3i& counts = roulette.counts;
  const auto along = [&](VecF at, int axis) {
    return small_to_int(
        cell_along(at, roulette.corner[axis], roulette.per_cell[axis], counts[axis]));
  };
  VecI cell = along(position.z, 2);
  cell = hn::Add(hn::Mul(cell, hn::Set(kInt, counts.y)), along(position.y, 1));
  cell = hn::Add(hn::Mul(cell, hn::Set(kInt, counts.x)), along(position.x, 0));
  return {hn::GatherIndex(kFloat, roulette.roots, cell),
          hn::Ge(cosine, set(ShadowRoulette::kSameDirection))};
}

/// Chances of branches by ShadowRoulette.
struct LobeLanes {
  VecF survival;  ///< With what probability a branch goes on, (0, 1].
  VecF chance;    ///< With what probability a path that goes on splits.
};

/// Chances of branches that fly on, and of paths to split.
/// @param roulette_below ScatteringStream::lobe_roulette
HWY_INLINE LobeLanes lobe_lanes(const ShadowRoulette& roulette, VecF g, const VectorLanes& before,
                                VecF throughput, VecF roulette_below, VecF root) {
  const VecF one = set(1.0F);
  VecF expected = hn::Zero(kFloat);
  if (roulette.lobe_scale != 0) {
    // Two scatterings have the square of the mean cosine of one; of Henyey's and Greenstein's
    // function it is the function of that.
    const VecF turned =
        HenyeyGreensteinLanes(hn::Mul(g, g)).evaluate(before, set_vector(roulette.dominant));
    expected = hn::Mul(hn::Mul(throughput, set(roulette.lobe_scale)), turned);
  }
  const VecF worth = hn::Max(throughput, hn::Mul(expected, root));
  const VecF survival =
      hn::IfThenElse(hn::Lt(worth, roulette_below), hn::Div(worth, roulette_below), one);
  // A coarse cell may look dark of which an edge is lit.
  expected = hn::Mul(expected, hn::Max(root, set(ShadowRoulette::kLeastRoot)));
  const MaskF enough = hn::Ge(expected, set(ShadowRoulette::kLeastLobeChance));
  const VecF chance = hn::Min(hn::Div(expected, survival), one);
  // The numbers that decide have digits of 1 alone at their upper end; so do chances.
  return {survival, hn::IfThenElseZero(enough, hn::Sub(one, hn::Sub(one, chance)))};
}

/// ShadowRoulette::survival(), lane by lane.
HWY_INLINE VecF survival_lanes(const ShadowRoulette& roulette, const DominantLanes& dominant,
                               VecF brightness) {
  const VecF one = set(1.0F);
  const VecF expected = hn::Mul(brightness, hn::IfThenElse(dominant.same, dominant.root, one));
  const MaskF faint = hn::Lt(expected, set(roulette.least));
  if (hn::AllFalse(kFloat, faint)) return one;
  const VecF wanted = hn::Div(expected, set(roulette.least));
  const VecF held = hn::Min(hn::Max(wanted, set(ShadowRoulette::kLeastSurvival)), one);
  return hn::IfThenElse(faint, held, one);
}

inline void scatter_lanes(ScatteringStream& scatterings, const ShadowRoulette& roulette) {
  scatterings.cast = 0;
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const VecF g = hn::Load(kFloat, &scatterings.g[i]);
    const HenyeyGreensteinLanes phase(g);
    const VectorLanes before = vectors_at(scatterings.direction, i);
    const VectorLanes to_light = vectors_at(scatterings.to_light, i);
    const DominantLanes dominant =
        dominant_lanes(roulette, vectors_at(scatterings.position, i), to_light);
    const MaskU given = hn::Ne(hn::Load(kUint, &scatterings.is_given[i]), hn::Zero(kUint));
    const VecF value =
        hn::IfThenElse(hn::RebindMask(kFloat, given), hn::Load(kFloat, &scatterings.light_value[i]),
                       phase.evaluate(before, to_light));
    hn::Store(value, kFloat, &scatterings.light_value[i]);
    // The phase function is its own density.
    const VecF light_pdf = hn::Load(kFloat, &scatterings.light_pdf[i]);
    const VecF chance = hn::Mul(hn::Load(kFloat, &scatterings.light_found[i]), value);
    const MaskF drawn = hn::Gt(light_pdf, hn::Zero(kFloat));
    const VecF density = hn::IfThenElse(drawn, hn::Add(light_pdf, chance), set(1.0F));
    const VecF share = hn::IfThenElseZero(drawn, hn::Div(value, density));
    const VecF survival = hn::Load(kFloat, &scatterings.survival[i]);
    const VecF brightness =
        hn::Div(hn::Mul(hn::Load(kFloat, &scatterings.brightness[i]), share), survival);
    const VecF shadow_survival = survival_lanes(roulette, dominant, brightness);
    const auto is_below = [&](ScatteringNumber number, VecF chance_of_it) {
      return hn::Lt(hn::Load(kFloat, &scatterings.numbers[number][i]), chance_of_it);
    };
    const MaskF cast =
        hn::And(is_below(kRouletteNumber, survival), is_below(kShadowNumber, shadow_survival));
    const VecF weight = hn::IfThenElseZero(cast, hn::Div(share, shadow_survival));
    hn::Store(weight, kFloat, &scatterings.shadow_weight[i]);
    const MaskF some =
        hn::And(hn::Gt(weight, hn::Zero(kFloat)), hn::FirstN(kFloat, scatterings.count - i));
    scatterings.cast |= ScatteringStream::Set{bits_of(some)} << i;
    const LobeLanes lobe = lobe_lanes(
        roulette, g, before, hn::Div(hn::Load(kFloat, &scatterings.lobe_scale[i]), survival),
        hn::Load(kFloat, &scatterings.lobe_roulette[i]), dominant.root);
    hn::Store(lobe.survival, kFloat, &scatterings.lobe_survival[i]);
    hn::Store(lobe.chance, kFloat, &scatterings.lobe_chance[i]);
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

inline void send_lanes(const ScatteringStream& scatterings, ScatteringStream::Set some,
                       const std::array<ScatteringStream::Row<float>, 3>& direction,
                       uint32_t stream_step, RayStream& rays, std::size_t first) {
  constexpr ScatteringStream::Set kAllLanes = (ScatteringStream::Set{1} << kLanes) - 1;
  for (std::size_t i = 0; i < scatterings.count; i += kLanes) {
    const auto bits = static_cast<uint32_t>(some >> i & kAllLanes);
    if (bits == 0) continue;
    // Streams have room for the lanes behind.
    const Packing packing(bits);
    for (int axis = 0; axis < 3; ++axis) {
      packing.write(hn::Load(kFloat, &scatterings.position[axis][i]), &rays.origin[axis][first]);
      packing.write(hn::Load(kFloat, &direction[axis][i]), &rays.direction[axis][first]);
    }
    packing.write(hn::Load(kUint, &scatterings.pixel[i]), &rays.pixel[first]);
    packing.write(hn::Load(kUint, &scatterings.sample[i]), &rays.sample[first]);
    packing.write(hn::Add(hn::Load(kUint, &scatterings.stream[i]), hn::Set(kUint, stream_step)),
                  &rays.stream[first]);
    first += static_cast<std::size_t>(std::popcount(bits));
  }
}

inline ScatteringKernels make_scattering_kernels() {
  return {&gather_scatterings, &draw_scattering_numbers, &play_lanes,
          &aim_lanes,          &scatter_lanes,           &send_lanes};
}

}  // namespace freepath::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // FREEPATH_TRANSPORT_SCATTERING_INL_H_
