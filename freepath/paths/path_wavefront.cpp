#include "freepath/paths/path_wavefront.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <shared_mutex>
#include <utility>
#include "freepath/tracking/reference/stop_scope.h"

namespace freepath {
namespace {

// Dimensions of SampleSequence.
constexpr uint32_t kFilmDimension = 0;
constexpr uint32_t kLensDimension = 1;

}  // namespace

PathWavefront::PathWavefront(const PathSetup& setup)
    : setup_(setup),
      scene_(*setup.scene),
      meter_(setup.meter),
      has_sides_(scene_.domain || (meter_ != nullptr && !meter_->splits.empty())),
      media_sets_(*setup.scene, *setup.factory),
      paths_(setup.slots),
      slots_(setup.slots),
      flying_(setup.slots, true),
      sent_(setup.slots, true),
      kernels_(setup.factory->scattering()),
      shadows_(*setup.scene, media_sets_, setup.seed, setup.slots),
      emissions_(*setup.scene, setup.slots),
      escapes_(setup.scene->lights ? setup.scene->lights->image_around() : nullptr,
               setup.factory->locate()) {
  if (setup.near_lights != nullptr) {
    near_lines_.emplace(setup.slots);
    near_shadows_.emplace(scene_, media_sets_, setup.seed, setup.slots, /*is_second=*/true);
  }
  if (scene_.surfaces) hits_.resize(setup.slots);
  if (setup.shadow_guide != nullptr && setup.shadow_guide->has_lobes()) {
    branches_.resize(setup.slots);
  }
  if (!scene_.surfaces && scene_.media.size() == 1 && !scene_.domain && meter_ == nullptr) {
    const Box3d box = scene_.media[0].outer_bounds();
    everything_ = Box3f(Vec3f(box.min - scene_.origin), Vec3f(box.max - scene_.origin));
    const Vec3f rounding = everything_->size() * 1e-4F;
    everything_->min -= rounding;
    everything_->max += rounding;
  }
  set_only_light();
  is_balanced_ = scene_.white_balance == Imath::M33f();
  camera_media_ = media_sets_.of(scene_.camera_media);
  for (uint32_t shape = 0; shape < scene_.shapes.size(); ++shape) {
    has_alpha_ = has_alpha_ || scene_.shapes[shape].alpha;
    const std::optional<uint32_t> light = scene_.shapes[shape].light;
    if (!light) continue;
    if (*light >= shapes_of_lights_.size()) shapes_of_lights_.resize(*light + std::size_t{1});
    shapes_of_lights_[*light] = shape;
  }
}

bool PathWavefront::trace(const PathJobSource& jobs, Film& film) {
  const StopScope scope(jobs.stop);
  jobs_.begin(film, setup_.factory->paths_per_sample(), meter_ != nullptr);
  records_spectra_ = film.buckets().count > 0;
  may_see_rgb_ = setup_.factory->sees_rgb() && !records_spectra_;
  window_ = film.window();
  active_ = next_path_ = paths_of_newest_ = 0;
  only_colors_ = nullptr;                                // the setup may have others since
  std::iota(slots_.begin(), slots_.end(), uint32_t{0});  // in order, as memory likes to be read
  sent_.clear();
  sent_in_vacuum_.clear();
  escapes_.clear();
  for (std::vector<LobeBranch>& waiting : branches_) waiting.clear();
  has_more_jobs_ = true;
  while (true) {
    while (active_ < setup_.slots && fill(slots_[active_], jobs, film)) ++active_;
    if (active_ == 0) return true;
    if (scope.stopped() || jobs.stop()) return false;
    if (near_lines_) trace_near_lines();
    fly();
    shadows_.trace(paths_, counts_.shadow_rays,
                   [&](const ScenePath& path, uint32_t cell, const SampledSpectrum& weight) {
                     deposit(path, cell, weight[0]);
                   });
    emissions_.trace(paths_, counts_.free_paths);
    see_outside();
    if (scope.stopped()) return false;
    end_paths(jobs, film);
  }
}

bool PathWavefront::trace(const PathJob& job, Film& film, const std::function<bool()>& stop) {
  bool is_taken = false;
  PathJobSource jobs;
  jobs.next = [&]() -> std::optional<PathJob> {
    if (std::exchange(is_taken, true)) return std::nullopt;
    return job;
  };
  if (stop) jobs.stop = stop;
  return trace(jobs, film);
}

bool PathWavefront::has_next_path(const PathJobSource& jobs, const Film& film) {
  if (next_path_ < paths_of_newest_) return true;
  const bool may_begin = jobs_.is_empty() || (jobs.overlaps && jobs_.has_room());
  if (!has_more_jobs_ || !may_begin) return false;
  const std::optional<PathJob> job = jobs.next();
  has_more_jobs_ = job.has_value();
  if (!job) return false;
  newest_ = jobs_.open(*job, film);
  next_path_ = 0;
  paths_of_newest_ = jobs_[newest_].paths;
  set_order(jobs_[newest_]);
  return true;
}

bool PathWavefront::misses_everything(const ScenePath& path) const {
  if (!everything_) return false;
  float begin = 0;
  float end = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / path.direction[axis];
    const float a = (everything_->min[axis] - path.origin[axis]) * inverse;
    const float b = (everything_->max[axis] - path.origin[axis]) * inverse;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin > end;
}

bool PathWavefront::fill(std::size_t slot, const PathJobSource& jobs, Film& film) {
  while (has_next_path(jobs, film)) {
    ScenePath& path = paths_[slot];
    if (meter_ != nullptr) {
      start_light(next_path_++, path);
      send(slot);
      return true;
    }
    start_path(next_path_++, path);
    if (!misses_everything(path)) {
      send(slot);
      return true;
    }
    escape(path);
    end_path(path, jobs, film);
  }
  return false;
}

void PathWavefront::end_path(ScenePath& path, const PathJobSource& jobs, Film& film) {
  finish(path);
  OpenJobs::Job& job = jobs_[path.job];
  if (--job.paths_left > 0) return;
  std::shared_lock<std::shared_mutex> adding;
  if (jobs.adding != nullptr) adding = std::shared_lock(*jobs.adding);
  if (meter_ == nullptr) {
    add_to_film(job, film);
  } else {
    add_to_tally(job);
  }
  counts_.merge(job.counts);
  jobs.finished(job.job);
  jobs_.close(path.job);
}

void PathWavefront::end_paths(const PathJobSource& jobs, Film& film) {
  for (std::size_t i = 0; i < active_;) {
    constexpr std::size_t kAhead = 8;
    const ScenePath* const ahead = &paths_[slots_[std::min(i + kAhead, active_ - 1)]];
    __builtin_prefetch(ahead);
    if (scene_.surfaces) __builtin_prefetch(&ahead->origin);  // most are sent from here
    const uint32_t slot = slots_[i];
    ScenePath& path = paths_[slot];
    if (!path.is_dead || take_branch(path) || take_lobe_branch(path)) {
      if (!path.is_sent) send(slot);
      ++i;
      continue;
    }
    end_path(path, jobs, film);
    // Paths stay where they are: streams of rays know them by their slots.
    if (fill(slot, jobs, film)) {
      ++i;
    } else {
      std::swap(slots_[i], slots_[--active_]);
    }
  }
}

void PathWavefront::set_order(OpenJobs::Job& opened) {
  const PathJob& job = opened.job;
  const std::size_t total = job.sample_count();
  order_.resize(total);
  std::iota(order_.begin(), order_.end(), uint32_t{0});
  if (!setup_.factory->depends_on_wavelengths()) return;
  // Flights of one set are walked together.
  begin_of_set_.assign(setup_.colors.size() + 1, 0);
  sets_.resize(total);
  opened.started.resize(total);
  for (std::size_t i = 0; i < total; ++i) {
    const PixelSample at = pixel_sample_of(job, i);
    sets_[i] = at.set - setup_.first_set;
    ++begin_of_set_[sets_[i] + 1];
  }
  std::partial_sum(begin_of_set_.begin(), begin_of_set_.end(), begin_of_set_.begin());
  for (std::size_t i = 0; i < total; ++i) {
    opened.started[i] = begin_of_set_[sets_[i]]++;
    order_[opened.started[i]] = static_cast<uint32_t>(i);
  }
}

PathWavefront::PixelSample PathWavefront::pixel_sample_of(const PathJob& job,
                                                          std::size_t number) const {
  const uint32_t pixel = window_.in_picture(job.pixel_of(number));
  const uint32_t sample = job.first_sample + static_cast<uint32_t>(number) % job.samples;
  return {pixel, sample, setup_.factory->set_of(pixel, sample, job.share)};
}

std::array<float, 2> PathWavefront::film_pair(const SampleSequence& numbers, uint32_t pixel,
                                              uint32_t sample) {
  if (scene_.samples != SampleKind::kSobol) return numbers.pair(kFilmDimension);
  if (pixel != hashed_pixel_) {
    film_hashes_ = SampleSequence::hashes(setup_.seed, pixel, kFilmDimension);
    hashed_pixel_ = pixel;
  }
  return SampleSequence::sobol_pair(film_hashes_, sample);
}

void PathWavefront::start_path(std::size_t path_number, ScenePath& path) {
  std::construct_at(&path);
  path.job = newest_;
  const auto number = static_cast<uint32_t>(path_number);
  const auto per_sample = static_cast<uint32_t>(setup_.factory->paths_per_sample());
  const uint32_t ordered = order_[number / per_sample];
  const auto channel = static_cast<int>(number % per_sample);
  const PixelSample at = pixel_sample_of(jobs_[newest_].job, ordered);
  path.result = static_cast<uint32_t>(jobs_[newest_].first) + number;
  path.pixel = setup_.first_random_pixel + at.pixel;
  path.sample_key = at.sample * per_sample + channel;
  // The paths of a sample start one after the other.
  if (channel == 0) colors_of_sample_ = &colors_of(at);
  path.colors = colors_of_sample_;
  const int channels = path.colors->spectra.channels();
  if (per_sample > 1) {
    path.channel = channel;
    path.hero = static_cast<uint8_t>(channel);
    path.only_hero = true;
    path.throughput[channel] = 1;
    path.may_differ = true;
  } else {
    for (int c = 0; c < channels; ++c) path.throughput[c] = 1;
  }

  // The channels' paths of a sample share its place on the film.
  const SampleSequence numbers(scene_.samples, setup_.seed, path.pixel, at.sample);
  const auto film = film_pair(numbers, path.pixel, at.sample);
  const FilterSample filtered = scene_.filter.sample(film[0], film[1]);
  const auto width = static_cast<uint32_t>(window_.full_width);
  const float x = static_cast<float>(at.pixel % width) + 0.5F + filtered.x;
  const uint32_t row = at.pixel / width;
  const float y = static_cast<float>(row) + 0.5F + filtered.y;
  std::array<float, 2> lens{};
  if (scene_.camera->has_lens()) lens = numbers.pair(kLensDimension);
  const float edge = setup_.pixel_edge;
  const CameraRay ray = scene_.camera->ray(x * edge, y * edge, lens[0], lens[1]);
  path.throughput *= filtered.weight;
  path.origin = path.turned_at = Vec3f(ray.origin - scene_.origin);
  path.direction = ray.direction;
  set_media(path, camera_media_);
  if (scene_.domain) {
    if (const auto entry = scene_.domain->enter(ray.origin - scene_.origin, path.direction)) {
      path.origin = path.turned_at = entry->origin;
      path.distance = entry->way;
    }
  }
  // Media choose heroes of their own.
  if (per_sample == 1 && scene_.surfaces) {
    RandomStream random(setup_.seed, path.pixel, path.sample_key,
                        stream_number(StreamPurpose::kCamera, 0));
    const auto drawn = static_cast<int>(random.uniform() * static_cast<float>(channels));
    path.hero = static_cast<uint8_t>(std::min(drawn, channels - 1));
  }
}

}  // namespace freepath
