#include "freepath/materials/conductor_lobe.h"

#include <algorithm>
#include <cmath>

#include "freepath/materials/fresnel.h"

namespace freepath {

SampledSpectrum ConductorLobe::reflectance(float cosine) const {
  SampledSpectrum result;
  for (int i = 0; i < kMaxChannels; ++i) {
    result[i] = fresnel_conductor(cosine, std::max(0.0F, eta_[i]), std::max(0.0F, k_[i]));
  }
  return result;
}

std::optional<LobeSample> ConductorLobe::sample(const Vec3f& out, RandomStream& random) const {
  if (out.z == 0) return std::nullopt;
  if (is_specular()) {
    return LobeSample{{-out.x, -out.y, out.z}, reflectance(std::abs(out.z)), 0, true};
  }
  // Seen from above; the surface is the same on both sides.
  const float side = out.z < 0 ? -1.0F : 1.0F;
  const Vec3f above(out.x, out.y, std::abs(out.z));
  const float u0 = random.uniform();
  const Vec3f facet = facets_.sample_visible(above, u0, random.uniform());
  const Vec3f in = reflected(above, facet);
  const float cosine = above.dot(facet);
  if (in.z <= 0 || cosine <= 0) return std::nullopt;
  const float pdf = facets_.visible_density(above, facet) / (4.0F * cosine);
  if (!(pdf > 0)) return std::nullopt;
  return LobeSample{
      {in.x, in.y, side * in.z}, reflectance(cosine) * facets_.masking_of_other(above, in), pdf};
}

MaterialValue ConductorLobe::evaluate(const Vec3f& out, const Vec3f& in) const {
  if (is_specular() || !same_hemisphere(out, in)) return {};
  const Vec3f above(out.x, out.y, std::abs(out.z));
  const Vec3f other(in.x, in.y, std::abs(in.z));
  const Vec3f facet = (above + other).normalized();
  const float cosine = above.dot(facet);
  if (!(cosine > 0)) return {};
  const float pdf = facets_.visible_density(above, facet) / (4.0F * cosine);
  return {reflectance(cosine) * (pdf * facets_.masking_of_other(above, other)), pdf};
}

}  // namespace freepath
