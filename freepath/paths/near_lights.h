#pragma once
/// @file Lights in or near media, and distances drawn along rays that pass them.

#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/paths/media_set.h"
#include "freepath/paths/sample_spectra.h"

namespace freepath {

/// Lights of small extent with the ball around each in which a medium leaves their light to lines:
/// scatterings there draw nothing of them, and every ray through a ball brings what its whole way
/// in it scatters once, by one distance drawn for it. So the inverse square of the distance to a
/// light, which next-event estimation at a free path's end has in its variance, cancels against the
/// density of that draw [Kulla12].
///
/// Who estimates what is parted by place alone, hence each part is unbiased whatever the tracker,
/// and no density of a free path is asked for. Positions are relative to the scene's origin.
/// Immutable; threads share it.
class NearLights {
 public:
  /// More lights than these have no balls: every ray looks at all of them. Those of most power
  /// have.
  static constexpr std::size_t kMostLights = 64;

  /// @param seed of the estimates of transmittance
  NearLights(const WavelengthSampler& factory, uint64_t seed);

  /// Whether no light has a ball that holds some of a medium.
  bool is_empty() const { return balls_.empty(); }

  /// Whether a scattering in a medium leaves a light to lines.
  /// @param light of SceneLights::within()
  bool has_line(uint32_t light, MediumId medium, const Vec3f& position) const {
    const uint32_t number = numbers_[light];
    if (number == kNone) return false;
    const Ball& ball = balls_[number];
    return (position - ball.middle).length2() < ball.squared_radii[number_of(medium)];
  }

  /// A point of a ray for one light.
  struct Point {
    uint32_t light = 0;  ///< Of SceneLights::within().
    float t = 0;         ///< Distance along the ray [world].
    float weight = 0;    ///< Inverse of the density of both [world].
  };
  /// Draws a light among those whose balls a ray through a medium passes, and a point in its ball:
  /// the directions to the points as seen from the light are spread evenly [Kulla12].
  /// @param direction unit [world]
  /// @param length of the ray in the medium, may be infinite
  /// @return nothing where it passes none
  std::optional<Point> sample(MediumId medium, const Vec3f& origin, const Vec3f& direction,
                              float length, RandomStream& random) const;

  /// A ray for one light.
  struct Aim {
    uint32_t ball = 0;
    Vec3f direction;        ///< Unit [world].
    float probability = 0;  ///< Of the choice of the light.
  };
  /// Draws a light for a scattering in a medium, and a direction about that of the light: after a
  /// point is drawn on that ray by sample_on(), both are as dense as the product of the inverse
  /// squares of the distances from the point to light and scattering [Georgiev13].
  /// @return nothing where the medium has no balls
  std::optional<Aim> aim(MediumId medium, const Vec3f& position, RandomStream& random) const;
  /// The density with which aim() draws a direction for the light of a ball [1/sr].
  float aim_pdf(uint32_t ball, MediumId medium, const Vec3f& position,
                const Vec3f& direction) const;
  /// As sample(), for the light of one ball.
  std::optional<Point> sample_on(uint32_t ball, MediumId medium, const Vec3f& origin,
                                 const Vec3f& direction, float length, RandomStream& random) const;

 private:
  static constexpr uint32_t kNone = UINT32_MAX;

  struct Ball {
    uint32_t light = 0;
    Vec3f middle;
    float size = 0;  // of the light: radius of a sphere around it
    float power = 0;
    Vec3f axis{0, 0, 1};               // of the cone that a light without extent shines into
    float cosine = -1;                 // of half its opening; -1: everywhere
    std::vector<float> squared_radii;  // in each medium, then in combinations of them
  };

  /// A light's ball as a ray passes it.
  struct Passed {
    uint32_t light = 0;
    float closest = 0;         // distance along the ray to where it is closest to the light
    float height = 0;          // distance there
    float begin = 0, end = 0;  // angles at the light from there to both ends of the ray in the ball
  };
  std::optional<Passed> pass(const Ball& ball, std::size_t medium, const Vec3f& origin,
                             const Vec3f& direction, float length) const;
  static std::optional<Point> point_on(const Passed& passed, float u);

  std::size_t number_of(MediumId medium) const {
    return std::min(static_cast<std::size_t>(medium), bounds_.size());
  }
  void find_lights(const PathScene& scene);
  void find_radii(const WavelengthSampler& factory, uint64_t seed);

  std::vector<Ball> balls_;
  std::vector<uint32_t> numbers_;  // of the balls of all lights
  std::vector<Box3f> bounds_;      // of the media
};

}  // namespace freepath
