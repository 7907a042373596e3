/// @file What a free path costs as voxels grow smaller: the same puffs from 64³ to 2048³ voxels,
/// cut into the same super-voxels from 128³ on, walked by the same rays [SzirmayKalos11]. Prints a
/// table, or JSON with --json.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/timing.h"
#include "freepath/base/random.h"
#include "freepath/scene/procedural.h"
#include "freepath/transport/walker.h"

namespace freepath::bench {
namespace {

constexpr int kRounds = 9;
constexpr std::size_t kBatches = 24;
constexpr std::size_t kRaysPerBatch = 8192;

/// A resolution, and the edge of its super-voxels [voxels].
struct Level {
  int resolution, super_voxel;
};
constexpr std::array<Level, 6> kLevels = {
    {{64, 4}, {128, 4}, {256, 8}, {512, 16}, {1024, 32}, {2048, 64}}};

/// Extinctions of the puffs [1/world]: 1.4 and 24 mean free paths through the middle of each.
constexpr std::array kExtinctions = {0.03F, 0.5F};

using Fields = std::vector<std::shared_ptr<const Field>>;  // of the levels

Fields make_fields() {
  Fields fields;
  for (const Level& level : kLevels) {
    ProceduralOptions options;
    options.resolution = level.resolution;
    fields.push_back(std::make_shared<const Field>(std::move(generate_puffs(options).front())));
  }
  return fields;
}

/// The puffs at a resolution.
struct Contestant {
  Contestant(const Level& with, const std::shared_ptr<const Field>& field, float extinction)
      : level(with), medium(make(with, field, extinction)), walker(medium, {}) {}

  static Medium make(const Level& level, const std::shared_ptr<const Field>& field,
                     float extinction) {
    Component component;
    component.density = field;
    component.sigma_s = Rgb(extinction);
    return Medium({component}, level.super_voxel);
  }

  Level level;
  Medium medium;
  Walker walker;
  std::vector<double> nanoseconds;  // of a free path, in each round
  WalkStatistics statistics;
};

/// Rays between random points of the sphere around the volume.
std::vector<RayStream> make_rays() {
  constexpr float kRadius = 80;
  std::vector<RayStream> batches(kBatches);
  uint32_t number = 0;
  for (RayStream& rays : batches) {
    rays.resize(kRaysPerBatch);
    for (std::size_t i = 0; i < kRaysPerBatch; ++i, ++number) {
      RandomStream random(11, number, 0, 0);
      const auto on_sphere = [&] {
        const float z = 2 * random.uniform() - 1;
        const float angle = 6.2831853F * random.uniform();
        const float r = std::sqrt(1 - z * z);
        return Vec3f(r * std::cos(angle), r * std::sin(angle), z) * kRadius;
      };
      const Vec3f begin = on_sphere();
      const Vec3f direction = (on_sphere() - begin).normalized();
      const Vec3f origin = begin + Vec3f(0, 50, 0);
      for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis][i] = origin[axis];
        rays.direction[axis][i] = direction[axis];
      }
      rays.t_max[i] = 1e30F;
      rays.pixel[i] = number;
      rays.sample[i] = 0;
      rays.stream[i] = 0;
    }
  }
  return batches;
}

void walk(Contestant& contestant, const std::vector<RayStream>& batches, FlightStream& flights) {
  WalkStatistics counts;
  const double start = thread_seconds();
  for (const RayStream& rays : batches) contestant.walker.free_paths(rays, flights, counts);
  contestant.nanoseconds.push_back(1e9 * (thread_seconds() - start) /
                                   static_cast<double>(counts.rays));
  contestant.statistics = counts;
}

void print(const std::vector<std::unique_ptr<Contestant>>& contestants, float extinction,
           bool json) {
  if (!json) {
    fmt::print("extinction {}\n", extinction);
    fmt::print("{:>10} {:>12} {:>14} {:>12} {:>10} {:>12} {:>12}\n", "voxels", "MiB",
               "super-voxels", "ns/path", "of 512^3", "look-ups", "steps");
  }
  const auto each = [](const Contestant& contestant, uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(contestant.statistics.rays);
  };
  double standard = 0;
  for (const auto& contestant : contestants) {
    if (contestant->level.resolution == 512) standard = median(contestant->nanoseconds);
  }
  for (const auto& contestant : contestants) {
    const double nanoseconds = median(contestant->nanoseconds);
    const double megabytes =
        static_cast<double>(
            contestant->medium.components().front().density->voxels.memory_bytes()) /
        (1 << 20);
    const WalkStatistics& counts = contestant->statistics;
    const std::size_t cells = contestant->medium.super_voxels().cell_count();
    if (json) {
      fmt::print(
          "{{\"extinction\": {}, \"resolution\": {}, \"megabytes\": {:.1f}, \"super_voxels\": {}, "
          "\"nanoseconds_per_path\": {:.2f}, \"lookups_per_path\": {:.5f}, "
          "\"steps_per_path\": {:.4f}}}\n",
          extinction, contestant->level.resolution, megabytes, cells, nanoseconds,
          each(*contestant, counts.lookups), each(*contestant, counts.super_voxel_steps));
    } else {
      fmt::print("{:>9}3 {:>12.1f} {:>14} {:>12.1f} {:>10.2f} {:>12.4f} {:>12.3f}\n",
                 fmt::format("{}^", contestant->level.resolution), megabytes, cells, nanoseconds,
                 nanoseconds / standard, each(*contestant, counts.lookups),
                 each(*contestant, counts.super_voxel_steps));
    }
  }
}

void run(bool json) {
  const Fields fields = make_fields();
  const std::vector<RayStream> rays = make_rays();
  FlightStream flights;
  for (const float extinction : kExtinctions) {
    std::vector<std::unique_ptr<Contestant>> contestants;
    for (std::size_t i = 0; i < kLevels.size(); ++i) {
      contestants.push_back(std::make_unique<Contestant>(kLevels[i], fields[i], extinction));
    }
    for (int round = 0; round < kRounds; ++round) {
      for (const auto& contestant : contestants) walk(*contestant, rays, flights);
    }
    print(contestants, extinction, json);
  }
}

}  // namespace
}  // namespace freepath::bench

int main(int argc, char** argv) {
  try {
    freepath::bench::run(argc > 1 && std::string_view(argv[1]) == "--json");
  } catch (const std::exception& error) {
    fmt::print(stderr, "resolution_bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
