// Image files, by OpenImageIO. It stands apart from the rest, so that programs that read and write
// none don't load it.

// Before OpenImageIO's headers, which bring an fmt of their own.
#include "freepath/base/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>

#include "freepath/io/aside_file.h"
#include "freepath/io/image.h"

namespace freepath {

namespace {

namespace fs = std::filesystem;

/// OpenImageIO's message, without a line break at its end.
std::string trimmed(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) {
    message.pop_back();
  }
  return message.empty() ? "unknown reason" : message;
}

std::vector<std::pair<std::string, MetadataValue>> metadata_of(const OIIO::ImageSpec& spec) {
  std::vector<std::pair<std::string, MetadataValue>> metadata;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (value.type() == OIIO::TypeString) {
      metadata.emplace_back(name, value.get_string());
    } else if (value.type() == OIIO::TypeInt) {
      metadata.emplace_back(name, int64_t{value.get_int()});
    } else if (value.type() == OIIO::TypeFloat) {
      metadata.emplace_back(name, double{value.get_float()});
    } else if (value.type() == OIIO::TypeDesc(OIIO::TypeDesc::DOUBLE)) {
      metadata.emplace_back(name, *static_cast<const double*>(value.data()));
    }
  }
  return metadata;
}

void set_metadata(OIIO::ImageSpec& spec, const Image& image) {
  for (const auto& [name, value] : image.metadata) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      spec.attribute(name, *text);
    } else if (const auto* real = std::get_if<double>(&value)) {
      spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::DOUBLE), real);
    } else {
      const int64_t integer = std::get<int64_t>(value);
      if (integer >= std::numeric_limits<int>::min() &&
          integer <= std::numeric_limits<int>::max()) {
        spec.attribute(name, static_cast<int>(integer));
      } else {
        spec.attribute(name, std::to_string(integer));
      }
    }
  }
}

/// Writes with OpenImageIO: into the file of that name, or into a buffer if there is one.
/// @return the reason why it could not; empty: it is written
std::string encode(const std::string& name, const char* format, const OIIO::ImageSpec& spec,
                   const OIIO::TypeDesc& type, const void* pixels,
                   OIIO::Filesystem::IOProxy* buffer = nullptr) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output) return trimmed(OIIO::geterror());
  if (buffer != nullptr && !output->set_ioproxy(buffer)) return trimmed(output->geterror());
  if (!output->open(name, spec)) return trimmed(output->geterror());
  const bool written = output->write_image(type, pixels);
  const std::string reason = output->geterror();
  if (output->close() && written) return {};
  return trimmed(written ? output->geterror() : reason);
}

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
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail("{}: no such file", path);
  if (fs::is_directory(status)) fail("{}: is a folder, not an image", path);
  OIIO::ImageSpec wish;
  wish.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wish);
  if (!input) fail("{}: can't read the image: {}", path, trimmed(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep) fail("{}: a deep image; flatten it first", path);
  if (spec.depth > 1)
    fail("{}: an image with {} slices; give one with a single one", path, spec.depth);
  Image image;
  image.width = spec.width;
  image.height = spec.height;
  image.x = spec.x - spec.full_x;
  image.y = spec.y - spec.full_y;
  image.full_width = spec.full_width;
  image.full_height = spec.full_height;
  image.channels = spec.channelnames;
  image.values.resize(image.pixel_count() * image.channels.size());
  image.metadata = metadata_of(spec);
  const bool encoded = spec.get_string_attribute("oiio:ColorSpace") == "sRGB";
  if (!input->read_image(0, 0, 0, -1, OIIO::TypeFloat, image.values.data())) {
    fail("{}: can't read the image: {}", path, trimmed(input->geterror()));
  }
  if (encoded) linearise(image, spec.alpha_channel);
  return image;
}

ImageFormat image_format(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".exr") return ImageFormat::kExr;
  if (extension == ".png") return ImageFormat::kPng;
  fail("{}: can't write images with the extension \"{}\"; use .exr or .png", path, extension);
}

void check_writable(const std::string& path) {
  image_format(path);
  check_file_place(path);
}

void write_exr(const std::string& path, const Image& image, ExrPrecision precision) {
  check_consistent(path, image);
  if (image_format(path) != ImageFormat::kExr) fail("{}: an EXR file must end in .exr", path);
  const bool half = precision == ExrPrecision::kHalf;
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()),
                       half ? OIIO::TypeHalf : OIIO::TypeFloat);
  spec.channelnames = image.channels;
  spec.x = image.x;
  spec.y = image.y;
  if (image.full_width > 0) spec.full_width = image.full_width;
  if (image.full_height > 0) spec.full_height = image.full_height;
  spec.attribute("compression", "zip");
  set_metadata(spec, image);
  std::vector<float> clamped;
  if (half) {
    constexpr float kLargestHalf = 65504;
    clamped = image.values;
    for (float& value : clamped) value = std::clamp(value, -kLargestHalf, kLargestHalf);
  }
  const AsideFile file(path);
  const std::string reason = encode(file.name(), "openexr", spec, OIIO::TypeFloat,
                                    half ? clamped.data() : image.values.data());
  if (!reason.empty()) file.give_up(reason);
  file.replace_target();
}

std::vector<uint8_t> encode_png(const Image& image, double exposure, const std::string& name) {
  check_consistent(name, image);
  if (!std::isfinite(exposure)) fail("{}: the exposure must be a finite number of stops", name);
  const std::array<int, 3> colour = colour_channels(image, name);
  const auto scale = static_cast<float>(std::exp2(exposure));
  std::vector<uint8_t> bytes;
  bytes.reserve(image.pixel_count() * 3);
  for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel) {
    for (const int channel : colour) {
      const float value = image.values[pixel * image.channels.size() + channel] * scale;
      // The order of the arguments makes a NaN black.
      const float srgb = srgb_from_linear(std::min(1.0F, std::max(0.0F, value)));
      bytes.push_back(static_cast<uint8_t>(std::lround(255.0F * srgb)));
    }
  }
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput buffer(encoded);
  const std::string reason =
      encode("picture.png", "png", spec, OIIO::TypeUInt8, bytes.data(), &buffer);
  if (!reason.empty()) fail("{}: can't encode the picture: {}", name, reason);
  return encoded;
}

void write_png(const std::string& path, const Image& image, double exposure) {
  if (image_format(path) != ImageFormat::kPng) fail("{}: a PNG file must end in .png", path);
  // The PNG writer doesn't notice a full disk, hence the detour.
  const std::vector<uint8_t> bytes = encode_png(image, exposure, path);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace freepath
