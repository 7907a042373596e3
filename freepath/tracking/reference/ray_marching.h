#pragma once
/// @file Ray marching: the biased way.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "freepath/tracking/method.h"
#include "freepath/tracking/reference/real_collision.h"
#include "freepath/tracking/reference/stop_scope.h"

namespace freepath {

/// Sums optical depth in steps of fixed length, the density of each taken at one point, and
/// collides where the drawn depth is reached. One jitter moves the points of a ray together.
///
/// Biased: the optical depth is an estimate inside an exponential, whose mean is not the
/// exponential of its mean (Jensen). The bias falls with the square of the step.
///
/// A flight has as many steps as the option asks for: it can be told to stop (StopScope), and ends
/// in an escape then.
struct RayMarching {
  static constexpr MethodOption kOptions[] = {
      {"step", 0.0F, 0.0F, 1e30F, "length of a step [world units], 0 for half a voxel"}};
  static constexpr MethodInfo kInfo = {
      "ray-marching",
      "steps of fixed length, jittered: what people do today, kept for comparison",
      "interpolation 'nearest' or 'trilinear'",
      "its bias shrinks with its steps (step=LENGTH)",
      "[Novak18, Sec. 4]",
      kOptions,
      /*chromatic=*/false,
      /*biased=*/true};

  explicit RayMarching(std::span<const float> options) : step_option(options[0]) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& modes,
           RandomStream& random, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    if (StopScope::has_stopped()) return;
    // So that steps can be counted, and that points of neighbouring ones differ.
    constexpr double kMostSteps = 0x1p40;
    const double step = std::max(step_option > 0 ? double(step_option) : 0.5 * path.voxel_length,
                                 path.length / kMostSteps);
    constexpr uint32_t kStepsBetweenQuestions = 4096;
    uint32_t steps = 0;
    const auto has_to_stop = [&] {
      return ++steps % kStepsBetweenQuestions == 0 && StopScope::ask();
    };
    double rest = exponential_double(random);
    const double jitter = uniform_double(random);
    const auto width = [&](double number) { return std::min(step, path.length - number * step); };
    const auto point = [&](double number) { return number * step + jitter * width(number); };
    double number = 0;  // of the step; a whole one
    auto segments = medium.segments(path);
    typename Medium::Segment segment;
    while (segments.next(segment)) {
      ++statistics.super_voxel_steps;
      if (segment.empty) continue;
      // The first step whose point is no longer before the segment.
      number = std::max(number, std::floor(segment.begin / step) - 1);
      while (point(number) < segment.begin) {
        if (has_to_stop()) return;
        ++number;
      }
      for (; number * step < path.length && point(number) < segment.end; ++number) {
        if (has_to_stop()) return;
        const auto densities = medium.densities(path, point(number), random);
        statistics.lookups += static_cast<uint64_t>(medium.component_count());
        const double depth = mean_extinction<kN>(medium, densities) * width(number);
        if (rest < depth) {
          flight.t = number * step + width(number) * (rest / depth);
          collide(medium, densities, modes, random, flight);
          return;
        }
        rest -= depth;
      }
    }
  }

  float step_option;
};

}  // namespace freepath
