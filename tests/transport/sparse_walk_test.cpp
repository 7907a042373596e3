// Walks through few voxels far apart, part after part: twins of near and far against each other's
// closed forms, random voxels against a sum over all of them, and the same bits whatever the batch.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/transport/walker.h"
#include "tests/media/sparse_field.h"
#include "tests/statistics.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath {
namespace {

using testing::field_of_voxels;
using testing::kInterpolations;
using testing::name_of;
using testing::PlacedVoxel;
using testing::repeat_ray;
using testing::RunningStatistics;
using testing::Tally;
using testing::TestRay;
using testing::two_clouds;

constexpr int kApart = 1 << 18;
const double kFarThreshold = testing::family_wise_threshold(1e-3, 400);

/// Along a side, and along a diagonal, on which one direction in floats leads exactly.
struct Twins {
  const char* name;
  Vec3i apart;
  TestRay ray;
};

const std::vector<Twins>& all_twins() {
  static const float kThird = std::sqrt(1.0F / 3);
  static const std::vector<Twins> kTwins = {
      {"along x", Vec3i(kApart, 0, 0), {Vec3f(-6, 5.25F, 6.5F), Vec3f(1, 0, 0), 1e7F}},
      {"diagonal",
       Vec3i(kApart, kApart, -kApart),
       {Vec3f(-5.75F, -4.5F, 17.25F), Vec3f(kThird, kThird, -kThird), 1e7F}},
  };
  return kTwins;
}

/// Two components of the same voxels, twice the one, with the extinction of 1 in channel 0.
Medium medium_of_twins(const Twins& twins, const Rgb& color, float absorbed = 0) {
  std::vector<Component> components(2);
  for (std::size_t k = 0; k < 2; ++k) {
    components[k].density = field_of_voxels(two_clouds(twins.apart));
    const Rgb sigma_t = color * (k == 0 ? 0.25F : 0.75F);
    components[k].sigma_a = sigma_t * absorbed;
    components[k].sigma_s = sigma_t * (1 - absorbed);
    components[k].emission = Rgb(2);
  }
  return Medium(std::move(components));
}

/// Optical depth of unit extinction through the first cloud, half of which is the second's.
double depth_of_cloud(const Twins& twins, Interpolation interpolation) {
  const auto field = field_of_voxels(two_clouds(twins.apart));
  return testing::optical_depth(*field, Vec3d(twins.ray.origin), Vec3d(twins.ray.direction), 60,
                                interpolation, 600'000);
}

TEST(SparseWalk, TransmittancesOfPartsMultiply) {
  for (const Twins& twins : all_twins()) {
    const Medium medium = medium_of_twins(twins, Rgb(1));
    ASSERT_EQ(medium.parts().size(), 2);
    for (const MethodInfo& info : transmittance_infos()) {
      for (const Interpolation interpolation : kInterpolations) {
        const std::string name(info.name);
        if (name == "closed-form" || name == "ray-marching") continue;
        if (name == "regular" && interpolation == Interpolation::kStochastic) continue;
        WalkSettings settings;
        settings.transmittance = name;
        settings.interpolation = interpolation;
        settings.seed = 4;
        const Walker walker(medium, settings);
        FlightStream flights;
        WalkStatistics statistics;
        const std::size_t paths = name == "regular"                                       ? 1
                                  : name == "p-series" || name == "unbiased-ray-marching" ? 3'000
                                                                                          : 60'000;
        walker.transmittance(repeat_ray(twins.ray, paths, 0), flights, statistics);
        EXPECT_EQ(statistics.rays, paths);
        RunningStatistics sum;
        for (std::size_t i = 0; i < paths; ++i) sum.add(flights.weight[0][i]);
        const double expected = std::exp(-1.5 * depth_of_cloud(twins, interpolation));
        const double error = std::hypot(sum.standard_error(), 1e-5 * expected);
        EXPECT_LT(std::abs(sum.mean() - expected) / error, kFarThreshold)
            << name << ", " << name_of(interpolation) << ", " << twins.name << ": " << sum.mean()
            << " +- " << sum.standard_error() << ", not " << expected;
      }
    }
  }
}

/// What flights along the twins' ray carry to the first cloud, the second, and beyond.
struct Arrivals {
  std::array<Tally, kChannels> near, far, escaped, emitted;
};

Arrivals arrivals_of(const Walker& walker, const Twins& twins, std::size_t paths) {
  Arrivals arrivals;
  testing::for_each_flight(
      walker, twins.ray, paths, [&](const FlightStream& flights, std::size_t i) {
        for (int c = 0; c < walker.channels(); ++c) {
          const double weight = flights.weight[c][i];
          if (flights.event[i] == Event::kEscape) arrivals.escaped[c].add(weight);
          if (flights.event[i] == Event::kScatter) {
            (flights.t[i] < kApart ? arrivals.near : arrivals.far)[c].add(weight);
          }
          arrivals.emitted[c].add(flights.emitted[c][i]);
        }
      });
  return arrivals;
}

void expect_mean(const Tally& tally, std::size_t paths, double expected, const std::string& name) {
  const double error = std::hypot(tally.standard_error(paths), 2e-5 * expected);
  EXPECT_LT(std::abs(tally.mean(paths) - expected) / error, kFarThreshold)
      << name << ": " << tally.mean(paths) << " +- " << error << ", not " << expected;
}

struct TrackerCase {
  const char* tracker;
  bool chromatic;
};

// Weights and, with a hero, densities go on from part to part; flights end where they should, and
// collect what is emitted on the way.
TEST(SparseWalk, FlightsGoOnFromPartToPart) {
  constexpr TrackerCase kCases[] = {
      {"delta", false},         {"weighted-delta", false},         {"multi-volume", false},
      {"decomposition", false}, {"weighted-decomposition", false}, {"regular", false},
      {"spectral", true},       {"spectral-decomposition", true},  {"hero-wavelength", true}};
  constexpr float kAbsorbed = 0.3F;
  const Rgb color(1, 0.5F, 0.25F);
  for (const Twins& twins : all_twins()) {
    for (const TrackerCase& test : kCases) {
      const Medium medium = medium_of_twins(twins, test.chromatic ? color : Rgb(1), kAbsorbed);
      WalkSettings settings;
      settings.tracker = test.tracker;
      settings.interpolation = Interpolation::kTrilinear;
      settings.seed = 9;
      const Walker walker(medium, settings);
      const std::size_t paths = std::string(test.tracker) == "regular" ? 20'000 : 100'000;
      const Arrivals arrivals = arrivals_of(walker, twins, paths);
      const double depth = depth_of_cloud(twins, Interpolation::kTrilinear);
      for (int c = 0; c < walker.channels(); ++c) {
        const double sigma = test.chromatic ? color[c] : 1;
        const double first = std::exp(-sigma * depth);
        const double whole = std::exp(-1.5 * sigma * depth);
        const std::string name =
            std::string(test.tracker) + ", " + twins.name + ", channel " + std::to_string(c);
        const double scattered = 1 - kAbsorbed;
        expect_mean(arrivals.near[c], paths, scattered * (1 - first), name + ", near");
        expect_mean(arrivals.far[c], paths, scattered * (first - whole), name + ", far");
        expect_mean(arrivals.escaped[c], paths, whole, name + ", escaped");
        expect_mean(arrivals.emitted[c], paths, 2 * kAbsorbed * (1 - whole), name + ", emitted");
      }
    }
  }
}

// A field of radiance that is as sparse: 3 in and around the first cloud, 5 around the second.
TEST(SparseWalk, RadianceIsReadInEveryPart) {
  const Twins& twins = all_twins()[1];
  const Medium medium = medium_of_twins(twins, Rgb(1), 0.5F);
  std::vector<PlacedVoxel> glow;
  for (int x = -4; x < 16; ++x) {
    for (int y = -4; y < 16; ++y) {
      for (int z = -4; z < 16; ++z) {
        glow.push_back({Vec3i(x, y, z), 3});
        glow.push_back({Vec3i(x, y, z) + twins.apart, 5});
      }
    }
  }
  const std::shared_ptr<const Field> radiance = field_of_voxels(glow);
  MediumChannels channels = channels_of(medium);
  for (ComponentChannels& component : channels.components) {
    component.emission[0] = 1;
    component.radiance[0] = {radiance, nullptr, 0, 1};
  }
  WalkSettings settings;
  settings.interpolation = Interpolation::kTrilinear;
  constexpr std::size_t kPaths = 200'000;
  const Arrivals arrivals = arrivals_of(Walker(medium, channels, settings), twins, kPaths);
  const double depth = depth_of_cloud(twins, Interpolation::kTrilinear);
  const double first = std::exp(-depth);
  const double whole = std::exp(-1.5 * depth);
  expect_mean(arrivals.emitted[0], kPaths, 0.5 * (3 * (1 - first) + 5 * (first - whole)), "glow");
}

// ---- Random voxels against a sum over all of them ----------------------------------------------

/// How long a ray is in a cube around a point.
double length_in_cube(const Vec3d& middle, const Vec3d& origin, const Vec3d& direction,
                      double t_max) {
  double begin = 0;
  double end = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (middle[axis] - 0.5 - origin[axis]) / direction[axis];
    const double high = (middle[axis] + 0.5 - origin[axis]) / direction[axis];
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return std::max(0.0, end - begin);
}

/// Rays from beyond one voxel through it and another, or from one to another.
RayStream rays_between(const std::vector<PlacedVoxel>& voxels, std::size_t count) {
  RandomStream random(11, 0, 0, 0);
  RayStream rays = testing::repeat_ray(Vec3f(0), Vec3f(0), HUGE_VALF, count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d from(voxels[random.bits() % voxels.size()].voxel);
    const Vec3d to = Vec3d(voxels[random.bits() % voxels.size()].voxel) + Vec3d(0.1, 0.2, 0.05);
    const Vec3d way = to == from ? Vec3d(1, 2, 3).normalized() : (to - from).normalized();
    const Vec3f origin(i % 3 == 0 ? from : from - way * 1000);
    const Vec3f direction((to - Vec3d(origin)).normalized());
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = origin[axis];
      rays.direction[axis][i] = direction[axis];
    }
    if (i % 4 == 1) rays.t_max[i] = static_cast<float>((to - Vec3d(origin)).length() - 500);
  }
  return rays;
}

std::vector<PlacedVoxel> scattered_voxels() {
  RandomStream random(12, 0, 0, 0);
  const auto coordinate = [&] { return static_cast<int>((random.uniform() - 0.5F) * 0x1p20F); };
  std::vector<PlacedVoxel> voxels;
  for (int i = 0; i < 300; ++i) {
    const Vec3i voxel(coordinate(), coordinate(), coordinate());
    for (int cell = 0; cell < 27; ++cell) {  // of 3³, so that rays in floats hit them
      voxels.push_back({voxel + Vec3i(cell / 9, cell / 3 % 3, cell % 3), 0.1F + random.uniform()});
    }
  }
  return voxels;
}

TEST(SparseWalk, RandomVoxelsAreMetByEveryRayThatPassesThem) {
  const std::vector<PlacedVoxel> voxels = scattered_voxels();
  std::vector<Component> components(1);
  components[0].density = field_of_voxels(voxels);
  const Medium medium(std::move(components));
  ASSERT_GT(medium.parts().size(), 250);
  const RayStream rays = rays_between(voxels, 500);
  WalkSettings settings;
  settings.transmittance = "regular";
  settings.interpolation = Interpolation::kNearest;
  FlightStream flights;
  WalkStatistics statistics;
  Walker(medium, settings).transmittance(rays, flights, statistics);
  std::size_t dimmed = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3d origin(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]);
    const Vec3d direction(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]);
    double depth = 0;
    for (const auto& [voxel, value] : voxels) {
      depth += value * length_in_cube(Vec3d(voxel), origin, direction, rays.t_max[i]);
    }
    EXPECT_NEAR(flights.weight[0][i], std::exp(-depth), 1e-5) << i;
    dimmed += depth > 0.1 ? 1 : 0;
  }
  EXPECT_GT(dimmed, 350);
  // Not one cell for each that lies on the way, but those around the voxels.
  EXPECT_LT(statistics.super_voxel_steps, 100 * rays.size());
}

