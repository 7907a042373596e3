#include "freepath/materials/material.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <unordered_map>

#include "freepath/base/error.h"
#include "freepath/materials/surface_frame.h"

namespace freepath {

namespace {

/// Uniform in [0, 1), by place, direction and how deep a mix lies within mixes.
float hashed_uniform(const SurfacePoint& point, const Vec3f& travel, uint32_t depth) {
  const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
  const std::array<uint32_t, 4> words = philox(
      {bits(point.position.x), bits(point.position.y), bits(point.position.z), point.primitive},
      {point.shape, depth});
  const std::array<uint32_t, 4> mixed =
      philox({words[0], words[1], bits(travel.x), bits(travel.y)}, {bits(travel.z), words[2]});
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

Material::Material(Kind kind) : kind_(std::move(kind)) {
  check();
  if (const auto* const mix = std::get_if<MixMaterial>(&kind_)) {
    is_specular_ = true;
    for (const Material* const part : {mix->first.get(), mix->second.get()}) {
      is_specular_ = is_specular_ && (part == nullptr || part->is_specular());
      transmits_ = transmits_ || part == nullptr || part->transmits();
      has_holes_ = has_holes_ || part == nullptr || part->has_holes();
    }
    return;
  }
  std::visit(
      [this]<class T>(const T& kind) {
        if constexpr (!kIsMix<T>) {
          is_specular_ = kind.is_specular();
          transmits_ = kind.transmits();
        }
      },
      kind_);
}

void Material::check() const {
  if (const auto* const mix = std::get_if<MixMaterial>(&kind_)) {
    if (!mix->first && !mix->second) fail("a mix needs a material");
  } else if (const auto* const diffuse = std::get_if<CoatedDiffuseMaterial>(&kind_)) {
    check_coating(diffuse->coating);
  } else if (const auto* const conductor = std::get_if<CoatedConductorMaterial>(&kind_)) {
    check_coating(conductor->coating);
  }
}

const Material* Material::resolved(const SurfacePoint& point, const Vec3f& travel,
                                   const SurfaceContext& context) const {
  const Material* material = this;
  for (uint32_t depth = 0; material != nullptr; ++depth) {
    const auto* const mix = std::get_if<MixMaterial>(&material->kind_);
    if (mix == nullptr) break;
    const float amount = context.textures.evaluate(mix->amount, point);
    const bool first = hashed_uniform(point, travel, depth) >= amount;
    material = first ? mix->first.get() : mix->second.get();
  }
  return material;
}

std::optional<MaterialSample> Material::sample(const SurfacePoint& point, const Vec3f& travel,
                                               RandomStream& random,
                                               const SurfaceContext& context) const {
  const SurfaceFrame frame(point, travel);
  const Vec3f out = frame.to_local(-travel);
  if (!frame.on_side(out, -travel)) return std::nullopt;
  const Material* const chosen = resolved(point, travel, context);
  if (chosen == nullptr) return MaterialSample{travel, SampledSpectrum(1), 0, true, true, false};
  const std::optional<LobeSample> drawn = std::visit(
      [&]<class T>(const T& kind) -> std::optional<LobeSample> {
        if constexpr (kIsMix<T>) {
          return std::nullopt;
        } else {
          return kind.sample(out, random, point, context);
        }
      },
      chosen->kind_);
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
  const Material* const chosen = resolved(point, travel, context);
  if (chosen == nullptr) return {};
  return std::visit(
      [&]<class T>(const T& kind) -> MaterialValue {
        if constexpr (kIsMix<T>) {
          return {};
        } else {
          return kind.evaluate(out, in, random, point, context);
        }
      },
      chosen->kind_);
}

namespace {

/// Albedos at a point, of materials that are parts of others found once.
class AlbedoFinder {
 public:
  AlbedoFinder(const SurfacePoint& point, const Vec3f& travel, const SurfaceContext& context)
      : point_(point), travel_(travel), context_(context) {}

  SampledSpectrum find(const Material* material) {
    if (material == nullptr) return SampledSpectrum(1);  // what passes is not lost
    const auto* const mix = std::get_if<MixMaterial>(&material->kind());
    if (mix == nullptr) {
      ++visited_;
      const Vec3f out = SurfaceFrame(point_, travel_).to_local(-travel_);
      return std::visit(
          [&]<class T>(const T& kind) -> SampledSpectrum {
            if constexpr (kIsMix<T>) {
              return {};
            } else {
              return kind.albedo(out, point_, context_);
            }
          },
          material->kind());
    }
    const auto known = mixes_.find(material);
    if (known != mixes_.end()) return known->second;
    ++visited_;
    const float amount = std::clamp(context_.textures.evaluate(mix->amount, point_), 0.0F, 1.0F);
    const SampledSpectrum mean =
        find(mix->first.get()) * (1.0F - amount) + find(mix->second.get()) * amount;
    mixes_.emplace(material, mean);
    return mean;
  }
  uint64_t visited() const { return visited_; }

 private:
  const SurfacePoint& point_;
  const Vec3f& travel_;
  const SurfaceContext& context_;
  std::unordered_map<const Material*, SampledSpectrum> mixes_;
  uint64_t visited_ = 0;
};

}  // namespace

SampledSpectrum Material::albedo(const SurfacePoint& point, const Vec3f& travel,
                                 const SurfaceContext& context, uint64_t* visited) const {
  AlbedoFinder finder(point, travel, context);
  const SampledSpectrum albedo = finder.find(this);
  if (visited != nullptr) *visited += finder.visited();
  return albedo;
}

}  // namespace freepath
