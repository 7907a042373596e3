#include "freepath/paths/lobe_lines.h"

namespace freepath {
namespace {

/// Sets the streams of lines apart from those of paths, which never have so many flights, of
/// sample sequences (kSampleStreams) and of EmissionTracer.
constexpr uint32_t kLobeStreams = 0x90000000U;

uint32_t lobe_stream(StreamPurpose purpose, const ScenePath& path) {
  return kLobeStreams + stream_number(purpose, path.flights);
}

}  // namespace

RandomStream LobeLines::numbers(uint64_t seed, const ScenePath& path) {
  return {seed, path.pixel, path.sample_key, lobe_stream(StreamPurpose::kScatter, path)};
}

void LobeLines::add(const Line& line, const Vec3f& origin, float length, const ScenePath& path) {
  const Walker& walker = path.colors->walker(path.medium, path.channel);
  auto [batch, i] = batches_.add(walker, static_cast<uint32_t>(lines_.size()));
  lines_.push_back(line);
  RayStream& rays = batch.rays;
  set_ray(rays, i, origin, line.direction, length);
  rays.pixel[i] = path.pixel;
  rays.sample[i] = path.sample_key;
  rays.stream[i] = lobe_stream(StreamPurpose::kWalk, path);
  if (!rays.weighted()) return;
  for (int c = 0; c < walker.channels(); ++c) {
    rays.weight[c][i] = line.radiance[c];
    rays.density[c][i] = path.density[c];
  }
}

void LobeLines::trace(std::vector<ScenePath>& paths, WalkStatistics& statistics,
                      const std::function<void(const Line&)>& use) {
  if (lines_.empty()) return;
  for (WalkBatches::Batch* const batch : batches_.finish()) {
    batch->walker->free_paths(batch->rays, flights_, statistics);
    const RayStream& rays = batch->rays;
    for (std::size_t i = 0; i < batch->count; ++i) {
      Line& line = lines_[batch->owners[i]];
      paths[line.slot].lookups += flights_.lookups[i];
      if (flights_.event[i] != Event::kScatter) continue;
      if (rays.weighted()) {
        for (int c = 0; c < batch->walker->channels(); ++c) {
          line.radiance[c] = flights_.weight[c][i];
        }
      } else {
        line.radiance *= flights_.weight[0][i];
      }
      line.position = Vec3f(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]) +
                      line.direction * flights_.t[i];
      use(line);
    }
  }
  batches_.clear();
  lines_.clear();
}

}  // namespace freepath
