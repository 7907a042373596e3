#pragma once
/// @file What the reference methods ask of a medium, one ray at a time. They are no null-collision
/// walks, need no speed, and so are written once, in scalar code and double precision.

#include <array>
#include <concepts>

#include "freepath/base/random.h"

namespace freepath {

/// A medium as one ray meets it. Distances t are counted from where the ray enters it [world].
///
///   Path      a ray inside the medium: its `length` [world], 0 if it misses
///   Segment   a part [begin, end) of it, with `minimum` and `maximum` of each component's density
///   Cell      a part [begin, end) in which each component's `density` is a cubic of
///             s = (t - begin)/(end - begin): Σ_j density[k][j] s^j
///
/// Components that no channel of the walk sees are left out; `number(k)` says which the k-th is in
/// the medium, and `component(k)` has its sigma_a, sigma_s and emission per unit of density.
template <class M>
concept ReferenceMedium = requires(const M& medium, const typename M::Path& path,
                                   typename M::Segment& segment, typename M::Cell& cell, double t,
                                   int k, RandomStream& random) {
  { path.length } -> std::convertible_to<double>;
  { path.voxel_length } -> std::convertible_to<double>;
  { medium.component_count() } -> std::same_as<int>;
  { medium.number(k) } -> std::same_as<int>;
  medium.component(k).sigma_a[0];
  medium.component(k).sigma_s[0];
  medium.component(k).emission[0];
  { medium.segments(path).next(segment) } -> std::same_as<bool>;
  { medium.cells(path, t, t).next(cell) } -> std::same_as<bool>;
  { medium.densities(path, t, random) } -> std::same_as<typename M::Densities>;
};

/// Extinction of each channel [1/m].
template <int kN, ReferenceMedium Medium>
std::array<double, kN> extinction(const Medium& medium,
                                  const typename Medium::Densities& densities) {
  std::array<double, kN> sigma_t{};
  for (int k = 0; k < medium.component_count(); ++k) {
    const auto& component = medium.component(k);
    for (int channel = 0; channel < kN; ++channel) {
      sigma_t[channel] +=
          densities[k] * (double(component.sigma_a[channel]) + component.sigma_s[channel]);
    }
  }
  return sigma_t;
}

/// Mean of the extinction over channels [1/m]; free paths ask for it where all channels share one.
template <int kN, ReferenceMedium Medium>
double mean_extinction(const Medium& medium, const typename Medium::Densities& densities) {
  double sum = 0;
  for (const double sigma_t : extinction<kN>(medium, densities)) sum += sigma_t;
  return sum / kN;
}

}  // namespace freepath
