#include <cmath>

#include "freepath/materials/inputs.h"
#include "freepath/materials/material_kinds.h"

namespace freepath {

std::optional<LobeSample> ConductorMaterial::sample(const Vec3f& out, RandomStream& random,
                                                    const SurfacePoint& point,
                                                    const SurfaceContext& context) const {
  return conductor_at(index, roughness, 1, point, context).sample(out, random);
}

MaterialValue ConductorMaterial::evaluate(const Vec3f& out, const Vec3f& in,
                                          RandomStream& /*random*/, const SurfacePoint& point,
                                          const SurfaceContext& context) const {
  return conductor_at(index, roughness, 1, point, context).evaluate(out, in);
}

SampledSpectrum ConductorMaterial::albedo(const Vec3f& out, const SurfacePoint& point,
                                          const SurfaceContext& context) const {
  return conductor_at(index, roughness, 1, point, context).reflectance(std::abs(out.z));
}

}  // namespace freepath