TEST(SparseWalk, VoxelsFarApartAreNotHomogeneous) {
  const Medium medium = medium_of_twins(all_twins()[0], Rgb(1));
  WalkSettings settings;
  settings.transmittance = "closed-form";
  settings.interpolation = Interpolation::kNearest;
  EXPECT_THROW(Walker(medium, settings), Error);
}

// ---- Determinism ------------------------------------------------------------------------------

/// All that becomes of each ray.
using Flown = std::vector<std::tuple<float, Event, uint8_t, float, float, uint32_t>>;

Flown fly(const Walker& walker, const RayStream& rays, std::size_t batch) {
  Flown flown;
  FlightStream flights;
  WalkStatistics statistics;
  for (std::size_t begin = 0; begin < rays.size(); begin += batch) {
    const std::size_t count = std::min(batch, rays.size() - begin);
    RayStream some;
    some.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        some.origin[axis][i] = rays.origin[axis][begin + i];
        some.direction[axis][i] = rays.direction[axis][begin + i];
      }
      some.t_max[i] = rays.t_max[begin + i];
      some.pixel[i] = rays.pixel[begin + i];
      some.sample[i] = rays.sample[begin + i];
      some.stream[i] = rays.stream[begin + i];
    }
    walker.free_paths(some, flights, statistics);
    for (std::size_t i = 0; i < count; ++i) {
      flown.emplace_back(flights.t[i], flights.event[i], flights.component[i], flights.weight[0][i],
                         flights.emitted[0][i], flights.lookups[i]);
    }
  }
  return flown;
}

TEST(SparseWalk, FlightsDoNotDependOnBatchesOrInstructions) {
  const std::vector<PlacedVoxel> voxels = scattered_voxels();
  std::vector<Component> components(1);
  components[0].density = field_of_voxels(voxels);
  const Medium medium(std::move(components));
  RayStream rays = rays_between(voxels, 3000);
  rays.t_max[5] = NAN;
  rays.origin[1][6] = INFINITY;
  rays.direction[2][7] = NAN;
  WalkSettings settings;
  const Flown whole = fly(Walker(medium, settings), rays, rays.size());
  EXPECT_EQ(fly(Walker(medium, settings), rays, 1), whole);
  EXPECT_EQ(fly(Walker(medium, settings), rays, 37), whole);
  EXPECT_EQ(std::get<1>(whole[6]), Event::kEscape);
  for (const Simd simd : available_simd()) {
    if (simd != Simd::kAvx2 && simd != Simd::kAvx512) continue;
    settings.simd = simd;
    EXPECT_EQ(fly(Walker(medium, settings), rays, rays.size()), whole);
  }
}

}  // namespace
}  // namespace freepath
