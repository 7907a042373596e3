#include "freepath/paths/near_light_lines.h"

namespace freepath {
namespace {

/// Sets the streams of lines apart from those of paths, which never have so many flights, of
/// sample sequences (kSampleStreams) and of EmissionTracer.
constexpr uint32_t kLineStreams = 0xC0000000U;

uint32_t stream_of(StreamPurpose purpose, const ScenePath& path) {
  return kLineStreams + stream_number(purpose, path.flights);
}

SampledSpectrum weights_at(const FlightStream& flights, std::size_t i, int channels) {
  SampledSpectrum weights(flights.weight[0][i]);
  for (int c = 1; c < channels; ++c) weights[c] = flights.weight[c][i];
  return weights;
}

}  // namespace

RandomStream NearLightLines::numbers(uint64_t seed, const ScenePath& path) {
  return {seed, path.pixel, path.sample_key, stream_of(StreamPurpose::kScatter, path)};
}

void NearLightLines::add(const Line& line, const Vec3f& origin, const ScenePath& path) {
  const Walker& walker = path.colors->walker(path.medium, path.channel);
  auto [batch, i] = batches_.add(walker, static_cast<uint32_t>(lines_.size()));
  lines_.push_back(line);
  set_ray(batch.rays, i, origin, line.direction, line.t);
  batch.rays.pixel[i] = path.pixel;
  batch.rays.sample[i] = path.sample_key;
  batch.rays.stream[i] = stream_of(StreamPurpose::kShadowWalk, path);
}

void NearLightLines::trace(std::span<ScenePath> paths, WalkStatistics& statistics,
                           const std::function<void(const Line&)>& use) {
  if (lines_.empty()) return;
  for (WalkBatches::Batch* const batch : batches_.finish()) {
    const Walker& walker = *batch->walker;
    walker.transmittance(batch->rays, flights_, statistics);
    for (std::size_t i = 0; i < batch->count; ++i) {
      Line& line = lines_[batch->owners[i]];
      line.transmittance = weights_at(flights_, i, walker.transmittance_channels());
      paths[line.slot].lookups += flights_.lookups[i];
      batch->rays.stream[i] = stream_of(StreamPurpose::kWalk, paths[line.slot]);
    }
    walker.scattering_at_ends(batch->rays, flights_, statistics);
    for (std::size_t i = 0; i < batch->count; ++i) {
      Line& line = lines_[batch->owners[i]];
      paths[line.slot].lookups += flights_.lookups[i];
      if (flights_.event[i] != Event::kScatter) continue;
      line.component = flights_.component[i];
      line.scattered = line.transmittance * weights_at(flights_, i, walker.channels());
    }
  }
  for (const Line& line : lines_) {
    if (!is_black(line.scattered)) use(line);
  }
  batches_.clear();
  lines_.clear();
}

}  // namespace freepath
