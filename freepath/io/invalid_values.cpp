#include "freepath/io/invalid_values.h"

#include <cmath>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"

namespace freepath {

std::string mend_invalid_pixels(Image& image, const std::string& name, InvalidPolicy policy) {
  const std::size_t channels = image.channels.size();
  std::vector<bool> is_colour(channels, channels == 1);
  for (const char* const channel : {"R", "G", "B", "Y", "A"}) {
    if (const auto found = find_channel(image, channel)) is_colour[*found] = true;
  }
  std::size_t count = 0, first = 0;
  float first_value = 0;
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    bool invalid = false;
    for (std::size_t channel = 0; channel < channels; ++channel) {
      float& value = image.values[pixel * channels + channel];
      if (std::isfinite(value) || !is_colour[channel]) continue;
      if (count == 0 && !invalid) {
        first = pixel;
        first_value = value;
      }
      invalid = true;
      value = 0;
    }
    count += invalid ? 1 : 0;
  }
  if (count == 0) return {};
  const std::string location =
      fmt::format("pixel ({}, {}) is {}", first % image.width, first / image.width,
                  std::isnan(first_value) ? "NaN" : "infinite");
  if (policy == InvalidPolicy::kError) {
    fail("{}: {}; repair the image, or have such values taken as 0 (--invalid zero)", name,
         location);
  }
  return fmt::format("{}: {}; the first: {}", name,
                     counted(count, "pixel with values that are NaN or infinite was taken as 0",
                             "pixels with values that are NaN or infinite were taken as 0"),
                     location);
}

}  // namespace freepath
