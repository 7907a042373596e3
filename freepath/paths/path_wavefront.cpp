#include "freepath/paths/path_wavefront.h"

#include <algorithm>
#include <limits>

#include "freepath/base/random.h"
#include "freepath/tracking/reference/stop_scope.h"

namespace freepath {
namespace {

Spectrum albedo_of(const Component& component) {
  const Spectrum sigma_t = component.sigma_t();
  Spectrum albedo(0.0F);
  for (int channel = 0; channel < kChannels; ++channel) {
    if (sigma_t[channel] > 0) albedo[channel] = component.sigma_s[channel] / sigma_t[channel];
  }
  return albedo;
}

/// NaN if a channel is.
float largest_magnitude(const Spectrum& s) {
  const float largest = std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)});
  return std::isnan(s.x + s.y + s.z) ? std::numeric_limits<float>::quiet_NaN() : largest;
}

/// What a flight holds of each channel; one channel stands for all.
Spectrum channels_of(const std::array<std::vector<float>, kMaxChannels>& values, std::size_t slot,
                     int channels) {
  if (channels == 1) return Spectrum(values[0][slot]);
  return {values[0][slot], values[1][slot], values[2][slot]};
}

void set_ray(RayStream& rays, std::size_t slot, const Vec3f& origin, const Vec3f& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][slot] = origin[axis];
    rays.direction[axis][slot] = direction[axis];
  }
  rays.t_max[slot] = std::numeric_limits<float>::infinity();
}

void copy_ray(RayStream& rays, std::size_t from, std::size_t to) {
  for (int axis = 0; axis < 3; ++axis) {
    rays.origin[axis][to] = rays.origin[axis][from];
    rays.direction[axis][to] = rays.direction[axis][from];
  }
  rays.t_max[to] = rays.t_max[from];
  rays.pixel[to] = rays.pixel[from];
  rays.sample[to] = rays.sample[from];
  rays.stream[to] = rays.stream[from];
}

}  // namespace

PathWavefront::PathWavefront(const PathSetup& setup)
    : setup_(setup), emits_(setup.medium->emits()) {
  for (const Component& component : setup.medium->components()) {
    phases_.push_back(component.phase);
    albedos_.push_back(albedo_of(component));
  }
  paths_in_flight_.resize(setup.slots);
  rays_.resize(setup.slots);
  shadow_rays_.resize(setup.slots);
  shadows_.reserve(setup.slots);
}

bool PathWavefront::trace(const PathJob& job, Film& film, const std::function<bool()>& stop) {
  const StopScope scope(stop);
  results_.assign(job.pixels * job.samples, PathSample{});
  layers_.begin(film, results_.size());
  window_ = film.window();
  job_counts_ = {};
  const bool all_channels = setup_.walkers.size() == 1;
  for (std::size_t i = 0; i < setup_.walkers.size(); ++i) {
    walker_ = &setup_.walkers[i];
    const int channel = all_channels ? Walker::kAllChannels : static_cast<int>(i);
    if (!trace_channel(job, channel, stop) || scope.stopped()) return false;
  }
  for (std::size_t i = 0; i < results_.size(); ++i) {
    film.add(job.first_pixel + i / job.samples, results_[i], layers_[i]);
  }
  counts_.merge(job_counts_);
  return true;
}

bool PathWavefront::trace_channel(const PathJob& job, int channel,
                                  const std::function<bool()>& stop) {
  const std::size_t total = job.pixels * job.samples;
  std::size_t next = 0;
  std::size_t active = 0;
  job_counts_.paths += total;
  carries_one_channel_ = channel >= 0;
  while (true) {
    rays_.resize(setup_.slots);
    while (active < setup_.slots && next < total) start_path(job, next++, active++, channel);
    if (active == 0) return true;
    if (StopScope::has_stopped() || (stop && stop())) return false;
    rays_.resize(active);
    bring_weights(active);
    walker_->free_paths(rays_, flights_, job_counts_.free_paths);

    // Paths that go on close ranks; those that have ended owe nothing to the shadow rays.
    shadows_.clear();
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < active; ++slot) {
      const std::size_t shadows_before = shadows_.size();
      if (!advance(slot)) {
        finish(paths_in_flight_[slot], channel);
        continue;
      }
      if (shadows_.size() > shadows_before) shadows_.back().slot = kept;
      if (kept != slot) {
        paths_in_flight_[kept] = paths_in_flight_[slot];
        copy_ray(rays_, slot, kept);
      }
      ++kept;
    }
    active = kept;
    trace_shadows();
  }
}

