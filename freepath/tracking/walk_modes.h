#pragma once
/// @file How a walk treats absorption and emission.

namespace freepath {

/// What an absorption does to a path.
enum class Absorption {
  kAnalog,    ///< It ends the path.
  kWeighted,  ///< The weight takes the albedo; Russian roulette ends paths. The default.
};

/// Where emission is added.
enum class EmissionTally {
  kCollision,  ///< Emission at every tentative collision, w mu_a L_e/rate [Simon17]; the default.
  kAnalog,     ///< Emission at absorption events (under weighted absorption: at real collisions).
};

struct WalkModes {
  Absorption absorption = Absorption::kWeighted;
  EmissionTally emission = EmissionTally::kCollision;
  bool emits = false;  ///< Whether the medium emits at all.
};

}  // namespace freepath
