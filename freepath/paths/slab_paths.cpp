#include "freepath/paths/slab_paths.h"

#include <limits>
#include <utility>

namespace freepath {

void SlabSums::Moments::add(double weight) {
  sum += weight;
  squares += weight * weight;
  if (weight != 0) ++contributions;
}

void SlabSums::Moments::merge(const Moments& other) {
  sum += other.sum;
  squares += other.squares;
  contributions += other.contributions;
}

SlabEstimate SlabSums::Moments::estimate(uint64_t count, bool possible) const {
  const auto n = static_cast<double>(count);
  const double mean = sum / n;
  const double variance = std::max(0.0, squares - mean * sum) / std::max(1.0, n - 1);
  SlabEstimate estimate{mean, std::sqrt(variance / n), {}};
  // Of n paths none has brought anything: with 95 % confidence fewer than this share do.
  if (possible && contributions == 0) estimate.upper = 1 - std::pow(0.05, 1 / n);
  return estimate;
}

void SlabSums::merge(const SlabSums& other) {
  top.merge(other.top);
  bottom.merge(other.bottom);
  unscattered.merge(other.unscattered);
  total.merge(other.total);
  largest_weight = std::max(largest_weight, other.largest_weight);
  paths += other.paths;
}

SlabPaths::SlabPaths(const SlabMedium& slab, const Walker& walker, const SlabSettings& settings)
    : slab_(slab), walker_(walker), settings_(settings) {
  for (const Component& component : slab.medium.components()) {
    phases_.push_back(component.phase);
  }
  paths_.resize(std::max<std::size_t>(settings.batch, 1));
  waiting_.resize(paths_.size());
}

SlabSums SlabPaths::trace(uint64_t first, uint64_t count) {
  outcomes_.assign(count, Outcome{});
  first_path_ = first;
  uint64_t next = 0;
  std::size_t active = 0;
  while (true) {
    rays_.resize(paths_.size());
    while (active < paths_.size() && next < count) {
      start_path(next++, paths_[active]);
      set_ray(active++);
    }
    if (active == 0) break;
    rays_.resize(active);
    walker_.free_paths(rays_, flights_, statistics_);
    // Paths that go on close ranks, in the slots of those that have ended.
    std::size_t kept = 0;
    for (std::size_t slot = 0; slot < active; ++slot) {
      if (!advance(slot)) {
        if (waiting_[slot].empty()) continue;
        paths_[slot].branch = waiting_[slot].back();
        waiting_[slot].pop_back();
      }
      if (kept != slot) {
        paths_[kept] = paths_[slot];
        waiting_[kept].swap(waiting_[slot]);
      }
      set_ray(kept++);
    }
    active = kept;
  }
  return sum();
}

uint32_t SlabPaths::pixel_key(const Path& path) const {
  // Odd, so that no two branches of a path share a key.
  constexpr uint32_t kBranchStride = 0x9E3779B9U;
  return static_cast<uint32_t>((first_path_ + path.number) >> 32) ^
         (path.branch.number * kBranchStride);
}

RandomStream SlabPaths::random(const Path& path, StreamPurpose purpose) const {
  return {settings_.walk.seed, pixel_key(path), static_cast<uint32_t>(first_path_ + path.number),
          stream_number(purpose, path.branch.flights)};
}

void SlabPaths::start_path(uint64_t number, Path& path) const {
  path.number = number;
  path.branches = 1;
  path.branch = {};
  auto mu = static_cast<float>(settings_.mu0);
  if (settings_.diffuse) {
    // Equal radiance brings a flux in proportion to mu: density 2 mu. Never 0.
    mu = std::sqrt(random(path, StreamPurpose::kCamera).uniform());
  }
  path.branch.direction = {std::sqrt((1.0F - mu) * (1.0F + mu)), 0, mu};
}

void SlabPaths::set_ray(std::size_t slot) {
  const Path& path = paths_[slot];
  const Branch& branch = path.branch;
  rays_.pixel[slot] = pixel_key(path);
  rays_.sample[slot] = static_cast<uint32_t>(first_path_ + path.number);
  rays_.stream[slot] = stream_number(StreamPurpose::kWalk, branch.flights);
  rays_.origin[0][slot] = rays_.origin[1][slot] = 0;  // all places of one depth are the same
  rays_.origin[2][slot] = branch.z;
  for (int axis = 0; axis < 3; ++axis) rays_.direction[axis][slot] = branch.direction[axis];
  // To the next plane, if there is one that way.
  const float down = branch.direction.z;
  float t_max = std::numeric_limits<float>::infinity();
  if (down > 0 && branch.level < slab_.splits.size()) {
    t_max = std::max(0.0F, (slab_.splits[branch.level] - branch.z) / down);
  } else if (down < 0 && branch.level > 0) {
    t_max = std::max(0.0F, (slab_.splits[branch.level - 1] - branch.z) / down);
  }
  rays_.t_max[slot] = t_max;
}

void SlabPaths::leave(const Path& path, bool top) {
  Outcome& outcome = outcomes_[path.number];
  const double weight =
      std::ldexp(double{path.branch.weight}, -static_cast<int>(path.branch.level));
  if (top) {
    outcome.top += weight;
    return;
  }
  outcome.bottom += weight;
  if (!path.branch.scattered) outcome.unscattered += weight;
}

bool SlabPaths::cross_plane(std::size_t slot) {
  Path& path = paths_[slot];
  Branch& branch = path.branch;
  if (branch.direction.z > 0) {
    branch.z = slab_.splits[branch.level++];
    ++branch.flights;
    Branch other = branch;
    other.number = path.branches++;
    waiting_[slot].push_back(other);
    return true;
  }
  branch.z = slab_.splits[--branch.level];
  const bool survives = random(path, StreamPurpose::kScatter).uniform() < 0.5F;
  ++branch.flights;
  return survives;
}

bool SlabPaths::scatter(Path& path, float t, std::size_t component) {
  Branch& branch = path.branch;
  RandomStream random = this->random(path, StreamPurpose::kScatter);
  const float magnitude = std::abs(branch.weight);
  if (magnitude < settings_.roulette_threshold) {
    const float survival = magnitude / settings_.roulette_threshold;
    if (random.uniform() >= survival) return false;
    branch.weight *= 1.0F / survival;
  }
  const float u1 = random.uniform();
  const float u2 = random.uniform();
  // A rounding of z that just leaves the slab does no harm: upwards the next flight escapes, as
  // it would have but for a distance of 1e-6; downwards it begins at the surface.
  branch.z += branch.direction.z * t;
  branch.direction = phases_[component].sample(branch.direction, u1, u2).direction;
  // A ray that is level to the last bit would see no voxels at all, and hence leave.
  constexpr float kLeastSlope = 1e-12F;
  if (std::abs(branch.direction.z) < kLeastSlope) {
    branch.direction.z = std::copysign(kLeastSlope, branch.direction.z);
  }
  branch.scattered = true;
  ++branch.flights;
  return true;
}

bool SlabPaths::advance(std::size_t slot) {
  Path& path = paths_[slot];
  path.branch.weight *= flights_.weight[0][slot];
  switch (flights_.event[slot]) {
    case Event::kEscape: {
      if (std::isfinite(rays_.t_max[slot])) return cross_plane(slot);
      const bool top = path.branch.direction.z < 0;
      if (top || !slab_.half_space) leave(path, top);
      return false;
    }
    case Event::kAbsorb:
      return false;
    case Event::kScatter:
      break;
  }
  return scatter(path, flights_.t[slot], flights_.component[slot]);
}

SlabSums SlabPaths::sum() const {
  SlabSums sums;
  sums.paths = outcomes_.size();
  for (const Outcome& outcome : outcomes_) {
    const double total = outcome.top + outcome.bottom;
    sums.top.add(outcome.top);
    sums.bottom.add(outcome.bottom);
    sums.unscattered.add(outcome.unscattered);
    sums.total.add(total);
    sums.largest_weight =
        std::max({sums.largest_weight, std::abs(outcome.top), std::abs(outcome.bottom)});
  }
  return sums;
}

}  // namespace freepath
