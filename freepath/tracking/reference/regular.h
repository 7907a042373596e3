#pragma once
/// @file Regular tracking: exact integration from cell to cell.

#include <span>

#include "freepath/tracking/method.h"
#include "freepath/tracking/reference/cubic_depth.h"
#include "freepath/tracking/reference/real_collision.h"

namespace freepath {

/// Calls visit(cell) for the cells along a path that may hold any density, in order, until it
/// returns false. Voxels of super-voxels that are empty are not read.
template <ReferenceMedium Medium, class Visit>
void visit_cells(const Medium& medium, const typename Medium::Path& path,
                 WalkStatistics& statistics, Visit visit) {
  auto segments = medium.segments(path);
  typename Medium::Segment segment;
  while (segments.next(segment)) {
    ++statistics.super_voxel_steps;
    if (segment.empty) continue;
    auto cells = medium.cells(path, segment.begin, segment.end);
    typename Medium::Cell cell;
    while (cells.next(cell)) {
      statistics.lookups += static_cast<uint64_t>(medium.component_count());
      if (!visit(cell)) return;
    }
  }
}

/// Mean over channels of each component's extinction per unit of density [1/m].
template <int kN, ReferenceMedium Medium>
typename Medium::Densities mean_cross_sections(const Medium& medium) {
  typename Medium::Densities sigma_t{};
  for (int k = 0; k < medium.component_count(); ++k) {
    typename Medium::Densities one{};
    one[k] = 1;
    sigma_t[k] = mean_extinction<kN>(medium, one);
  }
  return sigma_t;
}

/// The extinction along a cell, times the cell's length: an optical depth per s.
/// @param sigma_t of each component per unit of density [1/m]
template <ReferenceMedium Medium>
Cubic depth_along(const Medium& medium, const typename Medium::Cell& cell,
                  const typename Medium::Densities& sigma_t) {
  Cubic sum{};
  for (int k = 0; k < medium.component_count(); ++k) {
    const double factor = sigma_t[k] * (cell.end - cell.begin);
    for (int power = 0; power < 4; ++power) sum[power] += factor * cell.density[k][power];
  }
  return sum;
}

/// Densities at a place of a cell; their means over it where rounding has left nothing there.
template <int kN, ReferenceMedium Medium>
typename Medium::Densities densities_in(const Medium& medium, const typename Medium::Cell& cell,
                                        double s) {
  typename Medium::Densities densities{};
  for (int k = 0; k < medium.component_count(); ++k) {
    densities[k] = std::max(0.0, value_at(cell.density[k], s));
  }
  if (mean_extinction<kN>(medium, densities) > 0) return densities;
  for (int k = 0; k < medium.component_count(); ++k) {
    densities[k] = std::max(0.0, integral_to(cell.density[k], 1));
  }
  return densities;
}

/// Draws an optical depth and finds where it is reached: cell by cell under nearest interpolation;
/// under trilinear interpolation the density along a ray within a cell of voxel centres is a cubic,
/// its optical depth a quartic, inverted by Newton's method. Exact.
struct Regular {
  static constexpr MethodInfo kInfo = {"regular",
                                       "exact integration from voxel to voxel: the reference, slow",
                                       "interpolation 'nearest' or 'trilinear'",
                                       "always",
                                       "[Novak18, Sec. 4]",
                                       {}};

  explicit Regular(std::span<const float> /*options*/) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& modes,
           RandomStream& random, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    const auto sigma_t = mean_cross_sections<kN>(medium);
    double rest = exponential_double(random);
    visit_cells(medium, path, statistics, [&](const typename Medium::Cell& cell) {
      const Cubic depth = depth_along(medium, cell, sigma_t);
      const double whole = std::max(0.0, integral_to(depth, 1));
      if (rest >= whole) {
        rest -= whole;
        return true;
      }
      const double s = invert_integral(depth, rest);
      flight.t = cell.begin + s * (cell.end - cell.begin);
      collide(medium, densities_in<kN>(medium, cell, s), modes, random, flight);
      return false;
    });
  }
};

/// exp(-optical depth) by the same integration, exact in each channel.
struct RegularTransmittance {
  static constexpr MethodInfo kInfo = {"regular",
                                       "exact integration from voxel to voxel: the reference, slow",
                                       Regular::kInfo.needs,
                                       "always: it is exact",
                                       "[Novak18, Sec. 5]",
                                       {},
                                       /*chromatic=*/true};

  explicit RegularTransmittance(std::span<const float> /*options*/) {}

  template <int kN, ReferenceMedium Medium>
  void fly(const Medium& medium, const typename Medium::Path& path, const WalkModes& /*modes*/,
           RandomStream& /*random*/, ReferenceFlight<kN>& flight, WalkStatistics& statistics) {
    double depth[kN] = {};
    visit_cells(medium, path, statistics, [&](const typename Medium::Cell& cell) {
      bool left = false;
      typename Medium::Densities mean{};
      for (int k = 0; k < medium.component_count(); ++k) {
        mean[k] = std::max(0.0, integral_to(cell.density[k], 1));
      }
      const auto sigma_t = extinction<kN>(medium, mean);
      for (int channel = 0; channel < kN; ++channel) {
        depth[channel] += sigma_t[channel] * (cell.end - cell.begin);
        left = left || depth[channel] < kOpaque;
      }
      return left;
    });
    attenuate(depth, flight);
  }
};

}  // namespace freepath
