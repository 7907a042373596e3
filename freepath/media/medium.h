#pragma once
/// @file A medium: the sum of its components, cut into super-voxels.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "freepath/base/box.h"
#include "freepath/base/page_allocator.h"
#include "freepath/base/rgb.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/base/vector.h"
#include "freepath/media/field.h"
#include "freepath/media/phase/phase_function.h"
#include "freepath/media/radiance_field.h"
#include "freepath/media/super_voxels.h"
#include "freepath/media/walk_part.h"
#include "freepath/media/walk_space.h"

namespace freepath {

/// How a density is read between the centres of voxels.
enum class Interpolation {
  kNearest,     ///< The voxel that holds the point.
  kTrilinear,   ///< Eight voxels, weighted.
  kStochastic,  ///< One voxel, drawn with its trilinear weight [Pharr24].
};

/// One density field times the spectra of its cross sections.
struct Component {
  std::shared_ptr<const Field> density;
  Rgb sigma_a{0.0F};         ///< Absorption per unit of density [1/m].
  Rgb sigma_s{1.0F};         ///< Scattering per unit of density [1/m].
  PhaseFunction phase = {};  ///< Isotropic unless it is set.
  Rgb emission{0.0F};  ///< L_e, emitted radiance; the source term is sigma_a · density · L_e.
  /// What multiplies L_e, from place to place, in R, G and B: a black body's radiance of a field of
  /// temperatures. All three have fields, of one layout, or none has.
  std::array<RadianceField, kChannels> radiance = {};

  Rgb sigma_t() const { return sigma_a + sigma_s; }
};

/// An affine map of rows, point · linear + offset, in single precision.
struct AffineMap {
  std::array<std::array<float, 3>, 3> linear{};  ///< linear[from][to]
  std::array<float, 3> offset{};
};

/// A sum of components, which may stand anyhow in the world and overlap, with bounds over
/// super-voxels. Immutable once made, so threads share it freely.
///
/// Walks through components that share transform and layout of bricks are the fastest: one aim
/// serves all. Others are aimed at one by one, by an affine map each.
class Medium {
 public:
  /// A grid of spectra has two for each channel of a path: what it absorbs and what it scatters.
  static constexpr int kMaxComponents = 2 * kMaxChannels;

  /// @param components at least one; all of voxels, or all computed with the same cells
  /// @param super_voxel edge of a super-voxel [voxels], 0 for automatic
  /// @param world_to_index replaces the inverse of the fields' transform where that has none (a
  ///   plane-parallel slab collapses x and y); all fields must then share it
  /// @throws Error for coefficients that are negative or not finite, too many components,
  ///   an empty field, and as make_walk_space
  explicit Medium(std::vector<Component> components, int super_voxel = 0,
                  const std::optional<Matrix4d>& world_to_index = {});

  /// A copy of the medium with other bounds: maxima times `scale`, minima divided by it. Above 1
  /// they are looser; below 1 they are no bounds, which methods that need them are biased by. To
  /// study what bounds cost, and to test what notices wrong ones.
  Medium with_scaled_bounds(float scale) const;

  /// A copy of the medium, cut off at the faces of its outermost active voxels, where the filter's
  /// reach would let it fade over another half of a voxel.
  Medium clipped_to_voxels() const;
  /// A copy of the medium, cut off at the middles of its outermost active voxels: what lies inside
  /// of them is not faded.
  Medium clipped_to_middles() const;

  const std::vector<Component>& components() const { return components_; }
  /// The parts that walks take place in, one after the other: one, unless the voxels lie far
  /// apart.
  const std::vector<WalkPart>& parts() const { return *parts_; }
  /// The tree that rays meet several parts by; empty where one is all.
  const BoxTree& part_tree() const { return *part_tree_; }
  /// Super-voxels of the first part, which most media have alone.
  const SuperVoxels& super_voxels() const { return parts()[0].cells; }
  /// Super-voxels of all parts.
  std::size_t super_voxel_count() const;
  /// Bytes of what walks read besides the voxels and their own indices.
  std::size_t memory_bytes() const;
  /// Whether all components share transform and layout of bricks, so that one voxel serves all.
  bool aligned() const { return space_.aligned; }

  /// What a step of a walk reads of a super-voxel: the maxima of the components, or, where all of
  /// them are 0, the empty radius negated in place of the first. Entry: the part's first record +
  /// cell · components.
  using WalkCells = std::vector<float, PageAllocator<float>>;
  const WalkCells& walk_cells() const { return walk_cells_; }

  /// World space → walk space, whose unit is the edge of a super-voxel and whose cells are those of
  /// the super-voxels. With several parts it is the space of the whole, in units of the first's
  /// super-voxels; what a walk is in are the spaces of the parts, counted from their first voxels.
  /// @param origin the point of the world that positions are relative to: where it is near the
  ///   medium, single precision holds them however far from the world's origin that is
  AffineMap world_to_walk(const Vec3d& origin = Vec3d(0)) const;
  AffineMap world_to_walk(const WalkPart& part, const Vec3d& origin) const;
  /// World space → position in the grid of voxels that the parts' boxes are in.
  const Matrix4d& world_to_grid() const { return world_to_grid_; }
  /// The point of the world in the middle of a part.
  Vec3d middle_of(const WalkPart& part) const;
  /// Walk space → position in a component's voxels, counted from the first of its index; the centre
  /// of voxel i is at i + 1/2.
  AffineMap walk_to_component(std::size_t component) const;
  AffineMap walk_to_component(const WalkPart& part, std::size_t component) const;
  /// Walk space → position in the voxels of another field, which may stand anyhow in the world.
  /// @throws Error if the field's transform has no inverse
  AffineMap walk_to_field(const Field& field) const;
  /// Walk space of a part → position in the voxels of another field.
  /// @param window what of the field the part reads: set to that
  AffineMap walk_to_field(const WalkPart& part, const Field& field, BrickWindow& window) const;

  /// Where the density may differ from 0 [walk space], which depends on the filter's reach.
  Box3f walk_bounds(Interpolation interpolation) const;
  Box3f walk_bounds(const WalkPart& part, Interpolation interpolation) const;
  /// Bounds of the active voxels [world].
  Box3d world_bounds() const;
  /// Bounds of the active voxels with the part over which filters let the densities fade beyond
  /// their faces [world].
  Box3d outer_bounds() const;
  /// The same along the axes of the first component's voxels, where these can be told.
  OrientedBox outer_box() const;

  /// Whether every component's extinction is the same in all channels, so that one path can carry
  /// them all.
  bool has_grey_extinction() const;
  /// Whether all coefficients are the same in all channels.
  bool is_grey() const;
  bool emits() const;

 private:
  /// @param filter how far beyond the outermost voxels' middles it would reach [voxels]
  Box3d bounds_with(double filter) const;
  Box3d box_of_voxels(const BrickMap& map, double filter) const;
  std::vector<const Field*> fields() const;
  void build_from_voxels(int super_voxel);
  void build_from_functions();
  void set_world_to_grid(const std::optional<Matrix4d>& world_to_index);
  void set_parts(std::vector<WalkPart> parts);
  Matrix4d grid_to_field(const Field& field) const;

  std::vector<Component> components_;
  std::shared_ptr<const std::vector<WalkPart>> parts_;
  std::shared_ptr<const BoxTree> part_tree_ = std::make_shared<const BoxTree>();
  WalkCells walk_cells_;
  WalkSpace space_;
  Matrix4d world_to_grid_;
  double reach_ = 1;  // beyond the middles of the outermost voxels, where filters reach so far
};

}  // namespace freepath
