#include "freepath/paths/shadow_guide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "freepath/base/random.h"
#include "freepath/paths/slab_splitting.h"
#include "freepath/paths/walk_batches.h"
#include "freepath/transport/walker.h"

namespace freepath {
namespace {

/// Share of what an isotropic scattering brings: rays play that are expected to bring less. Half of
/// it and twice as much are as efficient.
constexpr float kThreshold = 0.2F;

/// Draws from which the dominant direction is found.
constexpr uint32_t kDraws = 256;
/// Steps of a lattice whose points fill a cube evenly: inverse powers of the root of x⁴ = x + 1.
constexpr std::array<double, 2> kLattice{0.8191725133961645, 0.6710436067037893};
/// A direction is dominant if so much of the light comes from there.
constexpr float kDominantShare = 0.25F;

/// Splitting pays where two scatterings, forwards, are so many times as likely to turn light
/// into a direction as if they were isotropic.
constexpr double kLeastPeak = 1.5;
constexpr int kMoments = 64;

/// Cells along the longest side of a medium, and shadow rays of each.
constexpr int kCells = 32;
constexpr uint32_t kRaysOfCell = 16;
/// Least root of a cell: rays that don't play are known by what they bring alone, which is huge.
constexpr float kDarkest = 1e-3F;
/// Streams that no path has.
constexpr uint32_t kPositionStream = 0xFFFFFFFDU;
constexpr uint32_t kWalkStream = 0xFFFFFFFCU;
/// Media beyond these have no cells: their tables would take longer than they save.
constexpr std::size_t kMostMedia = 4;

/// Transmittances from a random point of each cell towards the dominant direction.
/// @param number of the ray among those of its cell
std::vector<float> transmittances_of_cells(const Walker& walker, const ShadowRoulette& cells,
                                           uint32_t count, uint32_t number, uint64_t seed) {
  RayStream rays;
  rays.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3i coord(static_cast<int>(i) % cells.counts.x,
                      static_cast<int>(i) / cells.counts.x % cells.counts.y,
                      static_cast<int>(i) / cells.counts.x / cells.counts.y);
    RandomStream random(seed, i, number, kPositionStream);
    const Vec3f within{random.uniform(), random.uniform(), random.uniform()};
    set_ray(rays, i, cells.corner + (Vec3f(coord) + within) / cells.per_cell, cells.dominant,
            std::numeric_limits<float>::infinity());
    rays.pixel[i] = i;
    rays.sample[i] = number;
    rays.stream[i] = kWalkStream;
  }
  FlightStream flights;
  WalkStatistics statistics;
  walker.transmittance(rays, flights, statistics);
  const std::vector<float>& weights = flights.weight[0];
  return {weights.begin(), weights.begin() + count};
}

}  // namespace

ShadowGuide::ShadowGuide(const WavelengthSampler& factory, const Wanted& wanted, uint64_t seed) {
  const PathScene& scene = factory.scene();
  if (!scene.lights->is_drawn()) return;
  const double scattered = scene.lights->fluence() / (4 * std::numbers::pi);
  if (!(scattered > 0)) return;
  if (wanted.roulette) elsewhere_.least = kThreshold * static_cast<float>(scattered);
  const std::vector<SceneMedium>& media = scene.media;
  if (media.empty() || media.size() > kMostMedia || scene.domain) return;
  find_dominant(scene);
  if (!dominant_) return;
  for (std::size_t i = 0; i < media.size(); ++i) {
    media_.push_back(tabulate(scene, factory.bound_in_rgb(i), media[i].bounds(), seed));
    if (!wanted.lobes || media_.back().roots == nullptr) continue;
    media_.back().lobe_scale = lobe_scale(media[i]);
    has_lobes_ = has_lobes_ || media_.back().lobe_scale > 0;
  }
}

