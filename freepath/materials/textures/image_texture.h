#pragma once
/// @file Images that textures look up.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/vector.h"
#include "freepath/io/image.h"

namespace freepath {

/// What lies beyond the edges of an image.
enum class ImageWrap { kRepeat, kBlack, kClamp };

/// "repeat", "black" or "clamp".
/// @throws Error for any other
ImageWrap image_wrap(std::string_view name);

/// How files of integers (PNG, JPEG, TGA, BMP, ...) encode values. Files of floating-point numbers
/// are linear whatever the encoding.
struct ImageEncoding {
  enum class Kind { kSrgb, kLinear, kGamma };
  Kind kind = Kind::kSrgb;
  float gamma = 1;  ///< value = encoded^gamma, of kGamma.
};

/// "sRGB", "linear" or "gamma 2.2".
/// @throws Error for any other
ImageEncoding image_encoding(std::string_view text);

/// Linear values of an image: 1, 3 or 4 channels. Row 0 is the top.
class TextureImage {
 public:
  /// @param channels 1 (grey), 3 (RGB) or 4 (RGBA)
  /// @throws Error if the sizes do not agree
  TextureImage(int width, int height, int channels, std::vector<float> values);

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }

  /// Bilinear; the centre of the pixel at the bottom left is at s = 0.5 / width,
  /// t = 0.5 / height.
  Vec3f color(float s, float t, ImageWrap wrap) const;
  /// Bilinear; the mean of R, G and B, or alpha of 4 channels.
  float value(float s, float t, ImageWrap wrap) const;

 private:
  struct Texel {
    float values[4];
  };
  Texel texel(int column, int row, ImageWrap wrap) const;
  Texel bilinear(float s, float t, ImageWrap wrap) const;

  int width_, height_, channels_;
  std::vector<float> values_;
};

/// What textures look up of an image in sRGB: RGB, grey, or with an alpha that isn't 1 everywhere.
/// @param image its values finite
/// @param path of the file that it was read from
/// @throws Error that names the file
std::shared_ptr<const TextureImage> texture_image(const Image& image, const std::string& path,
                                                  const ImageEncoding& encoding = {});

/// Whether only files with this extension hold encoded integers.
bool holds_encoded_integers(const std::string& path);

}  // namespace freepath
