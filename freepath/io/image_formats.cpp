// Image formats, by OpenImageIO: the whole of the library that image_codec.h loads.

// Before OpenImageIO's headers, which bring an fmt of their own.
#include "freepath/base/error.h"

#include "freepath/io/image_codec.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include "freepath/base/memory_budget.h"
#include "freepath/base/thread_limit.h"
#include "freepath/base/version.h"

namespace freepath {
namespace {

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

/// Keeps the libraries of formats from starting threads where the system grants none: they would
/// fail for it.
void settle_threads() {
  const auto usual = static_cast<int>(std::thread::hardware_concurrency());
  if (granted_threads(2 * usual + 2) > 2 * usual + 1) return;  // both of them keep some
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
}

/// Why an image can't be what its header says; empty if it can.
std::string reason_against_size(const OIIO::ImageSpec& spec, uint64_t stored) {
  const double values = static_cast<double>(spec.nchannels) * spec.width * spec.height;
  const int bits =
      spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * spec.format.size()));
  const std::string what = fmt::format("{}x{} pixels", spec.width, spec.height);
  // Whoever reads a tile takes memory for the whole of it.
  constexpr double kLargeTile = 0x1p24;  // pixels
  const double tile = double{1} * spec.tile_width * spec.tile_height;
  if (tile > kLargeTile && tile > double{1} * spec.width * spec.height) {
    return fmt::format("its tiles of {}x{} pixels are larger than it is", spec.tile_width,
                       spec.tile_height);
  }
  try {
    check_declared("", what, values * bits / 8, stored);
    check_memory_present("", what, values * sizeof(float));
  } catch (const Error& error) {
    return std::string(error.what()).substr(2);  // behind the name, which the caller says
  }
  return {};
}

/// Reads rows [begin, end).
bool read_scanlines(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int begin, int end,
                    float* target) {
  // To read many rows OpenImageIO takes memory for some 256 of them, as stored, however few there
  // are: a row of a million pixels would take gigabytes.
  constexpr std::size_t kWideRow = std::size_t{1} << 16;  // values
  const std::size_t row = static_cast<std::size_t>(spec.width) * spec.nchannels;
  if (row < kWideRow) {
    return input.read_scanlines(0, 0, spec.y + begin, spec.y + end, spec.z, 0, spec.nchannels,
                                OIIO::TypeFloat, target);
  }
  for (int y = begin; y < end; ++y, target += row) {
    if (!input.read_scanline(spec.y + y, spec.z, OIIO::TypeFloat, target)) return false;
  }
  return true;
}

/// Reads rows in chunks, so that a header alone takes no memory.
bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, std::vector<float>& values) {
  const std::size_t row = static_cast<std::size_t>(spec.width) * spec.nchannels;
  values.reserve(row * spec.height);
  constexpr std::size_t kChunk = std::size_t{1} << 20;  // values
  // Formats pack rows together: tiles, or up to 256 rows.
  const int together = spec.tile_width > 0 ? std::max(1, spec.tile_height) : 256;
  int rows =
      static_cast<int>(std::min<std::size_t>(spec.height, std::max<std::size_t>(1, kChunk / row)));
  if (rows > together || spec.tile_width > 0) rows = std::max(together, rows / together * together);
  for (int y = 0; y < spec.height; y += rows) {
    const int end = std::min(spec.height, y + rows);
    values.resize(row * end);
    float* const target = values.data() + row * y;
    const bool read =
        spec.tile_width > 0
            ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + end, spec.z,
                               spec.z + 1, 0, spec.nchannels, OIIO::TypeFloat, target)
            : read_scanlines(input, spec, y, end, target);
    if (!read) return false;
  }
  return true;
}

constexpr const char* kChromaticities = "chromaticities";
/// Of red, green, blue and white, x and y each.
const OIIO::TypeDesc kEightFloats(OIIO::TypeDesc::FLOAT, 8);

std::optional<RgbChromaticities> chromaticities_of(const OIIO::ImageSpec& spec) {
  std::array<float, 8> v{};
  if (!spec.getattribute(kChromaticities, kEightFloats, v.data())) return {};
  const RgbChromaticities given{{{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}}, {v[6], v[7]}};
  // What makes no space is left out: primaries on a line, or a white without luminance.
  const auto& [red, green, blue] = given.primaries;
  const double area = (green.x - red.x) * (blue.y - red.y) - (blue.x - red.x) * (green.y - red.y);
  const bool valid = std::abs(area) > 1e-4 && given.white.y > 1e-3;
  if (!valid || are_same(given, RgbChromaticities())) return {};
  return given;
}

std::string read_stored(const std::string& path, uint64_t stored, Image& image, bool& srgb,
                        int& alpha) {
  settle_threads();
  OIIO::ImageSpec wish;
  wish.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wish);
  if (!input) return "can't read the image: " + trimmed(OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep) return "a deep image; flatten it first";
  if (spec.depth > 1) {
    return "an image with " + std::to_string(spec.depth) + " slices; give one with a single one";
  }
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) return "an image without pixels";
  if (std::string reason = reason_against_size(spec, stored); !reason.empty()) return reason;
  image.width = spec.width;
  image.height = spec.height;
  image.x = spec.x - spec.full_x;
  image.y = spec.y - spec.full_y;
  image.full_width = spec.full_width;
  image.full_height = spec.full_height;
  image.channels = spec.channelnames;
  image.metadata = metadata_of(spec);
  srgb = spec.get_string_attribute("oiio:ColorSpace") == "sRGB";
  alpha = spec.alpha_channel;
  if (!srgb) image.chromaticities = chromaticities_of(spec);
  if (!read_rows(*input, spec, image.values)) {
    return "can't read the image: " + trimmed(input->geterror());
  }
  return {};
}

}  // namespace
}  // namespace freepath

extern "C" const freepath::ImageCodec* freepath_image_codec() {
  static const freepath::ImageCodec kCodec{freepath::version(), freepath::read_stored};
  return &kCodec;
}
