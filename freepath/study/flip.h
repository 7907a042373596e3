#pragma once
/// @file FLIP: how different two pictures look to people who flip between them.

#include <span>
#include <vector>

namespace freepath {

/// How a picture is looked at.
struct FlipViewing {
  /// Pixels that a degree of the field of view takes; 67 is a 0.7 m wide display with 3840 pixels
  /// across at a distance of 0.7 m, the standard of [Andersson20].
  double pixels_per_degree = 67.0206;
};

/// The difference that people perceive between two pictures of linear sRGB in [0, 1], for each
/// pixel 0 (none) to 1 [Andersson20].
/// @param reference,test R, G, B of pixel after pixel; values beyond [0, 1] are clipped
std::vector<float> flip(std::span<const float> reference, std::span<const float> test, int width,
                        int height, const FlipViewing& viewing = {});

/// FLIP errors of pictures of unlimited range: the largest difference over exposures from the one
/// that shows the brightest pixel of the reference to the one that shows its median, each through
/// the ACES tone curve [Andersson21].
std::vector<float> high_range_flip(std::span<const float> reference, std::span<const float> test,
                                   int width, int height, const FlipViewing& viewing = {});

}  // namespace freepath
