// Layers as columns of voxels. What rounding does to them:
//
// Depths are single precision. In world space the top is 0, so that depths near it are precise;
// walk space counts from the first voxel of the brick map, some 8 voxels above the top, and
// resolves there 2^-21 voxels or 5e-7 mean free paths, the voxels being one mean free path thick
// (somewhat more in slabs of more than 6e4). At depth z both resolve z · 6e-8. This is rounding to
// nearest: it moves paths up as often as down.
//
// In the layer of largest tau the density is 1 and sigma_a + sigma_s is 1, so that a scattering
// multiplies the weight by the albedo rounded once. The others' ratios are rounded a few times, by
// 1e-7 altogether.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/paths/slab.h"
#include "freepath/paths/slab_splitting.h"

namespace freepath {
namespace {

constexpr std::size_t kMaxLayers = 1024;
constexpr double kMaxTau = 1e6;
constexpr double kMaxVoxels = 60000;  // of mean free paths; layers have a few more
/// Voxels that a layer among others has at least, so that super-voxels which see the denser layer
/// next to it are only a part of it.
constexpr int kFewestVoxels = 16;
/// Largest albedo of a half-space. Mean path lengths grow as (1 - albedo)^-1/2, and an albedo in
/// single precision leaves 1 - albedo no more than two digits there.
constexpr double kMaxHalfSpaceAlbedo = 1 - 1e-6;

void check_layer(const SlabLayer& layer, std::size_t number, bool last) {
  if (!(layer.tau > 0)) {
    fail("tau of layer {} is {}; an optical thickness must be above 0", number, layer.tau);
  }
  if (std::isinf(layer.tau) && !last) {
    fail("tau of layer {} is inf; only the last layer can be a half-space", number);
  }
  if (!(layer.albedo >= 0 && layer.albedo <= 1)) {
    fail("albedo of layer {} is {}; it must lie in [0, 1]", number, layer.albedo);
  }
  if (!layer.phase && !(std::abs(static_cast<float>(layer.g)) < 1)) {
    fail("g of layer {} is {}; the mean cosine must lie strictly between -1 and 1", number,
         layer.g);
  }
  if (std::isinf(layer.tau) && layer.albedo > kMaxHalfSpaceAlbedo) {
    fail(
        "albedo of the half-space (tau inf) is {}; above {} paths in it hardly end, and at 1 it "
        "reflects everything: choose a smaller albedo or a finite tau",
        layer.albedo, kMaxHalfSpaceAlbedo);
  }
}

/// Optical thickness that stands for a half-space. Light in its depth decays with a relaxation
/// length of at least 1 and about the diffusion length 1/sqrt(3 (1-c)(1-c g)), in no case (g near
/// 1) more than sqrt(3) times that. On the way down and up again 30 of them leave exp(-34) = 1e-15.
double half_space_tau(const SlabLayer& layer) {
  const double c = layer.albedo;
  const double g = layer.phase ? double{layer.phase->mean_cosine()} : layer.g;
  return 30 * std::max(1.0, 1 / std::sqrt(3 * (1 - c) * (1 - c * g)));
}

PhaseFunction phase_of(const SlabLayer& layer) {
  return layer.phase ? *layer.phase : PhaseFunction::henyey_greenstein(static_cast<float>(layer.g));
}

/// The part of the column that a layer fills.
struct LayerVoxels {
  int begin = 0;
  int count = 0;
  float density = 0;
};

/// Shares a column out among layers, and finds the voxels' edge.
struct Column {
  std::vector<LayerVoxels> layers;
  int voxels = 0;
  double edge = 0;  ///< [world], mean free paths in the layer of largest tau
};

Column make_column(std::span<const double> taus) {
  const double total = std::accumulate(taus.begin(), taus.end(), 0.0);
  if (!(total <= kMaxTau)) {
    fail(
        "the sum of tau is {}; more than {} is not possible (in the last layer, inf is a "
        "half-space)",
        total, kMaxTau);
  }
  const double unit = std::max(1.0, total / kMaxVoxels);
  const int fewest = taus.size() > 1 ? kFewestVoxels : 1;
  Column column;
  for (const double tau : taus) {
    const int count = std::max(fewest, static_cast<int>(std::ceil(tau / unit)));
    column.layers.push_back({column.voxels, count, 0});
    column.voxels += count;
  }
  const auto thickest = std::max_element(taus.begin(), taus.end()) - taus.begin();
  column.edge = taus[thickest] / column.layers[thickest].count;
  for (std::size_t i = 0; i < taus.size(); ++i) {
    LayerVoxels& layer = column.layers[i];
    layer.density = static_cast<float>(taus[i] / (layer.count * column.edge));
  }
  return column;
}

/// The density of the layers of one kind, 0 in the others.
std::shared_ptr<const Field> make_field(const Column& column, std::span<const std::size_t> layers) {
  BrickMapBuilder builder(Vec3i(0), Vec3i(0, 0, column.voxels - 1),
                          column.voxels / BrickMap::kBrickSize + 1);
  for (const std::size_t i : layers) {
    const LayerVoxels& layer = column.layers[i];
    for (int z = layer.begin; z < layer.begin + layer.count; ++z) {
      builder.set_voxel(Vec3i(0, 0, z), layer.density);
    }
  }
  auto field = std::make_shared<Field>();
  field->name = "layer";
  field->voxels = std::move(builder).finish();
  field->index_to_world.setScale(column.edge);
  return field;
}

/// Layers that share albedo and phase function, and hence a component.
struct Kind {
  SlabLayer layer;
  std::vector<std::size_t> members;
};

std::vector<Kind> kinds_of(std::span<const SlabLayer> layers) {
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& kind) {
      return kind.layer.albedo == layers[i].albedo && kind.layer.phase == layers[i].phase &&
             (kind.layer.phase || kind.layer.g == layers[i].g);
    });
    if (same == kinds.end()) {
      kinds.push_back({layers[i], {i}});
    } else {
      same->members.push_back(i);
    }
  }
  if (kinds.size() > Medium::kMaxComponents) {
    fail("the layers have {} different pairs of albedo and phase function; at most {} are possible",
         kinds.size(), Medium::kMaxComponents);
  }
  return kinds;
}

