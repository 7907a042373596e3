#include "freepath/materials/textures/image_texture.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "freepath/base/error.h"
#include "freepath/io/image.h"

namespace freepath {

namespace {

/// Formats of floating-point numbers; all others that can be read hold integers.
constexpr std::array<std::string_view, 4> kLinearExtensions = {"exr", "pfm", "hdr", "rgbe"};

/// Whether the reader has turned sRGB values into linear ones.
bool was_linearised(const Image& image) {
  return std::any_of(image.metadata.begin(), image.metadata.end(), [](const auto& entry) {
    const auto* const text = std::get_if<std::string>(&entry.second);
    return entry.first == "oiio:ColorSpace" && text != nullptr && *text == "sRGB";
  });
}

float decoded(float stored, const ImageEncoding& encoding) {
  switch (encoding.kind) {
    case ImageEncoding::Kind::kSrgb:
      return linear_from_srgb(stored);
    case ImageEncoding::Kind::kGamma:
      return std::pow(std::max(0.0F, stored), encoding.gamma);
    case ImageEncoding::Kind::kLinear:
      break;
  }
  return stored;
}

/// The numbers of the channels to keep: grey, RGB or RGBA.
std::vector<int> kept_channels(const Image& image, const std::string& path) {
  const std::array<int, 3> colour = colour_channels(image, path);
  std::vector<int> kept(colour.begin(), colour.end());
  const bool grey = colour[0] == colour[1] && colour[1] == colour[2];
  if (grey) kept.resize(1);
  const std::optional<int> alpha = find_channel(image, "A");
  if (grey || !alpha) return kept;
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    if (image.values[i * image.channels.size() + *alpha] != 1.0F) {
      kept.push_back(*alpha);
      break;
    }
  }
  return kept;
}

int wrapped(int i, int size, ImageWrap wrap) {
  if (wrap == ImageWrap::kClamp) return std::clamp(i, 0, size - 1);
  const int rest = i % size;
  return rest < 0 ? rest + size : rest;
}

}  // namespace

ImageWrap image_wrap(std::string_view name) {
  if (name == "repeat") return ImageWrap::kRepeat;
  if (name == "black") return ImageWrap::kBlack;
  if (name == "clamp") return ImageWrap::kClamp;
  fail(R"(the wrap "{}" is not known; use "repeat", "black" or "clamp")", name);
}

ImageEncoding image_encoding(std::string_view text) {
  if (text == "sRGB") return {ImageEncoding::Kind::kSrgb, 1};
  if (text == "linear") return {ImageEncoding::Kind::kLinear, 1};
  constexpr std::string_view kGamma = "gamma ";
  if (text.substr(0, kGamma.size()) == kGamma) {
    const std::string_view number = text.substr(kGamma.size());
    float gamma = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), gamma);
    if (error == std::errc() && end == number.data() + number.size() && gamma > 0 &&
        std::isfinite(gamma)) {
      return {ImageEncoding::Kind::kGamma, gamma};
    }
  }
  fail(R"(the encoding "{}" is not known; use "sRGB", "linear" or "gamma 2.2")", text);
}

bool holds_encoded_integers(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  std::string extension = dot == std::string::npos ? "" : path.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kLinearExtensions.begin(), kLinearExtensions.end(), extension) ==
         kLinearExtensions.end();
}

TextureImage::TextureImage(int width, int height, int channels, std::vector<float> values)
    : width_(width), height_(height), channels_(channels), values_(std::move(values)) {
  const bool known = channels == 1 || channels == 3 || channels == 4;
  if (width < 1 || height < 1 || !known ||
      values_.size() != static_cast<std::size_t>(width) * height * channels) {
    fail("an image for a texture has {}x{} pixels, {} channels and {} values, which do not agree",
         width, height, channels, values_.size());
  }
}

TextureImage::Texel TextureImage::texel(int column, int row, ImageWrap wrap) const {
  const bool outside = column < 0 || row < 0 || column >= width_ || row >= height_;
  if (outside && wrap == ImageWrap::kBlack) return {};
  const float* const values =
      values_.data() + (static_cast<std::size_t>(wrapped(row, height_, wrap)) * width_ +
                        wrapped(column, width_, wrap)) *
                           channels_;
  Texel result{};
  std::copy_n(values, channels_, result.values);
  return result;
}

TextureImage::Texel TextureImage::bilinear(float s, float t, ImageWrap wrap) const {
  // Within a range of integers; coordinates that are further out, or none, are those of a corner.
  constexpr float kFarthest = 1e9F;
  const auto pixels = [](float coordinate, int size) {
    const float at = coordinate * static_cast<float>(size) - 0.5F;
    return at > -kFarthest && at < kFarthest ? at : 0.0F;
  };
  const float x = pixels(s, width_);
  const float y = pixels(1.0F - t, height_);  // row 0 is the top, t = 0 the bottom
  const auto column = static_cast<int>(std::floor(x));
  const auto row = static_cast<int>(std::floor(y));
  const float dx = x - std::floor(x);
  const float dy = y - std::floor(y);
  const Texel corners[4] = {texel(column, row, wrap), texel(column + 1, row, wrap),
                            texel(column, row + 1, wrap), texel(column + 1, row + 1, wrap)};
  const float weights[4] = {(1 - dx) * (1 - dy), dx * (1 - dy), (1 - dx) * dy, dx * dy};
  Texel result{};
  for (int corner = 0; corner < 4; ++corner) {
    for (int c = 0; c < channels_; ++c) {
      result.values[c] += weights[corner] * corners[corner].values[c];
    }
  }
  return result;
}

Vec3f TextureImage::color(float s, float t, ImageWrap wrap) const {
  const Texel texel = bilinear(s, t, wrap);
  if (channels_ == 1) return Vec3f(texel.values[0]);
  return {texel.values[0], texel.values[1], texel.values[2]};
}

float TextureImage::value(float s, float t, ImageWrap wrap) const {
  const Texel texel = bilinear(s, t, wrap);
  if (channels_ == 1) return texel.values[0];
  if (channels_ == 4) return texel.values[3];
  return (texel.values[0] + texel.values[1] + texel.values[2]) * (1.0F / 3.0F);
}

std::shared_ptr<const TextureImage> texture_image(const Image& image, const std::string& path,
                                                  const ImageEncoding& encoding) {
  const std::vector<int> kept = kept_channels(image, path);
  const bool encoded = holds_encoded_integers(path);
  const bool linearised = was_linearised(image);
  const auto linear = [&](float value) {
    if (!encoded || (linearised && encoding.kind == ImageEncoding::Kind::kSrgb)) return value;
    return decoded(linearised ? srgb_from_linear(value) : value, encoding);
  };
  std::vector<float> values;
  values.reserve(image.pixel_count() * kept.size());
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (std::size_t c = 0; c < kept.size(); ++c) {
      const float value = image.values[i * image.channels.size() + kept[c]];
      values.push_back(c == 3 ? value : linear(value));
    }
  }
  return std::make_shared<TextureImage>(image.width, image.height, static_cast<int>(kept.size()),
                                        std::move(values));
}

}  // namespace freepath
