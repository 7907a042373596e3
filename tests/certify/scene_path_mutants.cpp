// The renderer of scenes with errors planted in its paths; takes the place of the library's own.

#include "freepath/paths/scene_renderer.cpp"           // NOLINT(bugprone-suspicious-include)
#include "freepath/paths/scene_wavefront.cpp"          // NOLINT(bugprone-suspicious-include)
#include "tests/certify/planted/scene_scattering.cpp"  // NOLINT(bugprone-suspicious-include)
