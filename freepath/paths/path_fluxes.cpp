// What a FluxMeter counts of the paths of a PathWavefront, which start as light does.

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "freepath/paths/path_wavefront.h"

namespace freepath {
namespace {

constexpr ShadowEnd kOutside{std::numeric_limits<float>::infinity(), {}};

}  // namespace

bool PathWavefront::trace(const PathJobSource& jobs) {
  Film none(1, 1);
  return trace(jobs, none);
}

void PathWavefront::start_light(std::size_t path_number, ScenePath& path) {
  std::construct_at(&path);
  path.job = newest_;
  const OpenJobs::Job& open = jobs_[newest_];
  path.result = static_cast<uint32_t>(open.first + path_number);
  path.pixel = static_cast<uint32_t>(open.job.first_pixel);
  path.sample_key = open.job.first_sample + static_cast<uint32_t>(path_number);
  path.colors = setup_.colors.front().get();
  path.throughput[0] = 1;
  RandomStream random(setup_.seed, path.pixel, path.sample_key,
                      stream_number(StreamPurpose::kCamera, 0));
  const FluxMeter::Start start = meter_->start(random);
  path.origin = path.turned_at = start.origin;
  path.direction = start.direction;
  set_media(path, camera_media_);
  record_of(path).clear();
}

void PathWavefront::deposit(const ScenePath& path, uint32_t cell, float weight) {
  record_of(path).add(cell, path.level == 0 ? weight : weight * FluxMeter::share_at(path.level));
}

void PathWavefront::leave_meter(ScenePath& path) {
  path.is_dead = true;
  const uint32_t column = meter_->column_left(path.origin, path.direction, scene_.domain);
  const float weight = path.throughput[0];
  if (meter_->down(path.direction) < 0) {
    deposit(path, meter_->cell(Flux::kReflected, column), weight);
    return;
  }
  if (meter_->has_no_bottom) return;
  deposit(path, meter_->cell(Flux::kTransmitted, column), weight);
  if (path.scatterings == 0) deposit(path, meter_->cell(Flux::kUnscattered, column), weight);
}

void PathWavefront::arrive_at_ground(const ScenePath& path, const Vec3f& position) {
  const uint32_t column = meter_->column(position);
  deposit(path, meter_->cell(Flux::kTransmitted, column), path.throughput[0]);
  if (path.scatterings > 0) return;
  deposit(path, meter_->cell(Flux::kUnscattered, column), path.throughput[0]);
}

void PathWavefront::absorb_part(const ScenePath& path, const Vec3f& position,
                                std::size_t component) {
  const float share = meter_->absorbed_of_scattered[component];
  if (share == 0) return;
  // What scatters is to what stays as their coefficients are.
  deposit(path, meter_->cell(Flux::kAbsorbed, meter_->column(position)),
          path.throughput[0] * share);
}

void PathWavefront::show_collision(std::size_t scattering) {
  const Scattering& scattered = scattered_[scattering];
  const ScenePath& path = paths_[scattered.slot];
  const auto vector_of = [&](const std::array<ScatteringStream::Row<float>, 3>& rows) {
    return Vec3f(rows[0][scattering], rows[1][scattering], rows[2][scattering]);
  };
  const Vec3f position = vector_of(scatterings_.position);
  const Vec3f direction = vector_of(scatterings_.direction);
  for (std::size_t i = 0; i < meter_->views.size(); ++i) {
    const Vec3f& view = meter_->views[i];
    const float weight = scattered.phase->evaluate(direction, view) * meter_->weight_of_view(i);
    if (weight == 0) continue;
    const uint32_t column = meter_->column_left(position, view, scene_.domain);
    shadows_.add(scattered.slot, path, position, view, kOutside, path.media,
                 path.throughput * weight, false, meter_->cell_of_view(i, column));
  }
}

void PathWavefront::show_surface(std::size_t slot, const SurfaceHit& hit, const Material& material,
                                 RandomStream& random, const SurfaceContext& context) {
  const ScenePath& path = paths_[slot];
  for (std::size_t i = 0; i < meter_->views.size(); ++i) {
    const Vec3f& view = meter_->views[i];
    if (meter_->down(view) > 0) continue;  // below there is nothing but ground
    const MaterialValue f = material.evaluate(hit.point, path.direction, view, random, context);
    const float weight = f.value[0] * meter_->weight_of_view(i);
    if (weight == 0) continue;
    const Departure departure = depart(path, hit, view);
    const uint32_t column = meter_->column_left(departure.origin, view, scene_.domain);
    shadows_.add(static_cast<uint32_t>(slot), path, departure.origin, view, kOutside,
                 departure.media, path.throughput * weight, false, meter_->cell_of_view(i, column));
  }
}

void PathWavefront::pass_plane(std::size_t slot) {
  ScenePath& path = paths_[slot];
  Vec3f origin = path.origin + path.direction * path.side;
  if (meter_->down(path.direction) > 0) {
    meter_->set_depth(origin, meter_->splits[path.level++]);
    go_on(path, origin, path.direction);
    // Odd, so that no two branches of a path share random numbers.
    constexpr uint32_t kBranchStride = 0x9E3779B9U;
    FluxRecord& record = record_of(path);
    const auto first = static_cast<uint32_t>(jobs_[path.job].job.first_pixel);
    record.waiting.push_back({.origin = path.origin,
                              .direction = path.direction,
                              .weight = path.throughput[0],
                              .density = path.density[0],
                              .pixel = first ^ (record.branches++ * kBranchStride),
                              .level = path.level,
                              .flights = path.flights,
                              .scatterings = path.scatterings});
    return;
  }
  meter_->set_depth(origin, meter_->splits[--path.level]);
  RandomStream random(setup_.seed, path.pixel, path.sample_key,
                      stream_number(StreamPurpose::kScatter, path.flights));
  go_on(path, origin, path.direction);
  if (random.uniform() >= 0.5F) path.is_dead = true;
}

bool PathWavefront::take_branch(ScenePath& path) {
  if (meter_ == nullptr) return false;
  std::vector<FluxRecord::Branch>& waiting = record_of(path).waiting;
  if (waiting.empty()) return false;
  const FluxRecord::Branch& branch = waiting.back();
  path.origin = branch.origin;
  path.direction = branch.direction;
  path.throughput[0] = branch.weight;
  path.density[0] = branch.density;
  path.pixel = branch.pixel;
  path.level = branch.level;
  path.flights = branch.flights;
  path.scatterings = branch.scatterings;
  path.surfaces_known = path.ends_at_surface = path.is_dead = false;
  waiting.pop_back();
  return true;
}

void PathWavefront::add_to_tally(const OpenJobs::Job& done) {
  const PathJob& job = done.job;
  const uint64_t first = uint64_t{job.first_pixel} << 32 | job.first_sample;
  setup_.tally->add(first / kPathsPerChunk,
                    std::span(jobs_.fluxes).subspan(done.first, done.paths));
}

}  // namespace freepath
