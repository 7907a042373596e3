#pragma once
/// @file A medium of a scene: spectra of its components, from which its cross sections in the
/// channels of paths are made.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/lights/thermal_radiance.h"
#include "freepath/media/field.h"
#include "freepath/media/medium.h"
#include "freepath/media/medium_channels.h"
#include "freepath/media/phase/phase_function.h"
#include "freepath/spectra/rgb_spectrum.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// One density and what it does to light.
struct SceneMediumComponent {
  SpectrumId sigma_a, sigma_s;  ///< [1/m per density], times scale.
  float scale = 1;
  /// Emitted radiance, times radiance_scale and, if set, the value of radiance_field.
  SpectrumId radiance;
  float radiance_scale = 1;
  std::shared_ptr<const Field> radiance_field;
  /// Emission of a black body, in place of radiance.
  std::optional<TemperatureEmission> temperature;
  std::optional<SpectrumId> temperature_factor;  ///< Factor of that emission; none: 1.
  PhaseFunction phase = {};
};

/// Voxels whose coefficients are colours, each of which becomes a spectrum: pbrt's "rgbgrid". One
/// layout of voxels for all three; any of them may be missing.
struct ColorVoxels {
  Vec3i counts{0};
  Matrix4d index_to_world;
  std::vector<RgbSpectrum> sigma_a, sigma_s;  ///< x fastest [1/m].
  std::vector<RgbSpectrum> radiance;          ///< Illuminants.
  float scale = 1;                            ///< Factor of both coefficients.
  float radiance_scale = 1;
  PhaseFunction phase = {};
  int super_voxel = 0;  ///< Edge of the super-voxels [voxels], 0 for automatic.
};

/// A medium, and its cross sections in the channels of some paths.
struct BoundMedium {
  std::shared_ptr<const Medium> medium;
  MediumChannels channels;
};

/// One medium of a scene. Immutable once made; threads share it.
class SceneMedium {
 public:
  /// @param medium whose components are those, in their order; its own cross sections bound what
  ///   the spectra can be, and decide the size of super-voxels alone
  SceneMedium(std::string name, std::shared_ptr<const Medium> medium,
              std::vector<SceneMediumComponent> components);
  /// A medium that is the same everywhere in a box, and nowhere else.
  /// @param box in a space of its own, which box_to_world puts into the world
  /// @param largest_sigma_t bounds what the spectra can be [1/m]
  static SceneMedium homogeneous(std::string name, SceneMediumComponent component, const Box3d& box,
                                 const Matrix4d& box_to_world, float largest_sigma_t);
  /// @throws Error if sizes do not fit the counts
  SceneMedium(std::string name, std::shared_ptr<const ColorVoxels> voxels);

  /// Its cross sections in the channels of these spectra.
  BoundMedium bind(const SpectrumValues& spectra) const;

  /// Whether its cross sections are the same at all wavelengths.
  bool is_grey(const SpectrumTable& table) const;
  /// Whether its cross sections and its emission are the same at all wavelengths.
  bool is_constant(const SpectrumTable& table) const;

  const std::string& name() const { return name_; }
  /// The phase function of a component as events number them.
  const PhaseFunction& phase(std::size_t component) const {
    return phases_[std::min(component, phases_.size() - 1)];
  }
  /// Scattering over extinction of a component, for pictures of it.
  SampledSpectrum albedo(std::size_t component, const SpectrumValues& spectra) const;
  /// Memory that `bind` takes for so many wavelengths, beside what all of them share.
  std::size_t bytes_of_set(int wavelengths) const;
  /// The box that it fills [world].
  const Box3d& bounds() const { return bounds_; }
  /// The box beyond which it is nowhere, whatever filter its voxels are read by [world]: what it
  /// fills and, if it is not cut off there, half a voxel more.
  Box3d outer_bounds() const;
  /// Null where voxels depend on wavelengths.
  const std::shared_ptr<const Medium>& medium() const { return medium_; }
  const std::vector<SceneMediumComponent>& components() const { return components_; }
  /// Voxels of colours; null of media that have none.
  const std::shared_ptr<const ColorVoxels>& colors() const { return colors_; }
  /// Whether it is the same everywhere in its bounds.
  bool is_homogeneous() const { return is_homogeneous_; }
  /// A copy in another box; only of a homogeneous medium.
  SceneMedium in_box(const Box3d& box, const Matrix4d& box_to_world) const;

 private:
  BoundMedium bind_colors(const SpectrumValues& spectra) const;

  std::string name_;
  std::shared_ptr<const Medium> medium_;
  std::vector<SceneMediumComponent> components_;
  std::shared_ptr<const ColorVoxels> colors_;
  std::vector<PhaseFunction> phases_;
  Box3d bounds_;
  bool is_homogeneous_ = false;
};

}  // namespace freepath
