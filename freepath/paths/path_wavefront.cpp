#include "freepath/paths/path_wavefront.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include "freepath/tracking/reference/stop_scope.h"

namespace freepath {
namespace {

// Dimensions of SampleSequence.
constexpr uint32_t kFilmDimension = 0;
constexpr uint32_t kLensDimension = 1;

Spectrum to_spectrum(const Vec3f& rgb) { return {rgb.x, rgb.y, rgb.z}; }

float mean(const Channels& values, int channels) {
  float sum = 0;
  for (int c = 0; c < channels; ++c) sum += values[c];
  return sum / static_cast<float>(channels);
}

}  // namespace

PathWavefront::PathWavefront(const PathSetup& setup)
    : setup_(setup),
      scene_(*setup.scene),
      places_(*setup.scene, *setup.factory),
      paths_(setup.slots),
      batches_(setup.slots, true),
      shadows_(*setup.scene, places_, setup.seed, setup.slots),
      emissions_(*setup.scene, setup.slots) {
  camera_place_ = places_.of(scene_.camera_media);
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
  jobs_.begin(film, setup_.factory->paths_per_sample());
  records_spectra_ = film.buckets().count > 0;
  window_ = film.window();
  active_ = next_path_ = paths_of_newest_ = 0;
  has_more_jobs_ = true;
  while (true) {
    start_paths(jobs, film);
    if (active_ == 0) return true;
    if (scope.stopped() || jobs.stop()) return false;
    fly();
    shadows_.trace(paths_, counts_.shadow_rays);
    emissions_.trace(paths_, counts_.free_paths);
    if (scope.stopped()) return false;
    end_paths(jobs, film);
  }
}

bool PathWavefront::trace(const PathJob& job, Film& film) {
  bool is_taken = false;
  PathJobSource jobs;
  jobs.next = [&]() -> std::optional<PathJob> {
    if (std::exchange(is_taken, true)) return std::nullopt;
    return job;
  };
  return trace(jobs, film);
}

void PathWavefront::start_paths(const PathJobSource& jobs, const Film& film) {
  while (active_ < setup_.slots) {
    if (next_path_ == paths_of_newest_) {
      const bool may_begin = jobs_.is_empty() || (jobs.overlaps && jobs_.has_room());
      if (!has_more_jobs_ || !may_begin) return;
      const std::optional<PathJob> job = jobs.next();
      has_more_jobs_ = job.has_value();
      if (!job) return;
      newest_ = jobs_.open(*job, film);
      next_path_ = 0;
      paths_of_newest_ = jobs_[newest_].paths;
      set_order(*job);
    }
    start_path(next_path_++, paths_[active_++]);
  }
}

void PathWavefront::end_paths(const PathJobSource& jobs, Film& film) {
  for (std::size_t slot = 0; slot < active_;) {
    if (!paths_[slot].is_dead) {
      ++slot;
      continue;
    }
    finish(paths_[slot]);
    const uint32_t number = paths_[slot].job;
    paths_[slot] = std::move(paths_[--active_]);
    if (--jobs_[number].paths_left > 0) continue;
    add_to_film(jobs_[number], film);
    counts_.merge(jobs_[number].counts);
    jobs.finished(jobs_[number].job);
    jobs_.close(number);
  }
}

void PathWavefront::set_order(const PathJob& job) {
  const std::size_t total = job.sample_count();
  order_.resize(total);
  std::iota(order_.begin(), order_.end(), uint32_t{0});
  if (!setup_.factory->depends_on_wavelengths()) return;
  // Flights of one set are walked together.
  begin_of_set_.assign(setup_.colors.size() + 1, 0);
  sets_.resize(total);
  for (std::size_t i = 0; i < total; ++i) {
    const auto pixel = static_cast<uint32_t>(window_.in_picture(job.first_pixel + i / job.samples));
    const uint32_t sample = job.first_sample + static_cast<uint32_t>(i % job.samples);
    sets_[i] = setup_.factory->set_of(pixel, sample) - setup_.first_set;
    ++begin_of_set_[sets_[i] + 1];
  }
  std::partial_sum(begin_of_set_.begin(), begin_of_set_.end(), begin_of_set_.begin());
  for (std::size_t i = 0; i < total; ++i) {
    order_[begin_of_set_[sets_[i]]++] = static_cast<uint32_t>(i);
  }
}

void PathWavefront::start_path(std::size_t number, ScenePath& path) {
  const PathJob& job = jobs_[newest_].job;
  path = {};
  path.job = newest_;
  const auto per_sample = static_cast<std::size_t>(setup_.factory->paths_per_sample());
  const std::size_t place = order_[number / per_sample];
  const auto channel = static_cast<int>(number % per_sample);
  const std::size_t pixel = place / job.samples;
  const auto sample = static_cast<uint32_t>(place % job.samples);
  path.result = static_cast<uint32_t>(jobs_[newest_].first + place * per_sample) + channel;
  path.pixel = static_cast<uint32_t>(window_.in_picture(job.first_pixel + pixel));
  const uint32_t sample_number = job.first_sample + sample;
  path.sample_key = sample_number * static_cast<uint32_t>(per_sample) + channel;
  // The paths of a sample start one after the other.
  if (channel == 0) colors_of_sample_ = &colors_of(path.pixel, sample_number);
  path.colors = colors_of_sample_;
  const int channels = path.colors->spectra.channels();
  if (per_sample > 1) {
    path.channel = path.hero = channel;
    path.only_hero = true;
    path.throughput[channel] = 1;
  } else {
    for (int c = 0; c < channels; ++c) path.throughput[c] = 1;
  }

  // The channels' paths of a sample share its place on the film.
  const SampleSequence numbers(scene_.samples, setup_.seed, path.pixel, sample_number);
  const auto film = numbers.pair(kFilmDimension);
  const FilterSample filtered = scene_.filter.sample(film[0], film[1]);
  const auto width = static_cast<std::size_t>(scene_.camera->width());
  const float x = static_cast<float>(path.pixel % width) + 0.5F + filtered.x;
  const std::size_t row = path.pixel / width;
  const float y = static_cast<float>(row) + 0.5F + filtered.y;
  std::array<float, 2> lens{};
  if (scene_.camera->has_lens()) lens = numbers.pair(kLensDimension);
  const CameraRay ray = scene_.camera->ray(x, y, lens[0], lens[1]);
  path.throughput *= filtered.weight;
  path.origin = path.turned_at = Vec3f(ray.origin - scene_.origin);
  path.direction = ray.direction;
  set_place(path, camera_place_);
  if (per_sample == 1) {
    RandomStream random(setup_.seed, path.pixel, path.sample_key,
                        stream_number(StreamPurpose::kCamera, 0));
    path.hero =
        std::min(static_cast<int>(random.uniform() * static_cast<float>(channels)), channels - 1);
  }
}

bool PathWavefront::needs_surfaces_first(const ScenePath& path) const {
  if (!scene_.surfaces || path.surfaces_known) return false;
  return !scene_.is_clear_at(path.medium, path.origin);
}

void PathWavefront::find_surface(ScenePath& path) const {
  path.surfaces_known = true;
  if (scene_.surfaces) {
    path.hit = scene_.surfaces->intersect(path.origin, path.direction, 0,
                                          std::numeric_limits<float>::infinity());
  }
}

void PathWavefront::fly() {
  batches_.clear();
  for (std::size_t slot = 0; slot < active_; ++slot) {
    ScenePath& path = paths_[slot];
    if (needs_surfaces_first(path)) find_surface(path);
    if (path.medium == kVacuum) {
      fly_in_vacuum(slot);
      continue;
    }
    const Walker& walker = path.colors->walker(path.medium, path.channel);
    auto [batch, i] = batches_.add(walker, static_cast<uint32_t>(slot));
    RayStream& rays = batch.rays;
    set_ray(rays, i, path.origin, path.direction,
            path.hit ? path.hit->t : std::numeric_limits<float>::infinity());
    rays.pixel[i] = path.pixel;
    rays.sample[i] = path.sample_key;
    rays.stream[i] = stream_number(StreamPurpose::kWalk, path.flights);
    if (!rays.weighted()) continue;
    for (int c = 0; c < walker.channels(); ++c) {
      rays.weight[c][i] = path.throughput[c];
      rays.density[c][i] = path.density[c];
    }
  }
  for (WalkBatches::Batch* const batch : batches_.finish()) {
    batch->walker->free_paths(batch->rays, flights_, counts_.free_paths);
    for (std::size_t i = 0; i < batch->count; ++i) {
      take_flight(batch->owners[i], *batch->walker, i, batch->rays.weighted());
    }
  }
}

void PathWavefront::fly_in_vacuum(std::size_t slot) {
  ScenePath& path = paths_[slot];
  if (!path.surfaces_known) find_surface(path);
  if (path.hit) {
    meet_surface(slot);
  } else {
    escape(path);
  }
}

void PathWavefront::take_flight(std::size_t slot, const Walker& walker, std::size_t i,
                                bool weighted) {
  ScenePath& path = paths_[slot];
  path.lookups += flights_.lookups[i];
  const int channels = walker.channels();
  if (weighted) {
    for (int c = 0; c < channels; ++c) {
      path.radiance[c] += flights_.emitted[c][i] * path.emission_share;
      path.throughput[c] = flights_.weight[c][i];
      path.density[c] = flights_.density[c][i];
    }
  } else {
    // A walker of one channel serves all, or the only one that there is.
    path.radiance += path.throughput * (flights_.emitted[0][i] * path.emission_share);
    path.throughput *= flights_.weight[0][i];
  }
  if (!(largest_magnitude(path.throughput) < kLargestThroughput)) {
    path.radiance = Channels(std::numeric_limits<float>::quiet_NaN());  // finish() counts it
    path.is_dead = true;
    return;
  }
  switch (flights_.event[i]) {
    case Event::kAbsorb:
      if (path.scatterings == 0) {
        record_medium_event(path, flights_.t[i], scatterer_of(path, flights_.component[i]));
      }
      path.is_dead = true;
      return;
    case Event::kScatter:
      scatter_in_medium(slot, flights_.t[i], flights_.component[i]);
      return;
    case Event::kEscape:
      break;
  }
  if (!path.surfaces_known) find_surface(path);
  if (path.hit) {
    meet_surface(slot);
  } else {
    escape(path);
  }
}

void PathWavefront::escape(ScenePath& path) {
  path.is_dead = true;
  if (path.scatterings == 0) {
    path.sample.alpha = 1 - carried_mean(path, path.throughput);
    if (jobs_.layers.on()) jobs_.layers.transmittance(path.result, transmittance_of(path));
  }
  const bool in_rgb = sees_rgb(path);
  const LightSeen light =
      scene_.lights->escape(path.turned_at, path.direction, light_spectra(path, in_rgb));
  // What next-event estimation could have found too is shared with it.
  const float share = path.pdf > 0 ? path.pdf / (path.pdf + light.pdf) : 1.0F;
  const Channels seen = light_throughput(path, in_rgb) * light.radiance * share;
  if (jobs_.layers.on() && path.scatterings == 0) {
    jobs_.layers.background(path.result,
                            rgb_of(path, in_rgb ? Channels() : seen, in_rgb ? seen : Channels()));
  }
  (in_rgb ? path.rgb : path.radiance) += seen;
}

MediumWalkers::Origin PathWavefront::scatterer_of(const ScenePath& path, std::size_t component) {
  const auto& origins = path.colors->walkers(path.medium).origins;
  if (!origins.empty()) return origins[component];
  return {path.medium, static_cast<uint32_t>(component)};
}

void PathWavefront::record_medium_event(ScenePath& path, float t,
                                        const MediumWalkers::Origin& scatterer) {
  const SceneMedium& medium = scene_.media[scatterer.medium];
  // Weighted absorption has put the albedo into each channel's weight: no matter of depth.
  Channels weight = path.throughput;
  if (setup_.absorption == Absorption::kWeighted) {
    const Channels albedo = medium.albedo(scatterer.component, path.colors->spectra);
    for (int c = 0; c < path.colors->spectra.channels(); ++c) {
      weight[c] = albedo[c] > 0 ? weight[c] / albedo[c] : 1.0F;
    }
  }
  record_event(path, t, weight, medium.albedo(scatterer.component, setup_.factory->rgb()),
               -path.direction);
}

float PathWavefront::carried_mean(const ScenePath& path, const Channels& values) {
  // A path of one channel is the only one to see it.
  return path.channel < 0 ? mean(values, path.colors->spectra.channels()) : values[path.channel];
}

void PathWavefront::record_event(ScenePath& path, float t, const Channels& weight,
                                 const Channels& albedo, const Vec3f& normal) {
  path.sample.alpha = 1;
  path.sample.albedo = {albedo[0], albedo[1], albedo[2]};
  path.sample.depth = path.distance + t;
  path.sample.depth_weight = carried_mean(path, weight);
  if (!jobs_.layers.on()) return;
  const Vec3f position = path.origin + path.direction * t + Vec3f(scene_.origin);
  jobs_.layers.event(
      path.result, normal, position,
      path.sample.depth_weight / static_cast<float>(setup_.factory->paths_per_sample()));
}

Spectrum PathWavefront::rgb_of(const ScenePath& path, const Channels& radiance,
                               const Channels& rgb) const {
  const Vec3f sum = path.colors->spectra.to_rgb(radiance) + Vec3f(rgb[0], rgb[1], rgb[2]);
  return to_spectrum(sum * scene_.white_balance * scene_.exposure_scale);
}

Spectrum PathWavefront::transmittance_of(const ScenePath& path) const {
  const SpectrumValues& spectra = path.colors->spectra;
  const Channels& t = path.throughput;
  if (!spectra.is_spectral()) return {t[0], t[1], t[2]};
  return to_spectrum(spectra.to_rgb(t * spectra.illuminant(Vec3f(1))));
}

void PathWavefront::finish(ScenePath& path) {
  PathSample& sample = jobs_.results[path.result];
  sample.lookups = static_cast<float>(path.lookups);
  if (!is_finite(path.radiance) || !is_finite(path.rgb) || !std::isfinite(path.sample.alpha) ||
      !std::isfinite(path.sample.depth_weight)) {
    ++jobs_[path.job].counts.overflows;
    sample.overflowed = true;
    return;
  }
  sample.radiance = rgb_of(path, path.radiance, path.rgb);
  if (records_spectra_) jobs_.spectra[path.result] = path.radiance;
  if (jobs_.layers.on()) jobs_.layers.end(path.result, path.scatterings, sample.radiance);
  sample.alpha = path.sample.alpha;
  sample.albedo = path.sample.albedo;
  sample.depth = path.sample.depth;
  sample.depth_weight = path.sample.depth_weight;
}

void PathWavefront::add_spectrum(const OpenJobs::Job& done, std::size_t sample, Film& film) const {
  const PathJob& job = done.job;
  const auto per_sample = static_cast<std::size_t>(setup_.factory->paths_per_sample());
  Channels radiance;
  for (std::size_t c = 0; c < per_sample; ++c) {
    radiance += jobs_.spectra[done.first + sample * per_sample + c];
  }
  const uint32_t number = job.first_sample + static_cast<uint32_t>(sample % job.samples);
  const auto pixel =
      static_cast<uint32_t>(window_.in_picture(job.first_pixel + sample / job.samples));
  const SpectrumValues& values = colors_of(pixel, number).spectra;
  // In the light's units, which the colour matching of our observer takes out.
  constexpr auto kLightUnit = static_cast<float>(1 / kLuminousIntegral);
  film.add_spectrum(job.first_pixel + sample / job.samples,
                    std::span(values.wavelengths()).first(values.channels()),
                    radiance * (scene_.exposure_scale * kLightUnit));
}

void PathWavefront::add_to_film(const OpenJobs::Job& done, Film& film) const {
  const PathJob& job = done.job;
  const auto per_sample = static_cast<std::size_t>(setup_.factory->paths_per_sample());
  const float share = 1.0F / static_cast<float>(per_sample);
  for (std::size_t i = 0; i < job.sample_count(); ++i) {
    // The paths of the channels, always in the same order.
    const std::size_t first = done.first + i * per_sample;
    PathSample sum = jobs_.results[first];
    LayerSample layers = jobs_.layers[first];
    if (per_sample > 1) {
      sum = {};
      layers = {};
      for (std::size_t c = 0; c < per_sample; ++c) {
        const PathSample& part = jobs_.results[first + c];
        sum.radiance += part.radiance;
        sum.overflowed |= part.overflowed;
        sum.lookups += part.lookups;
        sum.alpha += part.alpha * share;
        sum.albedo += part.albedo * share;
        const float weight = part.depth_weight * share;
        if (weight > 0) {
          const float total = sum.depth_weight + weight;
          sum.depth = (sum.depth * sum.depth_weight + part.depth * weight) / total;
          sum.depth_weight = total;
        }
        layers += jobs_.layers[first + c];
      }
    }
    film.add(job.first_pixel + i / job.samples, sum, layers);
    if (records_spectra_) add_spectrum(done, i, film);
  }
}

}  // namespace freepath
