#pragma once
/// @file Light that falls on a medium from above, and where it goes.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/paths/periodic_domain.h"

namespace freepath {

/// What paths of light bring to a column.
enum class Flux : uint8_t {
  kReflected,    ///< Leaves by the top.
  kTransmitted,  ///< Arrives at the bottom, scattered or not.
  kUnscattered,  ///< The part of it that never scattered.
  kAbsorbed,     ///< Stays in the medium.
};
inline constexpr uint32_t kFluxes = 4;

/// A box of columns that light falls on from above, and that counts where it goes. Positions are
/// relative to the scene's origin [world].
class FluxMeter {
 public:
  /// @param box what is measured: light starts at its top
  /// @param axis along which columns stand: 0, 1 or 2
  /// @param rises whether the top is where that coordinate is largest
  FluxMeter(const Box3d& box, int axis, bool rises);

  /// Columns along the other two axes, in their order.
  std::array<uint32_t, 2> counts{1, 1};
  /// Direction in which light falls, a unit vector; none: the same radiance from all directions
  /// above.
  std::optional<Vec3f> beam;
  /// Directions towards those who look at the columns: unit vectors, none of them level.
  std::vector<Vec3f> views;
  /// sigma_a / sigma_s of each component, where weights lose what is absorbed; none where events
  /// tell of it, or nothing does.
  std::vector<float> absorbed_of_scattered;
  /// Whether nothing comes to the bottom but what rounding and chance bring: it is not counted.
  bool has_no_bottom = false;
  /// Depths below the top, ascending, at which paths split on their way down, and of two on their
  /// way up one ends; of a medium that is the same everywhere in a depth.
  std::vector<float> splits;

  /// The axis along which columns stand.
  int axis() const { return axis_; }
  uint32_t columns() const { return counts[0] * counts[1]; }
  /// Numbers of what is counted: of fluxes and views, in each column.
  uint32_t cells() const { return columns() * kinds(); }
  uint32_t kinds() const { return kFluxes + static_cast<uint32_t>(views.size()); }
  uint32_t cell(Flux flux, uint32_t column) const {
    return static_cast<uint32_t>(flux) * columns() + column;
  }
  uint32_t cell_of_view(std::size_t view, uint32_t column) const {
    return (kFluxes + static_cast<uint32_t>(view)) * columns() + column;
  }

  /// How far down a direction leads, for each unit of its length.
  float down(const Vec3f& direction) const { return rises_ ? -direction[axis_] : direction[axis_]; }
  float depth(const Vec3f& point) const {
    return rises_ ? top_ - point[axis_] : point[axis_] - top_;
  }
  /// Puts a point at a depth.
  void set_depth(Vec3f& point, float depth) const {
    point[axis_] = rises_ ? top_ - depth : top_ + depth;
  }
  /// The share of the light that one of the branches beyond so many planes stands for.
  static double share_at(uint32_t level) {
    constexpr uint64_t kExponentOfOne = 1023;
    return std::bit_cast<double>((kExponentOfOne - level) << 52);
  }
  /// The way to the next plane where paths split; infinite where none lies ahead.
  /// @param level how many lie above
  float way_to_plane(const Vec3f& origin, const Vec3f& direction, uint32_t level) const;
  /// Keeps a direction from being level to the last bit: a ray would leave sideways.
  /// @param slope its component along axis()
  static void tilt(float& slope) {
    constexpr float kLeastSlope = 1e-12F;
    if (std::abs(slope) < kLeastSlope) slope = std::copysign(kLeastSlope, slope);
  }

  struct Start {
    Vec3f origin, direction;
  };
  /// Where a path of light begins, each place of the top as likely as the others.
  Start start(RandomStream& random) const;
  /// The column that a point lies in.
  uint32_t column(const Vec3f& point) const {
    if (columns() == 1) return 0;
    return number(point, 1) * counts[0] + number(point, 0);
  }
  /// The column by whose top or bottom a ray leaves.
  /// @param domain that repeats, if there is one
  uint32_t column_left(const Vec3f& origin, const Vec3f& direction,
                       const std::optional<PeriodicDomain>& domain) const;
  /// What radiance towards a view counts for each unit of intensity of a scattering: π / |cosine|,
  /// so that a white diffuse surface counts 1.
  float weight_of_view(std::size_t view) const;

 private:
  uint32_t number(const Vec3f& point, int side) const;

  Box3d box_;
  int axis_;
  bool rises_;
  float top_, bottom_;
  std::array<int, 2> sides_;  // the other axes
};

}  // namespace freepath
