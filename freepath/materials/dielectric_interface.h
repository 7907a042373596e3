#pragma once
/// @file The interface between two dielectrics, smooth or rough.

#include <optional>

#include "freepath/materials/lobe_sample.h"
#include "freepath/materials/trowbridge_reitz.h"

namespace freepath {

/// What a path carries: radiance is divided by the square of the refractive index where it enters
/// a medium, importance (of a path that starts at a light) is not [Veach97, Sec. 5.2].
enum class TransportMode { kRadiance, kImportance };

/// Which events to draw.
enum class InterfaceEvents { kAll, kReflection, kTransmission };

/// A direction of the local frame with its z times a side, 1 or -1: what lies below the surface
/// turned to lie above, and back.
inline Vec3f with_side(const Vec3f& v, float side) { return {v.x, v.y, side * v.z}; }

struct InterfaceSample {
  Vec3f direction;
  float weight = 0;          ///< f |cosine| / density
  float pdf = 0;             ///< [1/sr]; 0 of a specular event.
  bool transmitted = false;  ///< To the other side.
};

struct InterfaceValue {
  float value = 0;  ///< f |cosine of in| [1/sr]
  float pdf = 0;    ///< [1/sr]
};

/// Reflection and refraction by the facets of an interface [Walter07], once each: light that would
/// meet a second facet is lost, as in pbrt-v4. An interface with eta 1 is not there, however rough.
class DielectricInterface {
 public:
  /// @param eta refractive index below (z < 0) relative to above
  DielectricInterface(float eta, const TrowbridgeReitz& facets)
      : eta_(eta), facets_(facets), specular_(eta == 1.0F || facets.is_smooth()) {}

  bool is_specular() const { return specular_; }
  float eta() const { return eta_; }

  /// Draws a visible normal, then reflection or transmission in proportion to Fresnel's shares.
  std::optional<InterfaceSample> sample(const Vec3f& out, RandomStream& random,
                                        InterfaceEvents events = InterfaceEvents::kAll,
                                        TransportMode mode = TransportMode::kRadiance) const;

  /// The value for two directions, with the density of sampling only these events. 0 if specular.
  InterfaceValue evaluate(const Vec3f& out, const Vec3f& in,
                          InterfaceEvents events = InterfaceEvents::kAll,
                          TransportMode mode = TransportMode::kRadiance) const;

  /// The cosine that Fresnel's equations need for a reflection from `out` to `in`.
  static float reflection_cosine(const Vec3f& out, const Vec3f& in);

  /// Refractive index of the far side relative to the side of a direction.
  float relative_eta(const Vec3f& out) const { return out.z > 0 ? eta_ : 1.0F / eta_; }

 private:
  float eta_;
  TrowbridgeReitz facets_;
  bool specular_;
};

}  // namespace freepath
