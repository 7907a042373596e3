// The renderer with errors planted in its paths; takes the place of the library's own.

#include "freepath/paths/path_flights.cpp"             // NOLINT(bugprone-suspicious-include)
#include "freepath/paths/path_wavefront.cpp"           // NOLINT(bugprone-suspicious-include)
#include "freepath/paths/renderer.cpp"                 // NOLINT(bugprone-suspicious-include)
#include "tests/certify/planted/path_collisions.cpp"   // NOLINT(bugprone-suspicious-include)
#include "tests/certify/planted/path_glass.cpp"        // NOLINT(bugprone-suspicious-include)
#include "tests/certify/planted/path_lobes.cpp"        // NOLINT(bugprone-suspicious-include)
#include "tests/certify/planted/path_near_lights.cpp"  // NOLINT(bugprone-suspicious-include)
#include "tests/certify/planted/path_scattering.cpp"   // NOLINT(bugprone-suspicious-include)
