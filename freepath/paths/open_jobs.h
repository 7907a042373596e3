#pragma once
/// @file The jobs that a wavefront has under way.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/page_allocator.h"
#include "freepath/base/sampled_spectrum.h"
#include "freepath/paths/flux_tally.h"
#include "freepath/paths/layer_recorder.h"
#include "freepath/paths/path_job.h"
#include "freepath/sensors/film.h"

namespace freepath {

/// Jobs whose paths are in flight together, and what these have found so far. The next job may
/// begin while the last paths of those before are still on their way: only so are lanes full where
/// a few paths scatter far more often than the others.
class OpenJobs {
 public:
  /// Forgets all jobs.
  /// @param paths_per_sample of all that come
  /// @param is_light whether paths are of light, so that they have `fluxes` in place of `results`
  void begin(const Film& film, std::size_t paths_per_sample, bool is_light = false);

  /// Whether another job may begin beside those that are open: what waits takes memory.
  bool has_room() const;
  /// Begins a job.
  /// @return its number, to be used until it is closed
  uint32_t open(const PathJob& job, const Film& film);
  /// Forgets a job.
  void close(uint32_t number);
  bool is_empty() const { return open_count_ == 0; }

  struct Job {
    PathJob job;
    std::size_t first = 0;  ///< Place of its first path's result.
    std::size_t paths = 0;
    std::size_t paths_left = 0;  ///< Paths that have not ended.
    bool is_open = false;
    PathCounts counts;  ///< But for walks.
    /// The slot in which each sample (pixel by pixel) started, if not in that of its number:
    /// results lie in the order in which paths start, so that those of paths in flight lie close
    /// together.
    std::vector<uint32_t> started;

    /// Place of the result of a sample's first path.
    std::size_t result_of(std::size_t sample, std::size_t paths_per_sample) const {
      return first + (started.empty() ? sample : started[sample]) * paths_per_sample;
    }
  };
  Job& operator[](uint32_t number) { return jobs_[number]; }
  const Job& operator[](uint32_t number) const { return jobs_[number]; }

  std::vector<PathSample, PageAllocator<PathSample>> results;
  /// Radiance of the same paths, if the film records spectra.
  std::vector<SampledSpectrum> spectra;
  LayerRecorder layers;            ///< Layers of the results.
  std::vector<FluxRecord> fluxes;  ///< Records of paths of light, which clear theirs as they start.

 private:
  /// The lowest place where so many results lie beside those of open jobs.
  std::size_t first_free_slot(std::size_t paths) const;

  std::size_t paths_per_sample_ = 1;
  bool is_light_ = false;
  uint32_t open_count_ = 0;
  std::size_t waiting_ = 0;  // results of open jobs
  std::vector<Job> jobs_;
};

}  // namespace freepath
