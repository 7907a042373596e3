#pragma once
/// @file Where paths through thick, absorbing layers split, so that some of them come through.

#include <span>
#include <vector>

#include "freepath/media/phase/phase_function.h"

namespace freepath {

/// Legendre moments g_0 = 1, g_1, ..., g_{count-1} of a phase function, by quadrature.
std::vector<double> legendre_moments(const PhaseFunction& phase, int count);

/// Decay of light in the depth of a homogeneous medium [1/mean free path]: deep inside, radiance
/// falls as exp(-exponent · tau). The largest eigenvalue of the spherical-harmonics equations is
/// its inverse [Case67, Sec. 4]; 0 for an albedo of 1, and never above 1, which unscattered light
/// has.
/// @param moments of the phase function, from legendre_moments()
double relaxation_exponent(double albedo, std::span<const double> moments);

}  // namespace freepath
