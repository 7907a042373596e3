#pragma once
/// @file The noise of textures.
///
/// It is sampled at points: octaves that are finer than a pixel are averaged by the pixel's
/// samples.

#include "freepath/base/vector.h"

namespace freepath {

/// Gradient noise with the weights and permutation of [Perlin02] and the twelve gradients and four
/// repeats of pbrt-v4, of which two repeats differ. 0 at points of whole numbers, in about [-1, 1],
/// with a period of 256; 0 at points that are not finite.
float texture_noise(const Vec3d& point);

/// Fractional Brownian motion: the sum of octaves of noise, each of 1.99 times the frequency and
/// `omega` times the amplitude of the one before. The first has amplitude and frequency 1.
float fractal_motion(const Vec3d& point, float omega, int octaves);

/// The sum over octaves of the absolute values of noise, and 0.2 times the amplitude of an octave
/// that would follow, as in pbrt-v4: the mean of what is left out.
float turbulence(const Vec3d& point, float omega, int octaves);

/// Whether a point lies in one of the dots, of radius 0.35, that about half of the squares around
/// points of whole numbers have, at places that noise chooses within the square.
bool in_polka_dot(float s, float t);

/// The colour of marble at a height within its layers, [0, 1]: linear sRGB.
Vec3f marble_color(float height);

}  // namespace freepath