float ShadowGuide::lobe_scale(const SceneMedium& medium) const {
  const std::size_t components = std::max<std::size_t>(medium.components().size(), 1);
  double peak = 0;
  for (std::size_t k = 0; k < components; ++k) {
    const std::vector<double> moments = legendre_moments(medium.phase(k), kMoments);
    double of_two = 0;
    for (std::size_t l = 0; l < moments.size(); ++l) {
      of_two += static_cast<double>(2 * l + 1) * moments[l] * moments[l];
    }
    peak = std::max(peak, of_two);
  }
  return peak < kLeastPeak ? 0 : dominant_share_ * 4 * std::numbers::pi_v<float>;
}

void ShadowGuide::find_dominant(const PathScene& scene) {
  Box3d bounds;
  for (const SceneMedium& medium : scene.media) bounds.extendBy(medium.bounds());
  const Vec3f middle(bounds.center() - scene.origin);
  const SpectrumValues rgb = scene.spectra->in_rgb();
  struct Draw {
    Vec3f direction;
    float power;
  };
  std::vector<Draw> draws;
  float sum = 0;
  for (uint32_t i = 0; i < kDraws; ++i) {
    // Points of a lattice, the same for all scenes.
    const double n = i + 0.5;
    const auto u = [&](double step) { return static_cast<float>(n * step - std::floor(n * step)); };
    const LightSample light =
        scene.lights->sample(middle, rgb, u(kLattice[0]), u(kLattice[1]),
                             std::min(static_cast<float>(n / kDraws), kOneMinusEpsilon));
    if (!(light.pdf > 0) || std::isfinite(light.distance)) continue;
    const float power = (light.radiance[0] + light.radiance[1] + light.radiance[2]) / light.pdf;
    draws.push_back({light.direction, power});
    sum += power;
  }
  float largest = 0;
  for (const Draw& candidate : draws) {
    float around = 0;
    for (const Draw& other : draws) {
      if (candidate.direction.dot(other.direction) >= ShadowRoulette::kSameDirection)
        around += other.power;
    }
    if (around <= largest) continue;
    largest = around;
    dominant_ = candidate.direction;
  }
  if (largest < kDominantShare * sum) dominant_.reset();
  const double fluence = scene.lights->fluence();
  dominant_share_ = static_cast<float>(std::min(1.0, largest / (3.0 * kDraws * fluence)));
}

ShadowRoulette ShadowGuide::tabulate(const PathScene& scene, const BoundMedium& bound,
                                     const Box3d& bounds, uint64_t seed) {
  ShadowRoulette cells = elsewhere_;
  const Vec3d size = bounds.size();
  const double edge = std::max({size.x, size.y, size.z}) / kCells;
  if (!(edge > 0) || !std::isfinite(edge)) return cells;
  cells.dominant = *dominant_;
  cells.corner = Vec3f(bounds.min - scene.origin);
  for (int axis = 0; axis < 3; ++axis) {
    cells.counts[axis] = std::clamp(static_cast<int>(std::ceil(size[axis] / edge)), 1, kCells);
    cells.per_cell[axis] = static_cast<float>(cells.counts[axis] / std::max(size[axis], edge));
  }
  const auto count = static_cast<uint32_t>(cells.counts.x * cells.counts.y * cells.counts.z);
  // Of channels that differ, that which is let through best.
  std::vector<float>& roots = roots_.emplace_back(count, kDarkest);
  const int channels = bound.channels.has_grey_extinction() ? 1 : bound.channels.count;
  for (int channel = 0; channel < channels; ++channel) {
    const WalkSettings settings{.seed = seed, .origin = scene.origin};
    const Walker walker(*bound.medium, bound.channels.only(channel), settings);
    std::array<std::vector<float>, kRaysOfCell> transmittances;
    tbb::parallel_for(0U, kRaysOfCell, [&](uint32_t n) {
      transmittances[n] = transmittances_of_cells(walker, cells, count, n, seed);
    });
    for (uint32_t cell = 0; cell < count; ++cell) {
      float sum = 0;
      for (const std::vector<float>& values : transmittances) sum += values[cell] * values[cell];
      roots[cell] = std::max(roots[cell], std::sqrt(std::sqrt(sum / kRaysOfCell)));
    }
  }
  cells.roots = roots.data();
  return cells;
}

}  // namespace freepath
