#pragma once
/// @file Measured scattering properties by name.

#include <optional>
#include <span>
#include <string_view>

#include "freepath/base/vector.h"

namespace freepath {

/// Coefficients of a material for R, G, B.
struct ScatteringPreset {
  /// Reduced scattering coefficient, (1 - g) sigma_s: to be used with isotropic scattering [1/mm].
  Vec3d sigma_prime_s;
  Vec3d sigma_a;  ///< [1/mm]
};

/// Solid and opaque materials of [Jensen01, Fig. 5], and liquids and powders at their natural
/// concentrations after [Narasimhan06]. Those were measured diluted in 23 litres of water;
/// the coefficients here are the paper's divided by the concentration, the scattering times
/// 1 - g. Their absorption is a difference of rounded numbers and as coarse. The numbers are taken
/// from pbrt-v4's table and were not compared with the printed ones.
///
/// The names are those of pbrt's parameter "preset" ("Skimmilk", "Lowfat Milk"), with their case.
/// @return nothing for an unknown name
std::optional<ScatteringPreset> find_scattering_preset(std::string_view name);

/// All names, in the order of the papers.
std::span<const std::string_view> scattering_preset_names();

}  // namespace freepath
