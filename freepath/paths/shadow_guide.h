#pragma once
/// @file Which shadow rays are worth their time.

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/sample_spectra.h"
#include "freepath/transport/shadow_roulette.h"

namespace freepath {

/// Says for how likely each light that was drawn a shadow ray is to be cast: Russian roulette on
/// what the ray is expected to bring. That is what it would bring unshadowed times the root of the
/// transmittance towards the lights' dominant direction, tabulated in coarse cells as the root mean
/// square of estimates; the root, since within a cell transmittances differ. It is compared with
/// what the lights from outside would bring by one isotropic scattering, so that it does not matter
/// how bright they are.
///
/// Only light from outside of the scene after the second scattering plays: what is scattered once
/// is the whole picture where media are thin, and there rays are few. Immutable; threads share it.
class ShadowGuide {
 public:
  /// What it is asked for.
  struct Wanted {
    bool roulette = true;  ///< Of shadow rays; else all are cast.
    bool lobes = true;     ///< Paths that split, where that pays.
  };
  /// @param seed of the estimates of transmittance
  ShadowGuide(const WavelengthSampler& factory, const Wanted& wanted, uint64_t seed);
  ShadowGuide(const ShadowGuide&) = delete;  // its media point at its tables
  ShadowGuide& operator=(const ShadowGuide&) = delete;

  /// Whether the shadow ray of a scattering plays, and is not cast in any case.
  /// @param scatterings of the path so far, this one included
  /// @param distance to the light
  static bool plays(uint32_t scatterings, float distance) {
    return scatterings >= kFirstScattering && !std::isfinite(distance);
  }
  /// Whether paths split in a medium.
  bool has_lobes() const { return has_lobes_; }
  /// Whether a direction is in the cone around that from which most light comes.
  bool is_dominant(const Vec3f& direction) const {
    return dominant_ && direction.dot(*dominant_) >= ShadowRoulette::kSameDirection;
  }
  /// How rays from scatterings in a medium play.
  const ShadowRoulette& roulette(MediumId medium) const {
    const auto number = static_cast<std::size_t>(medium);
    return number < media_.size() ? media_[number] : elsewhere_;
  }

 private:
  static constexpr uint32_t kFirstScattering = 2;

  void find_dominant(const PathScene& scene);
  float lobe_scale(const SceneMedium& medium) const;
  ShadowRoulette tabulate(const PathScene& scene, const BoundMedium& bound, const Box3d& bounds,
                          uint64_t seed);

  /// The roulette without transmittances. Its threshold is the luminance of what the lights from
  /// outside bring by an isotropic scattering, times a constant.
  ShadowRoulette elsewhere_;
  std::optional<Vec3f> dominant_;
  float dominant_share_ = 0;  // of the light from outside
  bool has_lobes_ = false;
  std::vector<ShadowRoulette> media_;      // if there is a dominant direction
  std::vector<std::vector<float>> roots_;  // of those media, which point at them
};

}  // namespace freepath