/// Depths where paths split: light decays by half from one to the next. None where all the layers
/// together let enough of it through, nor in a half-space, of which nothing arrives below.
std::vector<float> make_splits(std::span<const SlabLayer> layers, std::span<const double> taus,
                               const Column& column, double mu0) {
  constexpr double kEnoughPasses = 5;       // decays by exp(-5) without
  constexpr std::size_t kMostSplits = 900;  // 2^-900 times a path is still a double
  constexpr int kMoments = 96;
  std::vector<float> splits;
  const double thickness = std::accumulate(taus.begin(), taus.end(), 0.0);
  if (std::isinf(layers.back().tau) || thickness / mu0 < kEnoughPasses) return splits;
  std::vector<double> exponents(layers.size());
  for (const Kind& kind : kinds_of(layers)) {
    // Light that nothing scatters keeps its direction.
    const double exponent =
        kind.layer.albedo == 0
            ? 1 / mu0
            : relaxation_exponent(kind.layer.albedo,
                                  legendre_moments(phase_of(kind.layer), kMoments));
    for (const std::size_t i : kind.members) exponents[i] = exponent;
  }
  double total = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) total += exponents[i] * taus[i];
  if (total < kEnoughPasses) return splits;
  double next = std::numbers::ln2;  // decay at the next plane
  double decay = 0;                 // at the top of the layer
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const double in_layer = exponents[i] * taus[i];
    const LayerVoxels& voxels = column.layers[i];
    for (; next < decay + in_layer && splits.size() < kMostSplits; next += std::numbers::ln2) {
      const double share = (next - decay) / in_layer;
      splits.push_back(static_cast<float>((voxels.begin + share * voxels.count) * column.edge));
    }
    decay += in_layer;
  }
  return splits;
}

}  // namespace

SlabMedium make_slab_medium(std::span<const SlabLayer> layers, int super_voxel, double mu0) {
  if (layers.empty() || layers.size() > kMaxLayers) {
    fail("tau has {} layers; 1 to {} are possible", layers.size(), kMaxLayers);
  }
  std::vector<double> taus;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    check_layer(layers[i], i + 1, i + 1 == layers.size());
    taus.push_back(std::isinf(layers[i].tau) ? half_space_tau(layers[i]) : layers[i].tau);
  }
  const Column column = make_column(taus);
  std::vector<Component> components;
  for (const Kind& kind : kinds_of(layers)) {
    Component component;
    component.density = make_field(column, kind.members);
    component.sigma_s = Rgb(static_cast<float>(kind.layer.albedo));
    component.sigma_a = Rgb(1.0F) - component.sigma_s;
    component.phase = phase_of(kind.layer);
    components.push_back(std::move(component));
  }
  // Everything is at x = y = 0 of the index; z = 0 of the world is the face of the first voxel.
  Matrix4d world_to_index;
  world_to_index[0][0] = world_to_index[1][1] = 0;
  world_to_index[2][2] = 1 / column.edge;
  world_to_index[3][2] = -0.5;
  return {Medium(std::move(components), super_voxel, world_to_index), column.voxels * column.edge,
          std::isinf(layers.back().tau), make_splits(layers, taus, column, mu0)};
}

}  // namespace freepath
