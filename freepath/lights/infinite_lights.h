#pragma once
/// @file All light from outside of the scene.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "freepath/base/sampled_spectrum.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/light_descriptions.h"
#include "freepath/lights/light_frame.h"
#include "freepath/lights/light_sample.h"
#include "freepath/lights/octahedral_environment.h"
#include "freepath/lights/portal.h"
#include "freepath/lights/sun.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The lights from outside of the scene as one, but those of a single direction: their radiances
/// add up, and the density of a direction is that of the mixture of them all. Hence a single
/// evaluation is needed for multiple importance sampling. Immutable; threads share it freely.
///
/// A light that is the same from everywhere is never drawn: a path that escapes finds it by itself,
/// and no draw could choose better than a phase function or a material does. Nor is an image that
/// varies little; of others, what is above the mean is drawn. A portal changes that. Draws of the
/// others are not asked what the undrawn show in their direction: that is left to escapes alone.
class InfiniteLights {
 public:
  /// Lights of each kind; those that are black are left out.
  void add(const ConstantInfiniteLight& light, const Vec3d& origin, const SpectrumTable& table);
  void add(ImageInfiniteLight light, const Vec3d& origin);
  void add(EnvironmentLight light);
  void add(const SunLight& light);
  /// To be called after the last light.
  void finish();

  /// Luminance of the integral of the radiance over all directions.
  double fluence() const { return fluence_; }
  /// Whether there is something to draw.
  bool is_drawn() const { return is_drawn_; }

  /// Radiance that an escaping ray sees, and the density of `sample` in its direction [1/sr].
  /// @param in_image what only_image() shows there, if that is known; null: it is looked up
  LightSeen evaluate(const Vec3f& from, const Vec3f& direction, const SpectrumValues& values,
                     const LightValue* in_image = nullptr) const;
  /// A draw of all lights together that are drawn, of density 0 if there is none.
  LightSample sample(const Vec3f& from, const SpectrumValues& values, float u0, float u1,
                     float u2) const;

  /// The image in latitude-longitude form whose directions are those of the world, if there is one
  /// alone, so that many can be looked up together. Else null.
  const ImageEnvironment* only_image() const;

  /// The sun, if it alone is drawn: draws differ in the point of its disc then. Else null.
  const Sun* only_sun() const;
  /// Radiance of that sun in the channels. Only where only_sun() is not null.
  SampledSpectrum only_radiance(const SpectrumValues& values) const;

 private:
  /// What shines the same from everywhere.
  struct Constant {
    SpectrumId radiance;
  };
  using Radiance = std::variant<Constant, OctahedralEnvironment, ImageEnvironment, Sun>;
  struct Light {
    Radiance radiance;
    float scale = 1;
    std::optional<LightFrame> frame = {};  // none where it is that of the world
    std::optional<Portal> portal = {};
    double importance = 0;
    float share = 0;  // probability of drawing it

    bool is_drawn = true;
  };

  /// Radiance of a light in the channels.
  static SampledSpectrum radiance_of(const Light& light, const LightValue& value,
                                     const SpectrumValues& values);
  /// Radiance and density that a light has as if it had neither frame nor portal; of constant light
  /// the density alone.
  static LightValue plain_value(const Light& light, const Vec3f& towards);
  /// Direction drawn of such a light, with both.
  static LightDirection sample_plain(const Light& light, float u0, float u1);
  /// Adds what a light shows, its density times its share.
  /// @param known plain_value() there; null: it is looked up
  static void add_seen(const Light& light, const Vec3f& from, const Vec3f& direction,
                       const SpectrumValues& values, LightSeen& all,
                       const LightValue* known = nullptr);
  static bool is_plain_image(const Light& light) {
    return std::holds_alternative<ImageEnvironment>(light.radiance) && !light.frame &&
           !light.portal;
  }
  /// Decides what of a light is drawn.
  void choose_draws(Light& light) const;
  /// The one light that is drawn; null if there are several, or none.
  const Light* only_drawn() const;

  std::vector<Light> lights_;
  std::size_t only_image_ = SIZE_MAX;  // among them
  bool is_drawn_ = false;
  double fluence_ = 0;
};

}  // namespace freepath