void PathWavefront::start_path(const PathJob& job, std::size_t number, std::size_t slot,
                               int channel) {
  const std::size_t pixel = window_.in_picture(job.first_pixel + number / job.samples);
  const auto sample = job.first_sample + static_cast<uint32_t>(number % job.samples);
  // Each channel's path has random numbers of its own.
  const uint32_t sample_key =
      channel < 0 ? sample : sample * kChannels + static_cast<uint32_t>(channel);
  rays_.pixel[slot] = static_cast<uint32_t>(pixel);
  rays_.sample[slot] = sample_key;
  rays_.stream[slot] = stream_number(StreamPurpose::kWalk, 0);

  RandomStream random(setup_.seed, rays_.pixel[slot], sample_key,
                      stream_number(StreamPurpose::kCamera, 0));
  const auto width = static_cast<std::size_t>(setup_.camera->width());
  const float x = static_cast<float>(pixel % width) + random.uniform();
  const std::size_t row = pixel / width;
  const float y = static_cast<float>(row) + random.uniform();
  const CameraRay ray = setup_.camera->ray(x, y);
  set_ray(rays_, slot, Vec3f(ray.origin - setup_.origin), ray.direction);

  Path& path = paths_in_flight_[slot];
  path = {};
  path.throughput = Spectrum(1.0F);
  path.density = Spectrum(1.0F);
  if (channel >= 0) {
    path.throughput = Spectrum(0.0F);
    path.throughput[channel] = 1.0F;
  }
  path.radiance = Spectrum(0.0F);
  path.albedo = Spectrum(0.0F);
  path.result = static_cast<uint32_t>(number);
}

void PathWavefront::bring_weights(std::size_t active) {
  rays_.set_weighted(walker_->channels() > 1);
  if (!rays_.weighted()) return;
  for (std::size_t slot = 0; slot < active; ++slot) {
    const Path& path = paths_in_flight_[slot];
    for (int channel = 0; channel < kChannels; ++channel) {
      rays_.weight[channel][slot] = path.throughput[channel];
      rays_.density[channel][slot] = path.density[channel];
    }
  }
}

void PathWavefront::take_weights(Path& path, std::size_t slot) {
  const int channels = walker_->channels();
  const Spectrum weight = channels_of(flights_.weight, slot, channels);
  const Spectrum emitted = channels_of(flights_.emitted, slot, channels);
  if (rays_.weighted()) {
    path.throughput = weight;
    path.density = channels_of(flights_.density, slot, channels);
  }
  if (emits_) {
    path.radiance += rays_.weighted() ? emitted : path.throughput * emitted;
  }
  if (!rays_.weighted()) path.throughput *= weight;
}

bool PathWavefront::advance(std::size_t slot) {
  Path& path = paths_in_flight_[slot];
  path.lookups += flights_.lookups[slot];
  take_weights(path, slot);
  if (path.bounce == 0) {
    record_first_event(path, slot);
    if (layers_.on()) record_layers(path, slot);
  }
  if (!(largest_magnitude(path.throughput) < kLargestThroughput)) {
    path.radiance = Spectrum(std::numeric_limits<float>::quiet_NaN());  // finish() counts it
    return false;
  }
  switch (flights_.event[slot]) {
    case Event::kEscape:
      escape(path, {rays_.direction[0][slot], rays_.direction[1][slot], rays_.direction[2][slot]});
      return false;
    case Event::kAbsorb:
      return false;
    case Event::kScatter:
      break;
  }
  return scatter(path, slot);
}

void PathWavefront::escape(Path& path, const Vec3f& direction) {
  const LightValue light = setup_.lights->evaluate(direction);
  // What next-event estimation could have found too is shared with it.
  const float share = path.bounce == 0 ? 1.0F : path.phase_pdf / (path.phase_pdf + light.pdf);
  const Spectrum seen = path.throughput * light.radiance * share;
  if (layers_.on() && path.bounce == 0) layers_.background(path.result, seen);
  path.radiance += seen;
}

bool PathWavefront::scatter(Path& path, std::size_t slot) {
  if (layers_.on()) layers_.scattering(path.result, path.bounce, path.radiance);
  const uint32_t scattering = path.bounce++;
  if (path.bounce > setup_.max_scatterings) {
    // A path of one channel has no weight in the others.
    float sum = 0;
    for (int channel = 0; channel < kChannels; ++channel) sum += path.throughput[channel];
    job_counts_.cut(carries_one_channel_ ? sum : sum / kChannels);
    return false;
  }
  RandomStream random(setup_.seed, rays_.pixel[slot], rays_.sample[slot],
                      stream_number(StreamPurpose::kScatter, scattering));
  const float throughput = largest_magnitude(path.throughput);
  if (throughput < setup_.roulette_threshold) {
    const float survival = throughput / setup_.roulette_threshold;
    if (random.uniform() >= survival) return false;
    path.throughput *= 1.0F / survival;
  }
  const Vec3f direction(rays_.direction[0][slot], rays_.direction[1][slot],
                        rays_.direction[2][slot]);
  const Vec3f origin(rays_.origin[0][slot], rays_.origin[1][slot], rays_.origin[2][slot]);
  const Vec3f position = origin + direction * flights_.t[slot];
  const PhaseFunction& phase = phases_[flights_.component[slot]];
  sample_light(path, slot, position, direction, phase, random);

  const float u1 = random.uniform();
  const float u2 = random.uniform();
  const PhaseSample next = phase.sample(direction, u1, u2);
  path.phase_pdf = next.pdf;
  set_ray(rays_, slot, position, next.direction);
  rays_.stream[slot] = stream_number(StreamPurpose::kWalk, path.bounce);
  return true;
}

