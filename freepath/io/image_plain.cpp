#include "freepath/io/image_plain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/vector.h"
#include "freepath/io/atomic_image.h"

namespace freepath {
namespace {

using QoiPixel = std::array<uint8_t, 3>;

/// Of 64 places, that of a pixel whose alpha is 255.
std::size_t qoi_slot(const QoiPixel& pixel) {
  return (pixel[0] * 3U + pixel[1] * 5U + pixel[2] * 7U + 255U * 11U) % 64U;
}

/// Writes pixels one after the other, each by what it shares with those before.
class QoiWriter {
 public:
  QoiWriter(int width, int height) {
    bytes_.insert(bytes_.end(), {'q', 'o', 'i', 'f'});
    for (const int edge : {width, height}) {
      for (int shift = 24; shift >= 0; shift -= 8) {
        bytes_.push_back(static_cast<uint8_t>(static_cast<uint32_t>(edge) >> shift));
      }
    }
    bytes_.insert(bytes_.end(), {3, 0});  // channels; 0: sRGB
  }

  void add(const QoiPixel& pixel) {
    constexpr int kLongestRun = 62;
    if (pixel == last_) {
      if (++run_ == kLongestRun) end_run();
      return;
    }
    end_run();
    QoiPixel& seen = seen_[qoi_slot(pixel)];
    if (was_seen_[qoi_slot(pixel)] && seen == pixel) {
      bytes_.push_back(static_cast<uint8_t>(qoi_slot(pixel)));
    } else {
      seen = pixel;
      was_seen_[qoi_slot(pixel)] = true;
      add_difference(pixel);
    }
    last_ = pixel;
  }

  std::vector<uint8_t> finish() {
    end_run();
    bytes_.insert(bytes_.end(), {0, 0, 0, 0, 0, 0, 0, 1});
    return std::move(bytes_);
  }

 private:
  void end_run() {
    if (run_ > 0) bytes_.push_back(static_cast<uint8_t>(0xC0 | (run_ - 1)));
    run_ = 0;
  }

  void add_difference(const QoiPixel& pixel) {
    std::array<int, 3> change{};  // modulo 256, from -128 to 127
    for (int c = 0; c < 3; ++c) {
      const int rise = (int{pixel[c]} - int{last_[c]}) & 0xFF;
      change[c] = rise < 128 ? rise : rise - 256;
    }
    const auto [r, g, b] = change;
    const auto fits = [](int value, int smallest, int largest) {
      return value >= smallest && value <= largest;
    };
    if (fits(r, -2, 1) && fits(g, -2, 1) && fits(b, -2, 1)) {
      bytes_.push_back(static_cast<uint8_t>(0x40 | (r + 2) << 4 | (g + 2) << 2 | (b + 2)));
    } else if (fits(g, -32, 31) && fits(r - g, -8, 7) && fits(b - g, -8, 7)) {
      bytes_.push_back(static_cast<uint8_t>(0x80 | (g + 32)));
      bytes_.push_back(static_cast<uint8_t>((r - g + 8) << 4 | (b - g + 8)));
    } else {
      bytes_.push_back(0xFE);
      bytes_.insert(bytes_.end(), pixel.begin(), pixel.end());
    }
  }

  std::vector<uint8_t> bytes_;
  QoiPixel last_{};
  int run_ = 0;
  /// The places begin with an alpha of 0, which no pixel here has.
  std::array<QoiPixel, 64> seen_{};
  std::array<bool, 64> was_seen_{};
};

/// In lower case.
std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

bool is_plain_image(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".pfm" || extension == ".qoi";
}

void write_plain_image(const std::string& path, const Image& image, const PictureLook& look) {
  AtomicFile file(path);
  write_plain_image(file, image, look);
}

void write_plain_image(AtomicFile& file, const Image& image, const PictureLook& look) {
  const std::string& path = file.path();
  const std::vector<uint8_t> bytes =
      extension_of(path) == ".pfm"
          ? encode_pfm(image, path)
          : encode_qoi(image.width, image.height, srgb_pixels(image, look, path));
  file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  file.replace_target();
}

std::vector<uint8_t> srgb_pixels(const Image& image, const PictureLook& look,
                                 const std::string& name) {
  if (!std::isfinite(look.exposure))
    fail("{}: the exposure must be a finite number of stops", name);
  const std::array<int, 3> colour = colour_channels(image, name);
  const auto scale = static_cast<float>(std::exp2(look.exposure));
  std::vector<uint8_t> bytes;
  bytes.reserve(image.pixel_count() * 3);
  const auto matrix = matrix_to_srgb(image);
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    Vec3d rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = image.values[pixel * image.channels.size() + colour[c]];
    if (matrix) rgb = rgb * *matrix;
    Vec3f value;
    // The order of the arguments makes a NaN black.
    for (int c = 0; c < 3; ++c) value[c] = std::max(0.0F, static_cast<float>(rgb[c]) * scale);
    value = view_transform(value, look.view);
    for (int c = 0; c < 3; ++c) {
      const float srgb = srgb_from_linear(std::min(1.0F, value[c]));
      bytes.push_back(static_cast<uint8_t>(std::lround(255.0F * srgb)));
    }
  }
  return bytes;
}

std::vector<uint8_t> encode_pfm(const Image& image, const std::string& name) {
  const std::array<int, 3> colour = colour_channels(image, name);
  // A negative scale says that the least byte comes first.
  const bool little = std::endian::native == std::endian::little;
  const std::string header =
      fmt::format("PF\n{} {}\n{}\n", image.width, image.height, little ? "-1.0" : "1.0");
  std::vector<uint8_t> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + image.pixel_count() * 3 * sizeof(float));
  for (int row = image.height - 1; row >= 0; --row) {
    for (int column = 0; column < image.width; ++column) {
      for (const int channel : colour) {
        std::array<uint8_t, sizeof(float)> value{};
        std::memcpy(value.data(), image.pixel(column, row) + channel, sizeof(float));
        bytes.insert(bytes.end(), value.begin(), value.end());
      }
    }
  }
  return bytes;
}

std::vector<uint8_t> encode_qoi(int width, int height, std::span<const uint8_t> pixels) {
  QoiWriter writer(width, height);
  for (std::size_t i = 0; i + 2 < pixels.size(); i += 3) {
    writer.add({pixels[i], pixels[i + 1], pixels[i + 2]});
  }
  return writer.finish();
}

}  // namespace freepath
