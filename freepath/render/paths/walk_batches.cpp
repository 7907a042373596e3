#include "freepath/render/paths/walk_batches.h"

#include <algorithm>

namespace freepath {

void WalkBatches::clear() {
  for (std::size_t i = 0; i < used_; ++i) batches_[i].owners.clear();
  used_ = last_ = 0;
}

WalkBatches::Place WalkBatches::add(const Walker& walker, uint32_t owner) {
  if (last_ >= used_ || batches_[last_].walker != &walker) {
    last_ = 0;
    while (last_ < used_ && batches_[last_].walker != &walker) ++last_;
    if (last_ == used_) {
      if (used_ == batches_.size()) batches_.emplace_back();
      Batch& fresh = batches_[used_++];
      fresh.walker = &walker;
      fresh.rays.resize(std::max(capacity_, fresh.rays.size()));
      fresh.rays.set_weighted(weighted_ && walker.channels() > 1);
    }
  }
  Batch& batch = batches_[last_];
  batch.owners.push_back(owner);
  if (batch.owners.size() > batch.rays.size()) batch.rays.resize(2 * batch.rays.size());
  return {batch, batch.owners.size() - 1};
}

std::vector<WalkBatches::Batch*>& WalkBatches::finish() {
  finished_.clear();
  for (std::size_t i = 0; i < used_; ++i) {
    batches_[i].rays.resize(batches_[i].owners.size());
    finished_.push_back(&batches_[i]);
  }
  return finished_;
}

}  // namespace freepath
