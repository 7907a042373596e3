#include "freepath/paths/emission_tracer.h"

#include "freepath/base/random.h"

namespace freepath {
namespace {

/// Sets these flights' streams apart from those of paths, which never have so many flights, and
/// from those of sample sequences (kSampleStreams).
constexpr uint32_t kStreams = 0xA0000000U;

}  // namespace

void EmissionTracer::add(uint32_t owner, const ScenePath& path, const Vec3f& position,
                         const Vec3f& direction, const SampledSpectrum& weight) {
  const float length = scene_.way_to_surface(path.medium, position, direction);
  const Walker& walker = path.colors->walker(path.medium, path.channel);
  auto [batch, i] = batches_.add(walker, static_cast<uint32_t>(lines_.size()));
  lines_.push_back({owner, weight});
  RayStream& rays = batch.rays;
  set_ray(rays, i, position, direction, length);
  rays.pixel[i] = path.pixel;
  rays.sample[i] = path.sample_key;
  rays.stream[i] = stream_number(StreamPurpose::kWalk, path.flights) + kStreams;
  if (!rays.weighted()) return;
  for (int c = 0; c < walker.channels(); ++c) {
    rays.weight[c][i] = weight[c];
    rays.density[c][i] = path.density[c];
  }
}

void EmissionTracer::trace(std::span<ScenePath> paths, WalkStatistics& statistics) {
  if (lines_.empty()) return;
  for (WalkBatches::Batch* const batch : batches_.finish()) {
    batch->walker->free_paths(batch->rays, flights_, statistics);
    const bool weighted = batch->rays.weighted();
    for (std::size_t i = 0; i < batch->count; ++i) {
      const Line& line = lines_[batch->owners[i]];
      ScenePath& path = paths[line.owner];
      path.lookups += flights_.lookups[i];
      if (weighted) {
        for (int c = 0; c < batch->walker->channels(); ++c) {
          path.radiance[c] += flights_.emitted[c][i];
        }
      } else {
        path.radiance += line.weight * flights_.emitted[0][i];
      }
    }
  }
  batches_.clear();
  lines_.clear();
}

}  // namespace freepath
