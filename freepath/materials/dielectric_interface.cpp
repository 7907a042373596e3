#include "freepath/materials/dielectric_interface.h"

#include <cmath>

#include "freepath/materials/fresnel.h"

namespace freepath {

namespace {

/// How likely each event is to be drawn; both 0 if there is none.
struct EventShares {
  float reflection, transmission;

  EventShares(float reflected, InterfaceEvents events)
      : reflection(events == InterfaceEvents::kTransmission ? 0.0F : reflected),
        transmission(events == InterfaceEvents::kReflection ? 0.0F : 1.0F - reflected) {
    const float sum = reflection + transmission;
    if (sum > 0) {
      reflection /= sum;
      transmission /= sum;
    }
  }
  bool none() const { return !(reflection + transmission > 0); }
};

/// What refraction does to radiance.
float refraction_scale(float eta, TransportMode mode) {
  return mode == TransportMode::kRadiance ? 1.0F / (eta * eta) : 1.0F;
}

/// Density of normals over that of refracted directions [Walter07, Eq. 17].
float refraction_jacobian(float cosine_out, float cosine_in, float eta) {
  const float root = cosine_in + cosine_out / eta;
  return std::abs(cosine_in) / (root * root);
}

}  // namespace

float DielectricInterface::reflection_cosine(const Vec3f& out, const Vec3f& in) {
  return std::abs(out.dot((out + in).normalized()));
}

std::optional<InterfaceSample> DielectricInterface::sample(const Vec3f& out, RandomStream& random,
                                                           InterfaceEvents events,
                                                           TransportMode mode) const {
  if (out.z == 0) return std::nullopt;
  const float eta = relative_eta(out);
  const float side = out.z > 0 ? 1.0F : -1.0F;
  const Vec3f above = with_side(out, side);
  Vec3f facet(0, 0, 1);
  if (!specular_) {
    const float u0 = random.uniform();
    facet = facets_.sample_visible(above, u0, random.uniform());
  }
  const float cosine = above.dot(facet);
  if (cosine <= 0) return std::nullopt;
  const float reflectance = fresnel_dielectric(cosine, eta);
  const EventShares shares(reflectance, events);
  if (shares.none()) return std::nullopt;
  const float normal_pdf = specular_ ? 0.0F : facets_.visible_density(above, facet);
  if (!specular_ && !(normal_pdf > 0)) return std::nullopt;

  if (random.uniform() < shares.reflection) {
    const Vec3f in = reflected(above, facet);
    if (in.z <= 0) return std::nullopt;
    const float masking = specular_ ? 1.0F : facets_.masking_of_other(above, in);
    return InterfaceSample{with_side(in, side), reflectance / shares.reflection * masking,
                           normal_pdf / (4.0F * cosine) * shares.reflection, false};
  }
  const std::optional<Vec3f> in = refracted(above, facet, eta);
  if (!in || in->z >= 0) return std::nullopt;
  const float masking = specular_ ? 1.0F : facets_.masking_of_other(above, *in);
  const float pdf = specular_ ? 0.0F
                              : normal_pdf * refraction_jacobian(cosine, in->dot(facet), eta) *
                                    shares.transmission;
  return InterfaceSample{
      with_side(*in, side),
      (1.0F - reflectance) / shares.transmission * masking * refraction_scale(eta, mode), pdf,
      true};
}

InterfaceValue DielectricInterface::evaluate(const Vec3f& out, const Vec3f& in,
                                             InterfaceEvents events, TransportMode mode) const {
  if (specular_ || out.z == 0 || in.z == 0) return {};
  const float eta = relative_eta(out);
  const float side = out.z > 0 ? 1.0F : -1.0F;
  const Vec3f above = with_side(out, side);
  const Vec3f other = with_side(in, side);
  const bool reflection = other.z > 0;
  // Refraction: cosine_out = -eta · cosine_in, along the normal [Walter07, Eq. 16].
  Vec3f facet = reflection ? above + other : above + other * eta;
  if (facet.length2() == 0) return {};
  facet.normalize();
  if (facet.z < 0) facet = -facet;
  const float cosine_out = above.dot(facet);
  const float cosine_in = other.dot(facet);
  if (!(cosine_out > 0) || (cosine_in > 0) != reflection) return {};
  const float reflectance = fresnel_dielectric(cosine_out, eta);
  const EventShares shares(reflectance, events);
  const float normal_pdf = facets_.visible_density(above, facet);
  const float masking = facets_.masking_of_other(above, other);
  if (reflection) {
    const float density = normal_pdf / (4.0F * cosine_out);
    return {density * reflectance * masking, density * shares.reflection};
  }
  const float density = normal_pdf * refraction_jacobian(cosine_out, cosine_in, eta);
  return {density * (1.0F - reflectance) * masking * refraction_scale(eta, mode),
          density * shares.transmission};
}

}  // namespace freepath
