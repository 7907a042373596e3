#include "freepath/materials/diffuse_lobe.h"
#include "freepath/materials/inputs.h"
#include "freepath/materials/material_kinds.h"

namespace freepath {

std::optional<LobeSample> DiffuseMaterial::sample(const Vec3f& out, RandomStream& random,
                                                  const SurfacePoint& point,
                                                  const SurfaceContext& context) const {
  return DiffuseLobe(reflectance_at(reflectance, point, context)).sample(out, random);
}

MaterialValue DiffuseMaterial::evaluate(const Vec3f& out, const Vec3f& in, RandomStream& /*random*/,
                                        const SurfacePoint& point,
                                        const SurfaceContext& context) const {
  return DiffuseLobe(reflectance_at(reflectance, point, context)).evaluate(out, in);
}

SampledSpectrum DiffuseMaterial::albedo(const Vec3f& /*out*/, const SurfacePoint& point,
                                        const SurfaceContext& context) const {
  return reflectance_at(reflectance, point, context);
}

}  // namespace freepath
