#pragma once
/// @file Paths that have left the scene, whose light is looked up together.

#include <array>
#include <cstddef>
#include <cstdint>

#include "freepath/base/lat_long.h"
#include "freepath/base/vector.h"
#include "freepath/lights/environment.h"

namespace freepath {

/// Collects paths that escape to an image around the scene. Where they stand in it is found in
/// lanes, and all its pixels are asked for before the first is read: directions of escapes are
/// random, and the image is larger than the near caches.
class EscapeQueue {
 public:
  /// @param image to look up; null: there is none, and nothing may be added
  EscapeQueue(const ImageEnvironment* image, LocateDirections locate)
      : image_(image), locate_(locate) {}

  bool has_image() const { return image_ != nullptr; }
  void clear() { stream_.count = 0; }
  bool is_full() const { return stream_.count == LatLongStream::kCapacity; }

  /// @param slot of the path
  /// @param direction unit [world]
  void add(uint32_t slot, const Vec3f& direction) {
    const std::size_t i = stream_.count++;
    slots_[i] = slot;
    for (int axis = 0; axis < 3; ++axis) stream_.direction[axis][i] = direction[axis];
  }

  /// Looks all up, in the order in which they came, and is empty then.
  /// @param see is given the slot of each and the LightValue of the image
  template <class See>
  void look_up(const See& see) {
    if (stream_.count == 0) return;
    locate_(image_->grid(), stream_);
    for (std::size_t i = 0; i < stream_.count; ++i) image_->prefetch(stream_.place(i));
    for (std::size_t i = 0; i < stream_.count; ++i) {
      see(slots_[i], image_->value_at(stream_.place(i), stream_.pixel[i]));
    }
    stream_.count = 0;
  }

 private:
  const ImageEnvironment* image_;
  LocateDirections locate_;
  LatLongStream stream_;
  std::array<uint32_t, LatLongStream::kCapacity> slots_{};
};

}  // namespace freepath
