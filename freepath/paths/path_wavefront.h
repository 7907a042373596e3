#pragma once
/// @file A wavefront of paths: all paths of a stretch of pixels, traced together.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/lights/lights.h"
#include "freepath/media/phase/phase_function.h"
#include "freepath/paths/layer_recorder.h"
#include "freepath/sensors/camera.h"
#include "freepath/sensors/film.h"
#include "freepath/transport/walker.h"

namespace freepath {

/// Throughputs beyond this are about to overflow: times a radiance they still fit a float.
inline constexpr float kLargestThroughput = 1e28F;

/// What all paths of a picture share.
struct PathSetup {
  const Medium* medium = nullptr;
  const Camera* camera = nullptr;
  const Lights* lights = nullptr;
  /// What rays are relative to [world]; that of the walkers' settings.
  Vec3d origin{0, 0, 0};
  /// One walker that carries all channels, or one for each channel (a path each).
  std::vector<Walker> walkers;
  Absorption absorption = Absorption::kWeighted;
  uint64_t seed = 0;
  uint32_t max_scatterings = UINT32_MAX;
  /// Russian roulette is played where no channel's throughput reaches this.
  float roulette_threshold = 0.25F;
  std::size_t slots = 2048;  ///< Paths in flight in a wavefront.
};

/// A rectangle of work: `pixels` pixels of the film from `first_pixel` on (row-major), samples
/// [first_sample, first_sample + samples) of each.
struct PathJob {
  std::size_t first_pixel = 0;
  std::size_t pixels = 0;
  uint32_t first_sample = 0;
  uint32_t samples = 0;

  std::size_t sample_count() const { return pixels * samples; }
};

/// Where a wavefront gets its jobs from.
struct PathJobSource {
  /// The next job, none of which has a pixel of another that is under way; nothing if there is
  /// none.
  std::function<std::optional<PathJob>()> next;
  /// Told of each that has been added to the film.
  std::function<void(const PathJob&)> finished = [](const PathJob&) {};
  /// Asked before every flight; once it is true the jobs under way are dropped whole: nothing of
  /// them is added to the film.
  std::function<bool()> stop = [] { return false; };
  /// Whether a job may begin before the one before it has ended, so that lanes stay full.
  bool overlaps = true;
};

/// Traces paths through a medium lit from outside and from within: walk, scatter with next-event
/// estimation and multiple importance sampling [Veach97, balance heuristic], Russian roulette,
/// until every path has ended. A path that ends makes room for the next, so that the lanes stay
/// full. One wavefront for each thread; its memory is used again.
class PathWavefront {
 public:
  explicit PathWavefront(const PathSetup& setup);

  /// Traces jobs, one after the other, as long as there are any.
  /// @return false if they were stopped
  bool trace(const PathJobSource& jobs, Film& film) {
    while (const std::optional<PathJob> job = jobs.next()) {
      if (!trace(*job, film, jobs.stop)) return false;
      jobs.finished(*job);
    }
    return true;
  }
  /// Traces a job and adds its samples to the film, each pixel's in the order of their numbers.
  /// @param stop asked before every flight of the wavefront; once it is true the job is dropped
  ///   whole: nothing is added to the film or to the counts
  /// @return whether the job was finished
  bool trace(const PathJob& job, Film& film, const std::function<bool()>& stop = {});

  /// Counts over all jobs that were finished.
  struct Counts {
    WalkStatistics free_paths;   ///< Of the tracker.
    WalkStatistics shadow_rays;  ///< Of the transmittance estimator.
    uint64_t paths = 0;
    /// Paths whose weight grew beyond the range of float; they count as 0, so a picture with any is
    /// not to be trusted. Only rates that are no bound can do that.
    uint64_t overflows = 0;
    /// Paths that the limit of scatterings ended, and the weight that they still had: the mean of
    /// their channels, in units of kWeightUnit, so that sums don't depend on their order.
    uint64_t cut_paths = 0, cut_weight = 0;
    static constexpr double kWeightUnit = 0x1p-20;

    /// Counts a path that the limit ends.
    void cut(float weight) {
      constexpr double kMost = 1e6;
      ++cut_paths;
      cut_weight += static_cast<uint64_t>(std::clamp(double{weight}, 0.0, kMost) / kWeightUnit);
    }

    void merge(const Counts& other) {
      free_paths.merge(other.free_paths);
      shadow_rays.merge(other.shadow_rays);
      paths += other.paths;
      overflows += other.overflows;
      cut_paths += other.cut_paths;
      cut_weight += other.cut_weight;
    }
  };
  const Counts& counts() const { return counts_; }

 private:
  /// A path in flight. Its ray stands in the same slot of rays_.
  struct Path {
    Spectrum throughput{0.0F};
    Spectrum density{1.0F};  ///< FlightStream::density of the flights so far.
    Spectrum radiance{0.0F};
    float phase_pdf;  ///< Density with which the direction was drawn [1/sr].
    uint32_t bounce;  ///< Scatterings so far.
    uint32_t result;  ///< Place among the job's samples.
    uint64_t lookups;
    float alpha;
    Spectrum albedo{0.0F};
    float depth;
    float depth_weight;
  };
  /// Light on its way from a scattering to the lights.
  struct ShadowPath {
    std::size_t slot;
    Spectrum radiance;  ///< What arrives if nothing is in between.
  };

  /// @return whether it came to the end
  bool trace_channel(const PathJob& job, int channel, const std::function<bool()>& stop);
  void start_path(const PathJob& job, std::size_t number, std::size_t slot, int channel);
  /// Takes in what became of a path's flight; false if the path has ended.
  bool advance(std::size_t slot);
  /// Tells spectral trackers the throughputs of the paths that they are to continue.
  void bring_weights(std::size_t active);
  /// Adds what a flight has collected, and weights the path with it.
  void take_weights(Path& path, std::size_t slot);
  void escape(Path& path, const Vec3f& direction);
  bool scatter(Path& path, std::size_t slot);
  void sample_light(const Path& path, std::size_t slot, const Vec3f& position,
                    const Vec3f& direction, const PhaseFunction& phase, RandomStream& random);
  void record_first_event(Path& path, std::size_t slot) const;
  /// How much the first event of a path counts for means over events: its probability in the mean
  /// over the channels that the path carries, over that with which it came about.
  float depth_weight(std::size_t slot, const Spectrum& albedo) const;
  void record_layers(const Path& path, std::size_t slot);
  void finish(const Path& path, int channel);
  void trace_shadows();

  const PathSetup& setup_;
  bool emits_;                         // whether the medium does
  bool carries_one_channel_ = false;   // whether the paths in flight do
  std::vector<PhaseFunction> phases_;  // of the components
  std::vector<Spectrum> albedos_;      // of the components
  std::vector<Path> paths_in_flight_;
  RayStream rays_;
  FlightStream flights_;
  RayStream shadow_rays_;
  FlightStream shadow_flights_;
  std::vector<ShadowPath> shadows_;
  std::vector<PathSample> results_;
  LayerRecorder layers_;            // of the results
  PixelWindow window_;              // of the film at work
  const Walker* walker_ = nullptr;  // of the channel at work
  Counts job_counts_;
  Counts counts_;
};

}  // namespace freepath
