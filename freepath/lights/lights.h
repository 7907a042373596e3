#pragma once
/// @file All light that comes from outside the scene: one environment and perhaps a sun.

#include <optional>
#include <variant>

#include "freepath/base/spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/lights/environment.h"
#include "freepath/lights/sun.h"

namespace freepath {

/// A constant environment, or an image (the daylight sky is one).
using Environment = std::variant<ConstantEnvironment, ImageEnvironment>;

/// A direction drawn towards the lights.
struct LightSample {
  Vec3f direction;    ///< Unit vector from the scene to the light [world].
  Spectrum radiance;  ///< Of all lights together, from this direction.
  float pdf;          ///< Density of the whole mixture [1/sr]; with 0 the sample is to be dropped.
};

/// The lights as one: sun and environment add up in a direction, and a sample's density is that of
/// the mixture of both, so multiple importance sampling against the phase function is a single
/// evaluation. Immutable; threads share it freely.
class Lights {
 public:
  explicit Lights(Environment environment, const std::optional<Sun>& sun = {});

  /// Radiance that a ray which escapes in this direction sees, and the density of `sample` there.
  LightValue evaluate(const Vec3f& direction) const {
    LightValue value = environment_value(direction);
    value.pdf *= 1.0F - sun_share_;
    if (sun_ && sun_->contains(direction)) {
      value.radiance += sun_->radiance();
      value.pdf += sun_share_ * sun_->pdf();
    }
    return value;
  }
  Spectrum radiance(const Vec3f& direction) const { return evaluate(direction).radiance; }
  /// [1/sr]
  float pdf(const Vec3f& direction) const { return evaluate(direction).pdf; }

  /// Draws a direction: u2 chooses between sun and environment, u0 and u1 the direction. Radiance
  /// and density are those that `evaluate` returns for it.
  LightSample sample(float u0, float u1, float u2) const {
    const Vec3f direction = u2 < sun_share_ ? sun_->sample(u0, u1) : sample_environment(u0, u1);
    const LightValue value = evaluate(direction);
    return {direction, value.radiance, value.pdf};
  }

  /// Whether no light comes from anywhere, so that sampling it is in vain.
  bool is_dark() const { return dark_; }
  /// Probability of choosing the sun.
  float sun_share() const { return sun_share_; }
  const std::optional<Sun>& sun() const { return sun_; }

 private:
  LightValue environment_value(const Vec3f& direction) const {
    const auto* image = std::get_if<ImageEnvironment>(&environment_);
    return image ? image->evaluate(direction)
                 : std::get_if<ConstantEnvironment>(&environment_)->evaluate(direction);
  }
  Vec3f sample_environment(float u0, float u1) const {
    const auto* image = std::get_if<ImageEnvironment>(&environment_);
    return image ? image->sample(u0, u1)
                 : std::get_if<ConstantEnvironment>(&environment_)->sample(u0, u1);
  }

  Environment environment_;
  std::optional<Sun> sun_;
  float sun_share_ = 0;
  bool dark_ = false;
};

}  // namespace freepath
