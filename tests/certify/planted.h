#pragma once
/// @file Errors that copies of sources have planted in them (CMakeLists.txt says where).

namespace freepath::testing {

/// Factors in the copies; 1 plants nothing.
struct Planted {
  float roulette = 1;         ///< On what survives Russian roulette.
  float shadow_roulette = 1;  ///< On what shadow rays bring that are cast by roulette.
  float light_share = 1;      ///< On what next-event estimation in media is multiplied by.
  float surface_share = 1;    ///< The same at surfaces.
  float emission_guide = 1;   ///< On what directions of the emission guide are multiplied by.
  float branch = 1;           ///< On branches of paths in the lobes around a sun.
  float near_line = 1;        ///< On what lines past near lights bring.
  float glass = 1;            ///< On what lamps bring that glass refracts.
  float order = 1;            ///< On terms of a series above order zero, or on the whole series.
};

inline Planted planted;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace freepath::testing
