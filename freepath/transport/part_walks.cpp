#include "freepath/transport/part_walks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace freepath {
namespace {

/// The seed of a part; the first has that of the walk, others one mixed as SplitMix64 does.
uint64_t seed_of_part(uint64_t seed, uint32_t part) {
  if (part == 0) return seed;
  uint64_t mixed = seed + part * 0x9E3779B97F4A7C15U;
  mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9U;
  mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBU;
  return mixed ^ (mixed >> 31);
}

bool all_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Arrays>
Vec3d vector_at(const Arrays& arrays, std::size_t i) {
  return Vec3d(arrays[0][i], arrays[1][i], arrays[2][i]);
}

void begin_flights(const RayStream& rays, int channels, FlightStream& flights) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    flights.t[i] = 0;
    flights.event[i] = Event::kEscape;
    flights.component[i] = 0;
    flights.lookups[i] = 0;
    for (int c = 0; c < channels; ++c) {
      flights.weight[c][i] = rays.weighted() ? rays.weight[c][i] : 1.0F;
      flights.density[c][i] = rays.weighted() ? rays.density[c][i] : 1.0F;
      flights.emitted[c][i] = 0;
    }
  }
}

}  // namespace

/// A ray at a part.
struct PartWalks::Visit {
  uint32_t part = 0;
  uint32_t ray = 0;
  double t = 0;  ///< Where the ray is at the part [world].
};

/// The rays that meet one part next, and what becomes of them there.
class PartWalks::Streams {
 public:
  Streams(const RayStream& rays, PartWeights weights, int channels, FlightStream& flights)
      : all_(rays), weights_(weights), channels_(channels), all_flights_(flights) {}

  /// @param middle what positions are to be relative to, relative to the origin of the rays
  void take(std::span<const Visit> visits, const Vec3d& middle) {
    rays_.resize(visits.size());
    rays_.set_weighted(weights_ == PartWeights::kHandedOn);
    flights_.resize(visits.size());
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const Visit& visit = visits[i];
      const uint32_t ray = visit.ray;
      const Vec3d direction = vector_at(all_.direction, ray);
      const Vec3d origin = vector_at(all_.origin, ray) + direction * visit.t - middle;
      for (int axis = 0; axis < 3; ++axis) {
        rays_.origin[axis][i] = static_cast<float>(origin[axis]);
        rays_.direction[axis][i] = all_.direction[axis][ray];
      }
      rays_.t_max[i] = static_cast<float>(all_.t_max[ray] - visit.t);
      rays_.pixel[i] = all_.pixel[ray];
      rays_.sample[i] = all_.sample[ray];
      rays_.stream[i] = all_.stream[ray];
      for (int c = 0; rays_.weighted() && c < channels_; ++c) {
        rays_.weight[c][i] = all_flights_.weight[c][ray];
        rays_.density[c][i] = all_flights_.density[c][ray];
        flights_.density[c][i] = all_flights_.density[c][ray];
      }
    }
  }

  void give_back(std::span<const Visit> visits) const {
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const uint32_t ray = visits[i].ray;
      all_flights_.t[ray] = static_cast<float>(visits[i].t + flights_.t[i]);
      all_flights_.event[ray] = flights_.event[i];
      all_flights_.component[ray] = flights_.component[i];
      all_flights_.lookups[ray] += flights_.lookups[i];
      for (int c = 0; c < channels_; ++c) {
        if (weights_ == PartWeights::kMultiplied) {
          all_flights_.weight[c][ray] *= flights_.weight[c][i];
          continue;
        }
        all_flights_.weight[c][ray] = flights_.weight[c][i];
        all_flights_.density[c][ray] = flights_.density[c][i];
        all_flights_.emitted[c][ray] += flights_.emitted[c][i];
      }
    }
  }

  const RayStream& rays() const { return rays_; }
  FlightStream& flights() { return flights_; }

 private:
  const RayStream& all_;
  PartWeights weights_;
  int channels_;
  FlightStream& all_flights_;
  RayStream rays_;
  FlightStream flights_;
};

PartWalks::PartWalks(const Medium& medium, const MediumChannels& channels, const Vec3d& origin)
    : medium_(medium), origin_(origin) {
  ray_to_grid_ = Matrix4d().setTranslation(origin) * medium.world_to_grid();
  for (const WalkPart& part : medium.parts()) {
    middles_.push_back(medium.middle_of(part) - origin);
    radiance_.push_back(radiance_views_of(medium, part, channels));
  }
}

/// The parts that each ray meets, one after the other; the first where it meets none, so that it
/// ends as all do that miss.
/// @param ends where the visits of each ray end
std::vector<PartWalks::Visit> PartWalks::first_visits(const RayStream& rays,
                                                      std::vector<std::size_t>& ends) const {
  std::vector<Visit> visits;
  ends.clear();
  for (uint32_t ray = 0; ray < rays.size(); ++ray) {
    const std::size_t before = visits.size();
    const Vec3d origin = vector_at(rays.origin, ray) * ray_to_grid_;
    Vec3d direction;
    ray_to_grid_.multDirMatrix(vector_at(rays.direction, ray), direction);
    if (all_finite(origin) && all_finite(direction)) {
      medium_.part_tree().for_each_on_ray(origin, direction, double{rays.t_max[ray]},
                                          [&](std::size_t part, double t) {
                                            visits.push_back({static_cast<uint32_t>(part), ray, t});
                                          });
    }
    if (visits.size() == before) visits.push_back({0, ray, 0});
    ends.push_back(visits.size());
  }
  return visits;
}

void PartWalks::walk(WalkFunction function, PartWeights weights, const MediumView& view,
                     std::span<const float> options, const WalkModes& modes, uint64_t seed,
                     int channels, const RayStream& rays, FlightStream& flights,
                     WalkStatistics& statistics) const {
  const uint64_t rays_before = statistics.rays;
  begin_flights(rays, channels, flights);
  std::vector<std::size_t> ends;
  const std::vector<Visit> visits = first_visits(rays, ends);
  Streams streams(rays, weights, channels, flights);
  MediumView part_view = view;
  std::vector<Visit> next;
  for (std::size_t round = 0;; ++round) {
    next.clear();
    for (uint32_t ray = 0; ray < rays.size(); ++ray) {
      const std::size_t visit = (ray == 0 ? 0 : ends[ray - 1]) + round;
      if (visit < ends[ray] && flights.event[ray] == Event::kEscape) next.push_back(visits[visit]);
    }
    if (next.empty()) break;
    std::sort(next.begin(), next.end(), [](const Visit& a, const Visit& b) {
      return a.part != b.part ? a.part < b.part : a.ray < b.ray;
    });
    for (auto begin = next.begin(); begin != next.end();) {
      const uint32_t part = begin->part;
      const auto end =
          std::find_if(begin, next.end(), [&](const Visit& visit) { return visit.part != part; });
      streams.take({begin, end}, middles_[part]);
      show_part(medium_, medium_.parts()[part], origin_ + middles_[part], radiance_[part],
                part_view);
      function(part_view, options, modes, seed_of_part(seed, part), streams.rays(),
               streams.flights(), statistics);
      streams.give_back({begin, end});
      begin = end;
    }
  }
  statistics.rays = rays_before + rays.size();
}

}  // namespace freepath