void PathWavefront::sample_light(const Path& path, std::size_t slot, const Vec3f& position,
                                 const Vec3f& direction, const PhaseFunction& phase,
                                 RandomStream& random) {
  if (setup_.lights->is_dark()) return;
  const float u0 = random.uniform();
  const float u1 = random.uniform();
  const float u2 = random.uniform();
  const LightSample light = setup_.lights->sample(u0, u1, u2);
  if (!(light.pdf > 0)) return;
  const float phase_value = phase.evaluate(direction, light.direction);
  // The phase function is its own density, so the balance heuristic's share is pdf/(pdf + value).
  const Spectrum radiance =
      path.throughput * light.radiance * (phase_value / (light.pdf + phase_value));
  if (largest_magnitude(radiance) == 0) return;
  const std::size_t shadow = shadows_.size();
  shadows_.push_back({slot, radiance});
  set_ray(shadow_rays_, shadow, position, light.direction);
  shadow_rays_.pixel[shadow] = rays_.pixel[slot];
  shadow_rays_.sample[shadow] = rays_.sample[slot];
  shadow_rays_.stream[shadow] = stream_number(StreamPurpose::kShadowWalk, path.bounce);
}

void PathWavefront::record_first_event(Path& path, std::size_t slot) const {
  const float weight = mean(channels_of(flights_.weight, slot, walker_->channels()));
  if (flights_.event[slot] == Event::kEscape) {
    path.alpha = 1 - weight;
    return;
  }
  path.alpha = 1;
  path.depth = flights_.t[slot];
  const Spectrum& albedo = albedos_[flights_.component[slot]];
  path.albedo = albedo;
  path.depth_weight = depth_weight(slot, albedo);
}

float PathWavefront::depth_weight(std::size_t slot, const Spectrum& albedo) const {
  const Spectrum weight = channels_of(flights_.weight, slot, walker_->channels());
  if (setup_.absorption != Absorption::kWeighted) return mean(weight);
  // The weight of each channel holds its albedo, which is no matter of depth.
  float sum = 0;
  int carried = 0;
  for (int c = 0; c < kChannels; ++c) {
    if (setup_.walkers.size() > 1 && walker_ != &setup_.walkers[c]) continue;
    sum += albedo[c] > 0 ? weight[c] / albedo[c] : 1.0F;
    ++carried;
  }
  return sum / static_cast<float>(carried);
}

void PathWavefront::record_layers(const Path& path, std::size_t slot) {
  if (flights_.event[slot] == Event::kEscape) {
    layers_.transmittance(path.result, path.throughput);
    return;
  }
  const Vec3f direction(rays_.direction[0][slot], rays_.direction[1][slot],
                        rays_.direction[2][slot]);
  const Vec3f origin(rays_.origin[0][slot], rays_.origin[1][slot], rays_.origin[2][slot]);
  const Vec3f position = origin + direction * path.depth + Vec3f(setup_.origin);
  // A sample of several channels is the mean of their paths.
  const float share = 1.0F / static_cast<float>(setup_.walkers.size());
  layers_.event(path.result, -direction, position, path.depth_weight * share);
}

void PathWavefront::finish(const Path& path, int channel) {
  PathSample& sample = results_[path.result];
  sample.lookups += static_cast<float>(path.lookups);
  if (!is_finite(path.radiance) || !std::isfinite(path.alpha) ||
      !std::isfinite(path.depth_weight)) {
    ++job_counts_.overflows;
    sample.overflowed = true;
    return;
  }
  sample.radiance += path.radiance;
  if (layers_.on()) layers_.end(path.result, path.bounce, path.radiance);
  if (channel < 0) {
    sample.alpha = path.alpha;
    sample.albedo = path.albedo;
    sample.depth = path.depth;
    sample.depth_weight = path.depth_weight;
    return;
  }
  // A sample of several channels is the mean of their paths.
  sample.alpha += path.alpha / kChannels;
  sample.albedo[channel] = path.albedo[channel];
  const float weight = path.depth_weight / kChannels;
  const float total = sample.depth_weight + weight;
  if (total != 0) {
    sample.depth = (sample.depth * sample.depth_weight + path.depth * weight) / total;
  }
  sample.depth_weight = total;
}

void PathWavefront::trace_shadows() {
  if (shadows_.empty()) return;
  shadow_rays_.resize(shadows_.size());
  walker_->transmittance(shadow_rays_, shadow_flights_, job_counts_.shadow_rays);
  for (std::size_t i = 0; i < shadows_.size(); ++i) {
    Path& path = paths_in_flight_[shadows_[i].slot];
    path.radiance += shadows_[i].radiance *
                     channels_of(shadow_flights_.weight, i, walker_->transmittance_channels());
    path.lookups += shadow_flights_.lookups[i];
  }
  shadow_rays_.resize(setup_.slots);
}

}  // namespace freepath
