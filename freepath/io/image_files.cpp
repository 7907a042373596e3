// Image files: what does not depend on their formats.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "freepath/base/error.h"
#include "freepath/base/input_file.h"
#include "freepath/io/atomic_file.h"
#include "freepath/io/atomic_image.h"
#include "freepath/io/exr_header.h"
#include "freepath/io/image.h"
#include "freepath/io/image_codec.h"
#include "freepath/io/image_encode.h"
#include "freepath/io/image_plain.h"

namespace freepath {

namespace {

namespace fs = std::filesystem;

void check_consistent(const std::string& path, const Image& image) {
  if (image.width < 1 || image.height < 1 || image.channels.empty() ||
      image.values.size() != image.pixel_count() * image.channels.size()) {
    fail("{}: the image to write has {}x{} pixels, {} channels and {} values, which do not agree",
         path, image.width, image.height, image.channels.size(), image.values.size());
  }
}

/// Makes the colour channels of sRGB values linear.
void linearise(Image& image, int alpha_channel) {
  const int channels = static_cast<int>(image.channels.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (static_cast<int>(i % channels) != alpha_channel) {
      image.values[i] = linear_from_srgb(image.values[i]);
    }
  }
}

}  // namespace

Image read_image(const std::string& path) {
  const InputFile file(path, "an image");  // OpenImageIO would wait for a pipe
  io::check_exr_header(file);
  Image image;
  bool srgb = false;
  int alpha = -1;
  const std::string reason = image_codec().read(path, file.size(), image, srgb, alpha);
  if (!reason.empty()) fail("{}: {}", path, reason);
  if (srgb) linearise(image, alpha);
  return image;
}

ImageFormat image_format(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return ImageFormat::kExr;
  if (extension == ".png") return ImageFormat::kPng;
  fail("{}: can't write images with the extension \"{}\"; use .exr, .png, .pfm or .qoi", path,
       extension);
}

void check_writable(const std::string& path) {
  if (!is_plain_image(path)) image_format(path);
  check_file_target(path);
}

void write_exr(const std::string& path, const Image& image, const ExrFormat& format) {
  AtomicFile file(path);
  write_exr(file, image, format);
}

void write_exr(AtomicFile& file, const Image& image, const ExrFormat& format) {
  const std::string& path = file.path();
  check_consistent(path, image);
  if (image_format(path) != ImageFormat::kExr) fail("{}: an EXR file must end in .exr", path);
  const std::string reason = write_exr_values(file.name(), image, format);
  if (!reason.empty()) file.give_up(reason);
  file.replace_target();
}

std::vector<uint8_t> encode_png(const Image& image, const PictureLook& look,
                                const std::string& name) {
  check_consistent(name, image);
  const std::vector<uint8_t> bytes = srgb_pixels(image, look, name);
  std::vector<uint8_t> encoded;
  const std::string reason = encode_png_pixels(image.width, image.height, bytes.data(), encoded);
  if (!reason.empty()) fail("{}: can't encode the picture: {}", name, reason);
  return encoded;
}

void write_png(const std::string& path, const Image& image, const PictureLook& look) {
  AtomicFile file(path);
  write_png(file, image, look);
}

void write_png(AtomicFile& file, const Image& image, const PictureLook& look) {
  const std::string& path = file.path();
  if (image_format(path) != ImageFormat::kPng) fail("{}: a PNG file must end in .png", path);
  // The PNG writer doesn't notice a full disk, hence the detour.
  const std::vector<uint8_t> bytes = encode_png(image, look, path);
  file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  file.replace_target();
}

bool is_exr(const std::string& path) {
  return !is_plain_image(path) && image_format(path) == ImageFormat::kExr;
}

void write_image(AtomicFile& file, const Image& image, const PictureLook& look,
                 const ExrFormat& format) {
  if (is_plain_image(file.path())) return write_plain_image(file, image, look);
  if (is_exr(file.path())) return write_exr(file, image, format);
  write_png(file, image, look);
}

}  // namespace freepath
