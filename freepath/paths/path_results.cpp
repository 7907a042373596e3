// What the paths of a PathWavefront have found, for the film.

#include <cmath>
#include <span>
#include <vector>

#include "freepath/paths/path_wavefront.h"

namespace freepath {
namespace {

Rgb to_spectrum(const Vec3f& rgb) { return {rgb.x, rgb.y, rgb.z}; }

}  // namespace

MediumWalkers::Origin PathWavefront::scatterer_of(const ScenePath& path,
                                                  std::size_t component) const {
  // Those beyond the media of the scene are combinations.
  if (static_cast<std::size_t>(path.medium) < scene_.media.size()) {
    return {path.medium, static_cast<uint32_t>(component)};
  }
  return path.colors->walkers(path.medium).origins[component];
}

void PathWavefront::record_medium_event(ScenePath& path, float t,
                                        const MediumWalkers::Origin& scatterer) {
  const SceneMedium& medium = scene_.media[scatterer.medium];
  // Weighted absorption has put the albedo into each channel's weight: no matter of depth. Of a
  // channel without one nothing is left; it counts as if it had come here by chance alone.
  SampledSpectrum weight = path.throughput;
  if (setup_.absorption == Absorption::kWeighted) {
    const SampledSpectrum albedo = medium.albedo(scatterer.component, path.colors->spectra);
    for (int c = 0; c < path.colors->spectra.channels(); ++c) {
      weight[c] = albedo[c] > 0 ? weight[c] / albedo[c] : 1.0F;
    }
  }
  record_event(path, t, weight, medium.albedo(scatterer.component, setup_.factory->rgb()),
               -path.direction);
}

void PathWavefront::record_event(ScenePath& path, float t, const SampledSpectrum& weight,
                                 const SampledSpectrum& albedo, const Vec3f& normal) {
  PathSample& sample = result_of(path);
  sample.alpha = 1;
  sample.albedo = {albedo[0], albedo[1], albedo[2]};
  sample.depth = path.distance + t;
  sample.depth_weight = path.mean(weight);
  if (!jobs_.layers.on()) return;
  const Vec3f position = path.origin + path.direction * t + Vec3f(scene_.origin);
  jobs_.layers.event(path.result, normal, position,
                     sample.depth_weight / static_cast<float>(setup_.factory->paths_per_sample()));
}

Rgb PathWavefront::rgb_of(const ScenePath& path, const SampledSpectrum& radiance,
                          const SampledSpectrum& rgb) const {
  const SpectrumValues& spectra = path.colors->spectra;
  if (is_balanced_ && !spectra.is_spectral()) {
    const SampledSpectrum sum = radiance + rgb;
    return Rgb(sum[0], sum[1], sum[2]) * scene_.exposure_scale;
  }
  const Vec3f sum = spectra.to_rgb(radiance) + Vec3f(rgb[0], rgb[1], rgb[2]);
  return to_spectrum(sum * scene_.white_balance * scene_.exposure_scale);
}

Rgb PathWavefront::transmittance_of(const ScenePath& path) const {
  const SpectrumValues& spectra = path.colors->spectra;
  const SampledSpectrum& t = path.throughput;
  if (!spectra.is_spectral()) return {t[0], t[1], t[2]};
  return to_spectrum(spectra.to_rgb(t * spectra.illuminant(Vec3f(1))));
}

void PathWavefront::finish(ScenePath& path) {
  if (meter_ != nullptr) {
    if (!is_finite(path.radiance)) ++jobs_[path.job].counts.overflows;
    return;
  }
  PathSample& sample = result_of(path);
  if (!is_finite(path.radiance) || !is_finite(path.rgb) || !std::isfinite(sample.alpha) ||
      !std::isfinite(sample.depth_weight)) {
    ++jobs_[path.job].counts.overflows;
    sample = {};
    sample.overflowed = true;
    sample.lookups = static_cast<float>(path.lookups);
    return;
  }
  sample.lookups = static_cast<float>(path.lookups);
  sample.radiance = rgb_of(path, path.radiance, path.rgb);
  if (records_spectra_) jobs_.spectra[path.result] = path.radiance;
  if (jobs_.layers.on()) jobs_.layers.end(path.result, path.scatterings, sample.radiance);
}

void PathWavefront::add_spectrum(const OpenJobs::Job& done, std::size_t sample, Film& film) const {
  const PathJob& job = done.job;
  const auto per_sample = static_cast<std::size_t>(setup_.factory->paths_per_sample());
  SampledSpectrum radiance;
  for (std::size_t c = 0; c < per_sample; ++c) {
    radiance += jobs_.spectra[done.result_of(sample, per_sample) + c];
  }
  const PixelSample at = pixel_sample_of(job, sample);
  const SpectrumValues& values = colors_of(at).spectra;
  // In the light's units, which the colour matching of our observer takes out.
  constexpr auto kLightUnit = static_cast<float>(1 / kLuminousIntegral);
  film.add_spectrum(job.pixel_of(sample), std::span(values.wavelengths()).first(values.channels()),
                    radiance * (scene_.exposure_scale * kLightUnit));
}

void PathWavefront::add_to_film(const OpenJobs::Job& done, Film& film) const {
  const PathJob& job = done.job;
  const auto per_sample = static_cast<std::size_t>(setup_.factory->paths_per_sample());
  std::vector<PathSample> samples(job.samples);
  std::vector<LayerSample> layers(jobs_.layers.on() ? job.samples : 0);
  for (std::size_t i = 0; i < job.sample_count(); i += job.samples) {
    const std::size_t pixel = job.pixel_of(i);
    for (std::size_t k = 0; k < job.samples; ++k) {
      const std::size_t first = done.result_of(i + k, per_sample);
      samples[k] = sum_of_paths(first, per_sample);
      if (!layers.empty()) layers[k] = sum_of_layers(first, per_sample);
      if (records_spectra_) add_spectrum(done, i + k, film);
    }
    film.add(pixel, samples, layers);
    film.end_rounds(pixel, job.rounds);
  }
}

PathSample PathWavefront::sum_of_paths(std::size_t first, std::size_t count) const {
  if (count == 1) return jobs_.results[first];
  PathSample sum;
  const float share = 1.0F / static_cast<float>(count);
  // The paths of the channels, always in the same order.
  for (std::size_t c = 0; c < count; ++c) {
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
  }
  return sum;
}

LayerSample PathWavefront::sum_of_layers(std::size_t first, std::size_t count) const {
  LayerSample sum = jobs_.layers[first];
  for (std::size_t c = 1; c < count; ++c) sum += jobs_.layers[first + c];
  return sum;
}

}  // namespace freepath
