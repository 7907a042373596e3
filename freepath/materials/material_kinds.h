#pragma once
/// @file The kinds of materials as plain data. Names, parameters and meaning are those of pbrt-v4.
///
/// Each kind scatters in the frame of the surface (lobe_sample.h); Material brings directions there
/// and back. A refractive index is that of the inside relative to the outside, where the normal
/// points. Dielectrics take theirs with SpectrumRole::kIndex, which has one value in R, G, B;
/// conductors with kReflectance, so that metals are coloured in R, G, B.

#include <memory>
#include <optional>
#include <variant>

#include "freepath/base/random.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/surface_point.h"
#include "freepath/materials/lobe_sample.h"
#include "freepath/materials/surface_context.h"
#include "freepath/materials/textures/texture.h"

namespace freepath {

class Material;

/// Roughness along u and v.
struct Roughness {
  FloatInput u = 0.0F, v = 0.0F;
  bool remap = true;  ///< alpha is the square root of the roughness, else the roughness itself.

  /// Whether it is smooth at every point.
  bool is_smooth() const;
};

/// `diffuse`: the same radiance to all directions.
struct DiffuseMaterial {
  SpectrumInput reflectance;

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  static bool is_specular() { return false; }
  static bool transmits() { return false; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// `diffusetransmission`: the same radiance to all directions on either side, as paper and leaves
/// do. Where both parts together are above 1 it is brighter than its light, as in pbrt-v4.
struct DiffuseTransmissionMaterial {
  SpectrumInput reflectance, transmittance;
  float scale = 1;  ///< Factor of both.

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  static bool is_specular() { return false; }
  static bool transmits() { return true; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// The refractive index eta + i k of a metal.
struct ComplexIndex {
  SpectrumInput eta, k;
};
/// What a metal reflects at normal incidence: eta is 1, and k follows from it.
struct NormalReflectance {
  SpectrumInput reflectance;
};
using ConductorIndex = std::variant<ComplexIndex, NormalReflectance>;

/// `conductor`: a smooth or rough metal, the same on both sides.
struct ConductorMaterial {
  ConductorIndex index;
  Roughness roughness;

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  bool is_specular() const { return roughness.is_smooth(); }
  static bool transmits() { return false; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// `dielectric`: a smooth or rough interface between media. Where its index differs between the
/// channels, they part at refraction and only the hero goes on; reflections keep all.
struct DielectricMaterial {
  SpectrumId eta;
  Roughness roughness;

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  bool is_specular() const { return roughness.is_smooth(); }
  static bool transmits() { return true; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// `thindielectric`: a pane whose two interfaces are one surface. Nothing is displaced, so that
/// channels never part.
struct ThinDielectricMaterial {
  SpectrumId eta;

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  static bool is_specular() { return true; }
  static bool transmits() { return true; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// A dielectric layer on top of something, with a medium in it.
struct Coating {
  SpectrumId eta;
  Roughness roughness;
  FloatInput thickness = 0.01F;  ///< Thickness in mean free paths.
  SpectrumInput albedo;          ///< Albedo of the medium; where black it only absorbs.
  FloatInput g = 0.0F;           ///< Mean cosine of the medium's phase function.
  int max_depth = 10;            ///< Interactions within the layer.
  int samples = 1;               ///< Walks for each evaluation.
};

/// `coateddiffuse`, the same on both sides.
struct CoatedDiffuseMaterial {
  Coating coating;
  SpectrumInput reflectance;

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  static bool is_specular() { return false; }
  static bool transmits() { return false; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// `coatedconductor`, the same on both sides.
struct CoatedConductorMaterial {
  Coating coating;
  ConductorIndex index;  ///< Relative to vacuum.
  Roughness roughness;   ///< Roughness of the conductor.

  std::optional<LobeSample> sample(const Vec3f& out, RandomStream& random,
                                   const SurfacePoint& point, const SurfaceContext& context) const;
  MaterialValue evaluate(const Vec3f& out, const Vec3f& in, RandomStream& random,
                         const SurfacePoint& point, const SurfaceContext& context) const;
  bool is_specular() const;
  static bool transmits() { return false; }
  SampledSpectrum albedo(const Vec3f& out, const SurfacePoint& point,
                         const SurfaceContext& context) const;
};

/// `mix`: at each hit one of two materials, the second with the probability `amount`. Null is an
/// interface, where paths go on as if there were no surface.
struct MixMaterial {
  std::shared_ptr<const Material> first, second;
  FloatInput amount = 0.5F;
};

}  // namespace freepath
