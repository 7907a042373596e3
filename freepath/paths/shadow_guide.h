#pragma once
/// @file Which shadow rays are worth their time.

#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/paths/path_colors.h"
#include "freepath/paths/path_scene.h"

namespace freepath {

/// Says for how likely each light that was drawn a shadow ray is to be cast: Russian roulette on
/// what the ray is expected to bring. That is what it would bring unshadowed times the root of the
/// transmittance towards the lights' dominant direction, tabulated in coarse cells; the root, since
/// within a cell transmittances differ. It is compared with what the lights from outside would
/// bring by one isotropic scattering, so that it does not matter how bright they are.
///
/// Only light from outside of the scene after the second scattering plays: what is scattered once
/// is the whole picture where media are thin, and there rays are few. Immutable; threads share it.
class ShadowGuide {
 public:
  /// @param seed of the estimates of transmittance
  ShadowGuide(const ColorFactory& factory, uint64_t seed);

  /// The probability with which to cast a ray, (0, 1]; if it is cast, what it brings is to be
  /// divided by that.
  /// @param scatterings of the path so far, this one included
  /// @param medium,position where it begins [world, relative to the scene's origin]
  /// @param direction towards the light
  /// @param brightness of what it would bring unshadowed: mean of the channels, in units of white
  float survival(uint32_t scatterings, MediumId medium, const Vec3f& position,
                 const Vec3f& direction, float brightness) const {
    if (scatterings < kFirstScattering || brightness >= least_) return 1;
    return survival_of_faint(medium, position, direction, brightness);
  }

 private:
  static constexpr uint32_t kFirstScattering = 2;

  /// Transmittances towards the dominant direction, of the middles of cells in the bounds of a
  /// medium.
  struct Cells {
    Vec3f corner{0};
    Vec3f per_cell{0};  // cells in a unit of length
    Vec3i counts{0};
    std::vector<float> roots;  // of the transmittances, x fastest
  };

  float survival_of_faint(MediumId medium, const Vec3f& position, const Vec3f& direction,
                          float brightness) const;
  void find_dominant(const PathScene& scene);
  Cells tabulate(const PathScene& scene, const BoundMedium& bound, const Box3d& bounds,
                 uint64_t seed) const;

  /// Luminance of what the lights from outside bring by an isotropic scattering, times the
  /// threshold.
  float least_ = 0;
  std::optional<Vec3f> dominant_;
  std::vector<Cells> cells_;  // of media, if there is a dominant direction
};

}  // namespace freepath
