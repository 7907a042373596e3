#include "freepath/render/materials/material.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "freepath/base/error.h"
#include "freepath/render/materials/surface_frame.h"

namespace freepath {

namespace {

/// Uniform in [0, 1), by place, direction and how deep a mix lies within mixes.
float hashed_uniform(const SurfacePoint& point, const Vec3f& travel, uint32_t depth) {
  const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
  const std::array<uint32_t, 4> place = philox(
      {bits(point.position.x), bits(point.position.y), bits(point.position.z), point.primitive},
      {point.shape, depth});
  const std::array<uint32_t, 4> mixed =
      philox({place[0], place[1], bits(travel.x), bits(travel.y)}, {bits(travel.z), place[2]});
  return uniform_from_bits(mixed[0]);
}

void check_coating(const Coating& coating) {
  if (coating.samples < 1) {
    fail("a coated material has nsamples {}; it must be at least 1", coating.samples);
  }
  if (coating.max_depth < 1) {
    fail("a coated material has maxdepth {}; it must be at least 1", coating.max_depth);
  }
}

template <class Kind>
constexpr bool kIsMix = std::is_same_v<Kind, MixMaterial>;

}  // namespace

void Material::check() const {
  if (const auto* const mix = std::get_if<MixMaterial>(&kind_)) {
    if (!mix->first || !mix->second) fail("a mix needs two materials");
  } else if (const auto* const diffuse = std::get_if<CoatedDiffuseMaterial>(&kind_)) {
    check_coating(diffuse->coating);
  } else if (const auto* const conductor = std::get_if<CoatedConductorMaterial>(&kind_)) {
    check_coating(conductor->coating);
  }
}

const Material& Material::resolved(const SurfacePoint& point, const Vec3f& travel,
                                   const SurfaceContext& context) const {
  const Material* material = this;
  for (uint32_t depth = 0;; ++depth) {
    const auto* const mix = std::get_if<MixMaterial>(&material->kind_);
    if (mix == nullptr) return *material;
    const float amount = context.textures.evaluate(mix->amount, point);
    const bool first = hashed_uniform(point, travel, depth) >= amount;
    material = first ? mix->first.get() : mix->second.get();
  }
}

std::optional<MaterialSample> Material::sample(const SurfacePoint& point, const Vec3f& travel,
                                               RandomStream& random,
                                               const SurfaceContext& context) const {
  const SurfaceFrame frame(point, travel);
  const Vec3f out = frame.to_local(-travel);
  if (!frame.on_side(out, -travel)) return std::nullopt;
  const std::optional<LobeSample> drawn = std::visit(
      [&]<class T>(const T& kind) -> std::optional<LobeSample> {
        if constexpr (kIsMix<T>) {
          return std::nullopt;
        } else {
          return kind.sample(out, random, point, context);
        }
      },
      resolved(point, travel, context).kind_);
  if (!drawn) return std::nullopt;
  const Vec3f next = frame.to_world(drawn->direction);
  if (!frame.on_side(drawn->direction, next)) return std::nullopt;
  return MaterialSample{next,
                        drawn->weight,
                        drawn->pdf,
                        drawn->specular,
                        frame.crosses(travel, next),
                        drawn->hero_only};
}

MaterialValue Material::evaluate(const SurfacePoint& point, const Vec3f& travel, const Vec3f& next,
                                 RandomStream& random, const SurfaceContext& context) const {
  const SurfaceFrame frame(point, travel);
  const Vec3f out = frame.to_local(-travel);
  const Vec3f in = frame.to_local(next);
  if (!frame.on_side(out, -travel) || !frame.on_side(in, next)) return {};
  return std::visit(
      [&]<class T>(const T& kind) -> MaterialValue {
        if constexpr (kIsMix<T>) {
          return {};
        } else {
          return kind.evaluate(out, in, random, point, context);
        }
      },
      resolved(point, travel, context).kind_);
}

bool Material::is_specular() const {
  return std::visit(
      []<class T>(const T& kind) {
        if constexpr (kIsMix<T>) {
          return kind.first->is_specular() && kind.second->is_specular();
        } else {
          return kind.is_specular();
        }
      },
      kind_);
}

bool Material::transmits() const {
  return std::visit(
      []<class T>(const T& kind) {
        if constexpr (kIsMix<T>) {
          return kind.first->transmits() || kind.second->transmits();
        } else {
          return kind.transmits();
        }
      },
      kind_);
}

Channels Material::albedo(const SurfacePoint& point, const Vec3f& travel,
                          const SurfaceContext& context) const {
  return std::visit(
      [&]<class T>(const T& kind) {
        if constexpr (kIsMix<T>) {
          const float amount =
              std::clamp(context.textures.evaluate(kind.amount, point), 0.0F, 1.0F);
          return kind.first->albedo(point, travel, context) * (1.0F - amount) +
                 kind.second->albedo(point, travel, context) * amount;
        } else {
          return kind.albedo(SurfaceFrame(point, travel).to_local(-travel), point, context);
        }
      },
      kind_);
}

}  // namespace freepath
