#pragma once
/// @file Images of the whole sphere.

#include <functional>

#include "freepath/base/random.h"
#include "freepath/io/image.h"

namespace freepath::testing {

inline Image grey_image(int width, int height, const std::function<float(int, int)>& value) {
  Image image{.width = width, .height = height, .channels = {"Y"}};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) image.values.push_back(value(column, row));
  }
  return image;
}

/// A rough image with black parts and one bright pixel.
inline Image rough_image() {
  RandomStream random(2, 7, 1, 8);
  Image image = grey_image(16, 9, [&](int column, int row) {
    const float value = random.uniform();
    return column < 5 && row > 2 ? 0.0F : value * value;
  });
  image.values[3 * 16 + 11] = 40;
  return image;
}

}  // namespace freepath::testing
