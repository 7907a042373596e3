#include "freepath/materials/layered_lobe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "freepath/materials/fresnel.h"

namespace freepath {

namespace {

/// Weight of a technique with density `own` against another [Veach97, Sec. 9.2.4].
float power_weight(float own, float other) {
  const float squared = own * own;
  return squared / (squared + other * other);
}

/// Ends walks that carry little; false if this one ends.
bool survives_roulette(SampledSpectrum& weight, int depth, RandomStream& random) {
  constexpr int kFirst = 4;
  constexpr float kLittle = 0.25F;
  const float largest = largest_magnitude(weight);
  if (depth < kFirst || !(largest < kLittle)) return true;
  if (!(random.uniform() < largest)) return false;
  weight *= 1.0F / largest;
  return true;
}

}  // namespace

/// A walk within the layers.
template <class Bottom>
struct LayeredLobe<Bottom>::State {
  SampledSpectrum weight;
  Vec3f direction;  // of travel
  float z;          // height above the bottom
};

/// How light from `in` comes through the top: one direction drawn in advance.
template <class Bottom>
struct LayeredLobe<Bottom>::Exit {
  Vec3f in;
  Vec3f direction;  // from the top down, so that walks leave along its reverse
  float factor;     // density of radiance · |cosine of in|, over that of drawing the direction
  float pdf;        // 0 if there was no choice
};

template <class Bottom>
LayeredLobe<Bottom>::LayeredLobe(const DielectricInterface& top, const Bottom& bottom,
                                 const LayerMedium& medium, const LayerWalk& walk)
    : top_(top), bottom_(bottom), medium_(medium), walk_(walk), phase_(medium.g) {
  medium_.thickness = std::max(medium_.thickness, std::numeric_limits<float>::min());
}

template <class Bottom>
float LayeredLobe<Bottom>::transmittance(float distance, const Vec3f& direction) const {
  return std::exp(-std::abs(distance / direction.z));
}

/// Moves on by a free path; true if an interface came first, which the state then lies on.
template <class Bottom>
bool LayeredLobe<Bottom>::reaches_interface(State& state, float exponential) const {
  const float z = state.z + exponential * state.direction.z;
  const bool within = z > 0 && z < medium_.thickness;
  state.z = within ? z : (state.direction.z > 0 ? medium_.thickness : 0.0F);
  return !within;
}

template <class Bottom>
std::optional<LobeSample> LayeredLobe<Bottom>::sample(const Vec3f& out,
                                                      RandomStream& random) const {
  const float side = out.z < 0 ? -1.0F : 1.0F;
  const Vec3f above = with_side(out, side);
  const std::optional<InterfaceSample> entered = top_.sample(above, random);
  if (!entered) return std::nullopt;
  // Whether evaluate() has this walk: between two specular interfaces it connects from the medium
  // straight through the top only.
  bool connected = !top_.is_specular();
  const auto left = [&](const Vec3f& in, const SampledSpectrum& weight) {
    return LobeSample{with_side(in, side), weight, connected ? approximate_pdf(above, in) : 0.0F,
                      !connected};
  };
  if (!entered->transmitted) return left(entered->direction, SampledSpectrum(entered->weight));
  State state{SampledSpectrum(entered->weight), entered->direction, medium_.thickness};
  for (int depth = 0; depth < walk_.max_depth; ++depth) {
    if (state.direction.z == 0 || !survives_roulette(state.weight, depth, random)) break;
    if (scatters()) {
      if (!reaches_interface(state, random.exponential())) {
        const float u0 = random.uniform();
        state.direction = phase_.sample(state.direction, u0, random.uniform()).direction;
        state.weight *= medium_.albedo;
        connected = true;
        continue;
      }
    } else {
      state.weight *= transmittance(medium_.thickness, state.direction);
      state.z = state.direction.z > 0 ? medium_.thickness : 0.0F;
    }
    if (state.direction.z < 0) {
      const std::optional<LobeSample> reflected = bottom_.sample(-state.direction, random);
      if (!reflected) break;
      state.weight *= reflected->weight;
      state.direction = reflected->direction;
      connected = !(top_.is_specular() && reflected->specular);
    } else {
      const std::optional<InterfaceSample> met = top_.sample(-state.direction, random);
      if (!met) break;
      state.weight *= met->weight;
      state.direction = met->direction;
      if (met->transmitted) return left(met->direction, state.weight);
    }
  }
  return std::nullopt;
}

template <class Bottom>
MaterialValue LayeredLobe<Bottom>::evaluate(const Vec3f& out, const Vec3f& in,
                                            RandomStream& random) const {
  if (!same_hemisphere(out, in)) return {};
  const float side = out.z < 0 ? -1.0F : 1.0F;
  const Vec3f above = with_side(out, side);
  const Vec3f other = with_side(in, side);
  SampledSpectrum sum;
  for (int i = 0; i < walk_.samples; ++i) sum += connected_walk(above, other, random);
  return {SampledSpectrum(top_.evaluate(above, other).value) +
              sum * (1.0F / static_cast<float>(walk_.samples)),
          approximate_pdf(above, other)};
}

/// Light that a walk from `out` brings from `in`, without what the top reflects at once. At every
/// event a connection through the top along the direction drawn in advance competes with the walk's
/// own next direction, where neither is specular [Guo18, Sec. 4].
template <class Bottom>
SampledSpectrum LayeredLobe<Bottom>::connected_walk(const Vec3f& out, const Vec3f& in,
                                                    RandomStream& random) const {
  const std::optional<InterfaceSample> entered =
      top_.sample(out, random, InterfaceEvents::kTransmission, TransportMode::kRadiance);
  if (!entered) return {};
  const std::optional<InterfaceSample> left =
      top_.sample(in, random, InterfaceEvents::kTransmission, TransportMode::kImportance);
  if (!left) return {};
  const Exit exit{in, left->direction, left->weight * in.z / std::abs(left->direction.z),
                  left->pdf};
  State state{SampledSpectrum(entered->weight), entered->direction, medium_.thickness};
  SampledSpectrum sum;
  for (int depth = 0; depth < walk_.max_depth; ++depth) {
    if (state.direction.z == 0 || !survives_roulette(state.weight, depth, random)) break;
    if (scatters()) {
      if (!reaches_interface(state, random.exponential())) {
        sum += scatter_in_medium(state, exit, random);
        continue;
      }
    } else {
      state.weight *= transmittance(medium_.thickness, state.direction);
      state.z = state.direction.z > 0 ? medium_.thickness : 0.0F;
    }
    if (state.direction.z < 0) {
      sum += scatter_at_bottom(state, exit, random);
    } else {
      const std::optional<InterfaceSample> met =
          top_.sample(-state.direction, random, InterfaceEvents::kReflection);
      state.weight *= met ? met->weight : 0.0F;
      if (met) state.direction = met->direction;
    }
    if (is_black(state.weight)) break;
  }
  return sum;
}

/// Connects from a point of the medium and draws the next direction.
template <class Bottom>
SampledSpectrum LayeredLobe<Bottom>::scatter_in_medium(State& state, const Exit& exit,
                                                       RandomStream& random) const {
  const float up = medium_.thickness - state.z;
  const float phase = phase_.evaluate(state.direction, -exit.direction);
  const float weight = top_.is_specular() ? 1.0F : power_weight(exit.pdf, phase);
  state.weight *= medium_.albedo;
  SampledSpectrum sum =
      state.weight * (phase * exit.factor * weight * transmittance(up, exit.direction));
  const float u0 = random.uniform();
  const PhaseSample next = phase_.sample(state.direction, u0, random.uniform());
  state.direction = next.direction;
  if (top_.is_specular() || next.direction.z <= 0) return sum;
  const InterfaceValue through =
      top_.evaluate(-next.direction, exit.in, InterfaceEvents::kTransmission);
  const float density = top_.evaluate(exit.in, -next.direction, InterfaceEvents::kTransmission,
                                      TransportMode::kImportance)
                            .pdf;
  if (through.value > 0) {
    sum += state.weight *
           (through.value * power_weight(next.pdf, density) * transmittance(up, next.direction));
  }
  return sum;
}

/// Connects from the bottom and draws the next direction.
template <class Bottom>
SampledSpectrum LayeredLobe<Bottom>::scatter_at_bottom(State& state, const Exit& exit,
                                                       RandomStream& random) const {
  SampledSpectrum sum;
  const Vec3f out = -state.direction;
  if (!bottom_.is_specular()) {
    const MaterialValue found = bottom_.evaluate(out, -exit.direction);
    const float weight = top_.is_specular() ? 1.0F : power_weight(exit.pdf, found.pdf);
    sum = state.weight * found.value *
          (exit.factor * weight * transmittance(medium_.thickness, exit.direction));
  }
  const std::optional<LobeSample> next = bottom_.sample(out, random);
  if (!next) {
    state.weight = SampledSpectrum();
    return sum;
  }
  state.weight *= next->weight;
  state.direction = next->direction;
  if (top_.is_specular()) return sum;
  const InterfaceValue through =
      top_.evaluate(-next->direction, exit.in, InterfaceEvents::kTransmission);
  if (!(through.value > 0)) return sum;
  float weight = 1;
  if (!bottom_.is_specular()) {
    const float density = top_.evaluate(exit.in, -next->direction, InterfaceEvents::kTransmission,
                                        TransportMode::kImportance)
                              .pdf;
    weight = power_weight(next->pdf, density);
  }
  return sum + state.weight *
                   (through.value * weight * transmittance(medium_.thickness, next->direction));
}

/// About the density of the directions that come back from below the top.
template <class Bottom>
float LayeredLobe<Bottom>::bottom_pdf(const Vec3f& out, const Vec3f& in) const {
  const float diffuse = cosine_hemisphere_pdf(in.z);
  if constexpr (std::is_same_v<Bottom, DiffuseLobe>) {
    return diffuse;
  } else {
    const float above =
        top_.is_specular() ? diffuse : top_.evaluate(out, in, InterfaceEvents::kReflection).pdf;
    if (bottom_.is_specular()) return above;
    // The bottom's density for the directions refracted by a smooth top.
    const Vec3f up(0, 0, 1);
    const float eta = top_.eta();
    const std::optional<Vec3f> out_below = refracted(out, up, eta);
    const std::optional<Vec3f> in_below = refracted(in, up, eta);
    float below = diffuse;
    if (out_below && in_below) {
      below = bottom_.evaluate(-*out_below, -*in_below).pdf * in.z /
              (eta * eta * std::abs(in_below->z));
    }
    return top_.is_specular() ? below : 0.5F * (above + below);
  }
}

template <class Bottom>
float LayeredLobe<Bottom>::approximate_pdf(const Vec3f& out, const Vec3f& in) const {
  // Some of it uniform, so that no direction is weighted as if it could not be drawn.
  constexpr float kUniformShare = 0.1F;
  constexpr float kUniform = 0.5F * std::numbers::inv_pi_v<float>;
  const float reflected_share = fresnel_dielectric(out.z, top_.eta());
  const float lobes = top_.evaluate(out, in).pdf + (1.0F - reflected_share) * bottom_pdf(out, in);
  return kUniformShare * kUniform + (1.0F - kUniformShare) * lobes;
}

template class LayeredLobe<DiffuseLobe>;
template class LayeredLobe<ConductorLobe>;

}  // namespace freepath
