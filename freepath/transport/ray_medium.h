#pragma once
/// @file A medium as one ray meets it: the ReferenceMedium of tracking/reference/ over a
/// MediumView.

#include <array>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/media/medium_view.h"
#include "freepath/transport/grid_steps.h"

namespace freepath {

/// Borrows the view's arrays. Components without cross sections in the channels of the walk are
/// left out.
class RayMedium {
 public:
  using Densities = std::array<double, Medium::kMaxComponents>;

  /// The part of a ray inside the medium. It begins at the ray's origin or where it meets the
  /// bounds, so that a distant camera costs no precision inside.
  struct Path {
    Vec3d origin;             ///< Place in the grid of voxels that walk space has; see WalkSpace.
    Vec3d direction;          ///< [voxels per world unit]
    double begin = 0;         ///< Where it enters the medium [world].
    double length = 0;        ///< Length from there to its end [world]; 0 if it misses.
    double voxel_length = 0;  ///< Way in which it passes an edge length of a voxel [world].
  };

  /// The part of a path in one super-voxel, or in one empty cube of them.
  struct Segment {
    double begin = 0;
    double end = 0;
    bool empty = true;  ///< Whether every density is 0.
    Densities minimum{};
    Densities maximum{};
  };

  /// The part of a path in one voxel (nearest), or between eight voxel centres (trilinear), of
  /// every component.
  struct Cell {
    double begin = 0;
    double end = 0;
    /// Polynomial of each component's density: Σ_j density[j] s^j with s from 0 to 1 along the
    /// part. Without interpolation next() sets density[0] alone, and the others stay 0.
    std::array<std::array<double, 4>, Medium::kMaxComponents> density{};
  };

  class Segments {
   public:
    Segments(const RayMedium& medium, const Path& path);
    /// @return whether there was another segment
    bool next(Segment& segment);

   private:
    const RayMedium& medium_;
    GridSteps steps_;
  };

  class Cells {
   public:
    Cells(const RayMedium& medium, const Path& path, double begin, double end);
    /// @return whether there was another cell
    bool next(Cell& cell);

   private:
    /// The way through the voxels of a component, or of all where they are aligned.
    struct Track {
      Path path;  ///< Path in those voxels.
      GridSteps steps;
      Vec3i base;       ///< The present cell,
      double exit = 0;  ///< and where the path leaves it.
    };

    const RayMedium& medium_;
    double begin_;
    double end_;
    int track_count_;
    std::array<Track, Medium::kMaxComponents> tracks_;
  };

  /// @param channels of the walk
  RayMedium(const MediumView& view, int channels);

  /// A ray that misses, that has no direction, or whose numbers are not finite gets length 0.
  /// @param origin,direction,t_max [world]
  Path enter(const Vec3d& origin, const Vec3d& direction, double t_max) const;

  int component_count() const { return static_cast<int>(numbers_.size()); }
  int number(int k) const { return numbers_[k]; }
  const ComponentView& component(int k) const { return view_.components[numbers_[k]]; }

  Segments segments(const Path& path) const { return {*this, path}; }
  Cells cells(const Path& path, double begin, double end) const {
    return {*this, path, begin, end};
  }

  /// Densities at a distance from where the path begins; stochastic interpolation draws one tap for
  /// all components. Those that are computed in place of voxels are as exact as their function.
  Densities densities(const Path& path, double t, RandomStream& random) const;

 private:
  /// A path as it passes through the voxels of a component.
  Path path_in(int k, const Path& path) const;
  /// Densities that functions compute.
  Densities computed(const Vec3d& point) const;
  /// Value of a voxel, counted from the first of the index.
  double voxel(int k, const Vec3i& coord) const;
  /// The nearest voxel that has a next one along every axis within the index of a component.
  Vec3i inside(int k, Vec3i voxel) const;
  /// Density between the eight voxels from `base` on, along place + s · step, s in [0,1].
  std::array<double, 4> cubic(int k, const Vec3i& base, const Vec3d& fraction,
                              const Vec3d& step) const;

  MediumView view_;
  std::vector<int> numbers_;  ///< Numbers of the components that count.
};

}  // namespace freepath
