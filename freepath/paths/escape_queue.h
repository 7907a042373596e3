#pragma once
/// @file Paths that have left the scene, whose light is looked up together.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "freepath/base/lat_long.h"
#include "freepath/base/vector.h"
#include "freepath/lights/environment.h"

namespace freepath {

/// Collects paths that escape to an image around the scene. Where they stand in it is found in
/// lanes, and its pixels are asked for long before they are read: directions of escapes are random,
/// and the image is larger than the near caches. Its memory is used again.
class EscapeQueue {
 public:
  /// @param image to look up; null: there is none, and nothing may be added
  EscapeQueue(const ImageEnvironment* image, LocateDirections locate)
      : image_(image), locate_(locate) {}

  bool has_image() const { return image_ != nullptr; }
  void clear() { used_ = 0; }

  /// @param slot of the path
  /// @param direction unit [world]
  void add(uint32_t slot, const Vec3f& direction) {
    if (used_ == 0 || batches_[used_ - 1].places.count == LatLongStream::kCapacity) begin_batch();
    Batch& batch = batches_[used_ - 1];
    const std::size_t i = batch.places.count++;
    batch.slots[i] = slot;
    for (int axis = 0; axis < 3; ++axis) batch.places.direction[axis][i] = direction[axis];
    if (batch.places.count == LatLongStream::kCapacity) locate(batch.places);
  }

  /// Asks for the pixels of all that were added; to be called some time before look_up().
  void finish() {
    if (used_ == 0) return;
    LatLongStream& last = batches_[used_ - 1].places;
    if (last.count < LatLongStream::kCapacity) locate(last);
  }

  /// Looks all up, in the order in which they came, and is empty then.
  /// @param see is given the slot of each and the LightValue of the image
  template <class See>
  void look_up(const See& see) {
    for (std::size_t b = 0; b < used_; ++b) {
      const Batch& batch = batches_[b];
      for (std::size_t i = 0; i < batch.places.count; ++i) {
        see(batch.slots[i], image_->value_at(batch.places.place(i), batch.places.pixel[i]));
      }
    }
    clear();
  }

 private:
  struct Batch {
    LatLongStream places;
    std::array<uint32_t, LatLongStream::kCapacity> slots{};
  };

  void begin_batch() {
    if (used_ == batches_.size()) batches_.emplace_back();
    batches_[used_++].places.count = 0;
  }
  void locate(LatLongStream& places) const {
    locate_(image_->grid(), places);
    for (std::size_t i = 0; i < places.count; ++i) image_->prefetch(places.place(i));
  }

  const ImageEnvironment* image_;
  LocateDirections locate_;
  std::vector<Batch> batches_;  // those beyond used_ to be used again
  std::size_t used_ = 0;
};

}  // namespace freepath
