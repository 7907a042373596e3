#include "freepath/paths/walk_batches.h"

#include <algorithm>

namespace freepath {
namespace {

/// Rays to make room for at first: where there are many walkers, each has few of them.
constexpr std::size_t kFirstRoom = 1024;

}  // namespace

void WalkBatches::clear() {
  for (std::size_t i = 0; i < used_; ++i) batches_[i].count = 0;
  used_ = 0;
}

uint32_t WalkBatches::find(const Walker& walker) {
  uint32_t number = 0;
  while (number < used_ && batches_[number].walker != &walker) ++number;
  if (number < used_) return number;
  if (used_ == batches_.size()) batches_.emplace_back();
  Batch& fresh = batches_[used_++];
  fresh.walker = &walker;
  resize(fresh, std::max(std::min(capacity_, kFirstRoom), fresh.owners.size()));
  fresh.rays.set_weighted(weighted_ && walker.channels() > 1);
  return number;
}

void WalkBatches::resize(Batch& batch, std::size_t rays) {
  batch.rays.resize(rays);
  batch.owners.resize(rays);
}

std::vector<WalkBatches::Batch*>& WalkBatches::finish() {
  finished_.clear();
  for (std::size_t i = 0; i < used_; ++i) {
    batches_[i].rays.resize(batches_[i].count);
    finished_.push_back(&batches_[i]);
  }
  return finished_;
}

}  // namespace freepath
