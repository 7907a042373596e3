#pragma once
/// @file All lights of a scene, as its paths see them.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/base/direction_disc.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/geometry/surface_point.h"
#include "freepath/lights/infinite_lights.h"
#include "freepath/lights/light_descriptions.h"
#include "freepath/lights/light_sample.h"
#include "freepath/lights/light_sampler.h"
#include "freepath/lights/punctual_light.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The lights of a scene: drawn for a point by `sample`, found by rays with `escape` and `hit`,
/// whose densities are those of `sample`. Directions are unit vectors; positions are relative to
/// the origin of the rays. Immutable; threads share it freely, and nothing that is called per path
/// throws, locks or allocates.
///
/// A draw chooses evenly among the kinds of light to draw: all from outside of the scene but
/// parallel light, parallel light, and lights within. How much of each arrives depends on what
/// shadows it, so that no share by power would be safe. Among parallel lights it chooses by
/// illuminance, among those within as LightSampler does.
class SceneLights {
 public:
  /// @param table holds the spectra of the descriptions
  /// @throws Error that names the light, for what cannot be one
  SceneLights(SceneLightsDescription description, const SpectrumTable& table);

  /// A direction from which light arrives at a position, were nothing in between. u2 chooses the
  /// light, u0 and u1 the direction; all in [0, 1).
  LightSample sample(const Vec3f& position, const SpectrumValues& values, float u0, float u1,
                     float u2) const;

  /// Lights within the scene, punctual ones first, then the parts of area lights; those without
  /// power are never drawn.
  const std::vector<LightBounds>& within() const { return within_; }
  /// A draw of one of those lights: its density is that of the direction given the light, 1 of a
  /// light without extent.
  /// @param light of within()
  LightSample sample_of(uint32_t light, const Vec3f& position, const SpectrumValues& values,
                        float u0, float u1) const;
  /// The probability with which sample() draws one of those lights at a position.
  float share_of(uint32_t light, const Vec3f& position) const {
    return within_share_ * chooser_.probability(position, light);
  }

  /// What a ray sees that leaves the scene.
  /// @param in_image what image_around() shows there, if that is known; null: it is looked up
  LightSeen escape(const Vec3f& from, const Vec3f& direction, const SpectrumValues& values,
                   const LightValue* in_image = nullptr) const {
    LightSeen seen = infinite_.evaluate(from, direction, values, in_image);
    seen.pdf *= infinite_share_;
    return seen;
  }
  /// The image around the scene in which many escapes can be looked up together; null if there is
  /// none, or several.
  const ImageEnvironment* image_around() const { return infinite_.only_image(); }

  /// What a ray from `from` sees of an area light that it hits.
  /// @param light of SceneLightsDescription::area_lights
  LightSeen hit(const Vec3f& from, uint32_t light, const SurfacePoint& point,
                const SpectrumValues& values) const;

  /// The radiance alone, for rays whose hits are not weighted.
  SampledSpectrum emitted(uint32_t light, const SurfacePoint& point, const Vec3f& towards,
                          const SpectrumValues& values) const;

  /// Luminance of the integral over all directions of the light from outside of the scene, were
  /// nothing in between.
  double fluence() const { return infinite_.fluence() + distant_illuminance_; }

  /// Whether there is a light to draw.
  bool is_drawn() const { return infinite_.is_drawn() || !distant_.empty() || !chooser_.is_dark(); }

  /// A light that all draws are of, wherever they are made: their radiance and density are always
  /// the same.
  struct OnlyLight {
    Vec3f towards;   ///< Direction towards its middle, unit [world].
    float distance;  ///< LightSample::distance.
    float pdf;       ///< LightSample::pdf.
    const DirectionDisc*
        disc;  ///< Directions of draws; null: all have the one, and no ray finds it.
  };
  /// The light that all draws are of; none if there are others to draw, or nothing.
  std::optional<OnlyLight> only_light() const;
  /// Radiance of that light, LightSample::radiance. Only where only_light() has a value.
  SampledSpectrum only_radiance(const SpectrumValues& values) const;

 private:
  /// Light from one direction.
  struct Distant {
    Vec3f towards;  ///< Direction towards it, unit [world].
    SpectrumId radiance;
    float scale;     ///< Factor of that spectrum.
    float share;     ///< Probability of drawing it among lights of this kind.
    float distance;  ///< LightSample::distance.
  };
  struct Emission {
    SpectrumId radiance;
    bool two_sided = false;
    int width = 0, height = 0;
    std::vector<Vec3f> colours;  // of an image, in place of the spectrum
  };
  struct Area {
    std::shared_ptr<const EmitterGeometry> geometry;
    uint32_t emission;
    uint32_t first_part;  // of parts_
    bool reversed, invisible;
  };
  /// A light of its own.
  struct Part {
    uint32_t area;
    float scale;
  };

  void add(const DistantLight& light, const SpectrumTable& table);
  std::vector<LightBounds> add_area_lights(const SceneLightsDescription& description,
                                           const SpectrumTable& table);
  void set_shares();
  static Emission make_emission(const AreaEmission& description);

  SampledSpectrum radiance(const Part& part, const Vec3f& normal, float u, float v,
                           const Vec3f& towards, const SpectrumValues& values) const;
  LightSample sample_distant(const SpectrumValues& values, float u) const;
  LightSample sample_within(const Vec3f& position, const SpectrumValues& values, float u0, float u1,
                            float u2) const;

  InfiniteLights infinite_;
  std::vector<Distant> distant_;
  std::vector<PunctualLight> punctual_;
  std::vector<Emission> emissions_;
  std::vector<Area> areas_;
  std::vector<Part> parts_;
  std::vector<LightBounds> within_;  // of punctual lights, then parts
  LightSampler chooser_;             // of those
  double distant_illuminance_ = 0;
  float infinite_share_ = 0, distant_share_ = 0, within_share_ = 0;
};

}  // namespace freepath
