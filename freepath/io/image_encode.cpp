#include "freepath/io/image_encode.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <fstream>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <variant>

#include "freepath/base/thread_limit.h"

namespace freepath {
namespace {

/// Threads that pack rows, as many as the system grants.
int packing_threads() {
  static std::once_flag once;
  std::call_once(once, [] {
    const int usual = tbb::info::default_concurrency();
    // OpenEXR waits in the calling thread, and ends the program where it can't start one.
    const int granted = granted_threads(usual + 1) - 1;
    if (granted > 1) Imf::setGlobalThreadCount(std::min(granted, usual));
  });
  return Imf::globalThreadCount();
}

void set_metadata(Imf::Header& header, const Image& image) {
  for (const auto& [name, value] : image.metadata) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* real = std::get_if<double>(&value)) {
      header.insert(name, Imf::DoubleAttribute(*real));
    } else if (const auto* matrix = std::get_if<Matrix4d>(&value)) {
      header.insert(name, Imf::M44fAttribute(Imath::M44f(*matrix)));
    } else {
      const int64_t integer = std::get<int64_t>(value);
      if (integer >= std::numeric_limits<int>::min() &&
          integer <= std::numeric_limits<int>::max()) {
        header.insert(name, Imf::IntAttribute(static_cast<int>(integer)));
      } else {
        header.insert(name, Imf::StringAttribute(std::to_string(integer)));
      }
    }
  }
}

/// Says them always: not all readers take the format's word for those of a file without.
void set_chromaticities(Imf::Header& header, const Image& image) {
  const auto vector = [](const Chromaticity& c) {
    return Imath::V2f(static_cast<float>(c.x), static_cast<float>(c.y));
  };
  const auto& [primaries, white] = image.chromaticities.value_or(RgbChromaticities());
  Imf::addChromaticities(header, Imf::Chromaticities(vector(primaries.red), vector(primaries.green),
                                                     vector(primaries.blue), vector(white)));
}

/// Numbers of the pixels from..to, both included.
Imath::Box2i window(int x, int y, int width, int height) {
  return {Imath::V2i(x, y), Imath::V2i(x + width - 1, y + height - 1)};
}

Imf::Compression compression_of(ExrCompression compression) {
  switch (compression) {
    case ExrCompression::kNone:
      return Imf::NO_COMPRESSION;
    case ExrCompression::kZip:
      return Imf::ZIP_COMPRESSION;
    case ExrCompression::kZips:
      return Imf::ZIPS_COMPRESSION;
    case ExrCompression::kPiz:
      return Imf::PIZ_COMPRESSION;
    case ExrCompression::kDwaa:
      return Imf::DWAA_COMPRESSION;
    case ExrCompression::kDwab:
      return Imf::DWAB_COMPRESSION;
  }
  return Imf::ZIP_COMPRESSION;
}

/// Whether the values of a channel have a place in 16 bits: not those that measure or count.
bool fits_half(const std::string& channel) {
  constexpr std::array<std::string_view, 5> kExact = {"depth.", "position.", "variance.", "lookups",
                                                      "samples"};
  return std::none_of(kExact.begin(), kExact.end(),
                      [&](std::string_view name) { return channel.starts_with(name); });
}

/// A channel in 16 bits.
std::vector<Imath::half> half_channel(const Image& image, std::size_t channel) {
  constexpr float kLargestHalf = 65504;
  std::vector<Imath::half> values;
  values.reserve(image.pixel_count());
  for (std::size_t i = channel; i < image.values.size(); i += image.channels.size()) {
    values.emplace_back(std::clamp(image.values[i], -kLargestHalf, kLargestHalf));
  }
  return values;
}

void write(const std::string& name, const Image& image, const ExrFormat& format) {
  const Imath::Box2i pixels = window(image.x, image.y, image.width, image.height);
  const Imath::Box2i whole = image.full_width > 0 && image.full_height > 0
                                 ? window(0, 0, image.full_width, image.full_height)
                                 : pixels;
  Imf::Header header(whole, pixels, 1, Imath::V2f(0), 1, Imf::INCREASING_Y,
                     compression_of(format.compression));
  header.dwaCompressionLevel() = format.dwa_level;
  set_metadata(header, image);
  set_chromaticities(header, image);
  Imf::FrameBuffer buffer;
  std::vector<std::vector<Imath::half>> halves(image.channels.size());
  const std::size_t stride = image.channels.size() * sizeof(float);
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const bool is_half = format.precision == ExrPrecision::kHalf && fits_half(image.channels[c]);
    header.channels().insert(image.channels[c], Imf::Channel(is_half ? Imf::HALF : Imf::FLOAT));
    if (is_half) {
      halves[c] = half_channel(image, c);
      constexpr std::size_t kSize = sizeof(Imath::half);
      buffer.insert(image.channels[c], Imf::Slice::Make(Imf::HALF, halves[c].data(), pixels, kSize,
                                                        kSize * image.width));
    } else {
      buffer.insert(image.channels[c], Imf::Slice::Make(Imf::FLOAT, image.values.data() + c, pixels,
                                                        stride, stride * image.width));
    }
  }
  std::ofstream stream(name, std::ios::binary);
  {
    Imf::StdOFStream output(stream, name.c_str());
    Imf::OutputFile file(output, header, packing_threads());
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  }
  // The end is written where OpenEXR lets no error out.
  stream.close();
  if (!stream) throw std::runtime_error("its last bytes can't be written; is the disk full?");
}

}  // namespace

std::string write_exr_values(const std::string& name, const Image& image, const ExrFormat& format) {
  try {
    write(name, image, format);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

std::string encode_png_pixels(int width, int height, const uint8_t* rgb,
                              std::vector<uint8_t>& encoded) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  encoded.resize(size);
  if (png_image_write_to_memory(&image, encoded.data(), &size, 0, rgb, 0, nullptr) == 0) {
    return static_cast<const char*>(image.message);
  }
  encoded.resize(size);
  return {};
}

}  // namespace freepath
