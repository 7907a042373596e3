#include "freepath/paths/flux_tally.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace freepath {

FluxTally::FluxTally(const FluxMeter& meter) : meter_(meter), all_(meter.kinds()) {
  if (meter.columns() > 1) columns_.resize(meter.cells());
}

void FluxTally::add(uint64_t chunk, std::span<const FluxRecord> records) {
  Chunk packed;
  packed.ends.reserve(records.size());
  packed.deposits.reserve(2 * records.size());
  for (const FluxRecord& record : records) {
    record.for_each(
        [&](const FluxRecord::Deposit& deposit) { packed.deposits.push_back(deposit); });
    packed.ends.push_back(static_cast<uint32_t>(packed.deposits.size()));
  }
  const std::lock_guard lock(mutex_);
  waiting_.emplace(chunk, std::move(packed));
  while (!waiting_.empty() && waiting_.begin()->first == next_) {
    merge(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    ++next_;
  }
}

void FluxTally::merge(const Chunk& chunk) {
  std::vector<double> sums(all_.size());
  const uint32_t columns = meter_.columns();
  uint32_t begin = 0;
  for (const uint32_t end : chunk.ends) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (; begin < end; ++begin) {
      const auto [cell, weight] = chunk.deposits[begin];
      if (columns_.empty()) {
        sums[cell] = weight;
      } else {
        sums[cell / columns] += weight;
        columns_[cell].add(weight);
      }
    }
    for (std::size_t kind = 0; kind < sums.size(); ++kind) {
      if (sums[kind] != 0) all_[kind].add(sums[kind]);
    }
    const double top = sums[static_cast<std::size_t>(Flux::kReflected)];
    const double bottom = sums[static_cast<std::size_t>(Flux::kTransmitted)];
    leaving_.add(top + bottom);
    largest_weight_ = std::max({largest_weight_, std::abs(top), std::abs(bottom)});
  }
  paths_ += chunk.ends.size();
}

uint64_t FluxTally::paths() const {
  const std::lock_guard lock(mutex_);
  return paths_;
}

Estimate FluxTally::all(uint32_t kind, bool possible) const {
  return all_[kind].estimate(paths_, possible);
}

Estimate FluxTally::column(uint32_t cell, bool possible) const {
  const double columns = meter_.columns();
  if (columns_.empty()) return all(cell, possible);
  Estimate estimate = columns_[cell].estimate(paths_, possible);
  estimate.mean *= columns;
  estimate.error *= columns;
  if (estimate.upper) *estimate.upper *= columns;
  return estimate;
}

}  // namespace freepath
