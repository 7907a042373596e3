/// @file Time of a tentative collision: the walk of other renderers (one ray after the other,
/// NanoVDB, trilinear) against the stream walk on every SIMD target, on a field that fits the
/// caches and on one that does not, in one interleaved run. bench/README.md has the figures.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <exception>
#include <memory>
#include <ranges>
#include <string>
#include <vector>

#include "bench/cloud.h"
#include "bench/nanovdb_walk.h"
#include "bench/summary.h"
#include "bench/timing.h"
#include "freepath/transport/walker.h"

namespace freepath::bench {
namespace {

constexpr std::size_t kBatches = 32;

/// A cloud, the rays through it and the two programs that walk them.
struct Problem {
  explicit Problem(int edge)
      : size(edge), medium(make_cloud(edge)), nanovdb(medium), rays(make_rays(medium, kBatches)) {}

  int size;
  Medium medium;
  NanovdbWalk nanovdb;
  std::vector<RayStream> rays;
};

/// One way to walk a batch of rays.
class Variant {
 public:
  virtual ~Variant() = default;
  /// Walks the rays. @return tentative collisions
  virtual double walk(const RayStream& rays) = 0;
  /// The same with what the test for equal means needs.
  virtual Tally tally(const RayStream& rays) = 0;
};

class NanovdbVariant : public Variant {
 public:
  NanovdbVariant(const NanovdbWalk& walk, Estimate estimate, Interpolation interpolation)
      : walk_(walk), estimate_(estimate), interpolation_(interpolation) {}
  double walk(const RayStream& rays) override { return tally(rays).collisions; }
  Tally tally(const RayStream& rays) override { return walk_.run(estimate_, interpolation_, rays); }

 private:
  const NanovdbWalk& walk_;
  Estimate estimate_;
  Interpolation interpolation_;
};

class StreamVariant : public Variant {
 public:
  StreamVariant(const Medium& medium, Estimate estimate, Interpolation interpolation, Simd simd)
      : walker_(medium, settings(interpolation, simd)), estimate_(estimate) {}

  double walk(const RayStream& rays) override {
    WalkStatistics statistics;
    if (estimate_ == Estimate::kFreePath) {
      walker_.free_paths(rays, flights_, statistics);
    } else {
      walker_.transmittance(rays, flights_, statistics);
    }
    return static_cast<double>(statistics.tentative_collisions);
  }

  Tally tally(const RayStream& rays) override {
    walk(rays);
    Tally tally;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double weight = estimate_ == Estimate::kTransmittance
                                ? flights_.weight[0][i]
                                : static_cast<double>(flights_.event[i] == Event::kEscape);
      tally.add_ray(flights_.lookups[i], weight);
    }
    return tally;
  }

 private:
  static WalkSettings settings(Interpolation interpolation, Simd simd) {
    WalkSettings settings;
    settings.interpolation = interpolation;
    settings.simd = simd;
    return settings;
  }

  Walker walker_;
  Estimate estimate_;
  FlightStream flights_;
};

struct Row {
  std::string title;
  std::shared_ptr<Variant> variant;
};

std::vector<Row> make_rows(const Problem& problem, Estimate estimate) {
  std::vector<Row> rows;
  const auto add_nanovdb = [&](const char* title, Interpolation interpolation) {
    rows.push_back(
        {title, std::make_shared<NanovdbVariant>(problem.nanovdb, estimate, interpolation)});
  };
  add_nanovdb("scalar, NanoVDB, trilinear", Interpolation::kTrilinear);
  add_nanovdb("scalar, NanoVDB, stochastic", Interpolation::kStochastic);
  const std::vector<Simd> available = available_simd();
  for (const Simd simd : std::ranges::reverse_view(available)) {
    for (const auto& [name, interpolation] :
         {std::pair("trilinear", Interpolation::kTrilinear),
          std::pair("stochastic", Interpolation::kStochastic)}) {
      rows.push_back(
          {fmt::format("walk, {}, {}", to_string(simd), name),
           std::make_shared<StreamVariant>(problem.medium, estimate, interpolation, simd)});
    }
  }
  return rows;
}

void time_variant(benchmark::State& state, Variant& variant,
                  const std::vector<RayStream>& streams) {
  double collisions = 0;
  double rays = 0;
  double seconds = 0;
  for (auto _ : state) {
    const double start = thread_seconds();
    for (const RayStream& stream : streams) {
      collisions += variant.walk(stream);
      rays += static_cast<double>(stream.size());
    }
    seconds += thread_seconds() - start;
  }
  state.counters[kTimeCounter] = seconds * 1e9 / collisions;
  state.counters["collisions_per_ray"] = collisions / rays;
}

/// Registers a benchmark for every row.
Table make_table(const Problem& problem, Estimate estimate) {
  const bool free_path = estimate == Estimate::kFreePath;
  Table table;
  table.title = fmt::format("{0}^3, {1}", problem.size,
                            free_path ? "delta tracking to the first real collision"
                                      : "ratio tracking of a transmittance");
  for (const Row& row : make_rows(problem, estimate)) {
    const std::string name =
        fmt::format("{}^3/{}/{}", problem.size, free_path ? "delta" : "ratio", row.title);
    table.rows.push_back(row.title);
    table.benchmarks.push_back(name);
    benchmark::RegisterBenchmark(name.c_str(), [variant = row.variant,
                                                &problem](benchmark::State& state) {
      time_variant(state, *variant, problem.rays);
    })->Unit(benchmark::kMillisecond);
    table.tallies.emplace_back([variant = row.variant, &problem] {
      Tally tally;
      for (const RayStream& stream : problem.rays) tally.merge(variant->tally(stream));
      return tally;
    });
  }
  return table;
}

void describe(const Problem& problem) {
  const SuperVoxels& cells = problem.medium.super_voxels();
  const BrickMap& map = problem.medium.components()[0].density->voxels;
  fmt::print(
      "{}^3: {:.1f} MB of bricks, {:.1f} MB of super-voxels of {} voxels an edge, "
      "majorants {:.1f} times the mean extinction\n",
      problem.size, static_cast<double>(map.memory_bytes()) / 1e6,
      static_cast<double>(cells.memory_bytes()) / 1e6, cells.cell_size,
      majorant_ratio(problem.medium));
}

int run(int argc, char** argv) {
  // Standards first, so that what the user gives stands.
  std::string standards[] = {"--benchmark_enable_random_interleaving=true",
                             "--benchmark_repetitions=7", "--benchmark_min_time=0.1"};
  std::vector<char*> arguments = {argv[0]};
  for (std::string& standard : standards) arguments.push_back(standard.data());
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;

  const Problem problems[] = {Problem(128), Problem(512)};
  std::vector<Table> tables;
  for (const Problem& problem : problems) {
    describe(problem);
    for (const Estimate estimate : {Estimate::kFreePath, Estimate::kTransmittance}) {
      tables.push_back(make_table(problem, estimate));
    }
  }
  KeepingReporter reporter(benchmark::ConsoleReporter::OO_None);
  benchmark::RunSpecifiedBenchmarks(&reporter);
  bool same = true;
  for (const Table& table : tables) same &= report(table, reporter);
  return same ? 0 : 1;
}

}  // namespace
}  // namespace freepath::bench

int main(int argc, char** argv) {
  try {
    return freepath::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "walk_bench: {}\n", error.what());
    return 1;
  }
}
