#include "freepath/paths/open_jobs.h"

#include <algorithm>
#include <type_traits>

namespace freepath {
namespace {

/// Results that may wait for the last paths of their jobs, unless two jobs have more.
constexpr std::size_t kMostWaiting = std::size_t{1} << 18;
constexpr uint32_t kFewestOpenJobs = 2;

}  // namespace

void OpenJobs::begin(const Film& film, std::size_t paths_per_sample, bool is_light) {
  paths_per_sample_ = paths_per_sample;
  is_light_ = is_light;
  open_count_ = 0;
  waiting_ = 0;
  jobs_.clear();
  results.clear();
  spectra.clear();
  layers.begin(film, 0);
}

bool OpenJobs::has_room() const { return open_count_ < kFewestOpenJobs || waiting_ < kMostWaiting; }

std::size_t OpenJobs::first_free_slot(std::size_t paths) const {
  const auto is_free = [&](std::size_t first) {
    return std::none_of(jobs_.begin(), jobs_.end(), [&](const Job& job) {
      return job.is_open && first < job.first + job.paths && job.first < first + paths;
    });
  };
  std::size_t lowest = 0;
  if (is_free(lowest)) return lowest;
  lowest = std::max(results.size(), fluxes.size());
  for (const Job& job : jobs_) {
    const std::size_t behind = job.first + job.paths;
    if (job.is_open && behind < lowest && is_free(behind)) lowest = behind;
  }
  return lowest;
}

uint32_t OpenJobs::open(const PathJob& job, const Film& film) {
  const std::size_t paths = job.sample_count() * paths_per_sample_;
  const std::size_t first = first_free_slot(paths);
  const auto renew = [&](auto& values) {
    values.resize(std::max(values.size(), first + paths));
    // New ones too: the allocator leaves what earlier jobs have written.
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(first), paths,
                typename std::decay_t<decltype(values)>::value_type{});
  };
  if (is_light_) {
    fluxes.resize(std::max(fluxes.size(), first + paths));
  } else {
    renew(results);
  }
  if (film.buckets().count > 0) renew(spectra);
  layers.renew(first, paths, film);
  uint32_t number = 0;
  while (number < jobs_.size() && jobs_[number].is_open) ++number;
  if (number == jobs_.size()) jobs_.emplace_back();
  jobs_[number] = {job, first, paths, paths, true, {}, {}};
  jobs_[number].counts.paths = paths;
  ++open_count_;
  waiting_ += paths;
  return number;
}

void OpenJobs::close(uint32_t number) {
  jobs_[number].is_open = false;
  --open_count_;
  waiting_ -= jobs_[number].paths;
}

}  // namespace freepath
