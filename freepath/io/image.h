#pragma once
/// @file Images in files: read in any format OpenImageIO knows, written as EXR and PNG.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "freepath/base/rgb_primaries.h"
#include "freepath/base/vector.h"
#include "freepath/io/view_transform.h"

namespace freepath {

/// A value of an image's metadata; matrices are for points as rows.
using MetadataValue = std::variant<int64_t, double, std::string, Matrix4d>;

/// Pixels with named channels. Row 0 is the top; values are linear.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels = {};  ///< Names: R, G, B, A, variance.R, ...
  std::vector<float> values = {};  ///< Interleaved: ((row · width) + column) · channels + channel
  /// Attributes in the order of writing.
  std::vector<std::pair<std::string, MetadataValue>> metadata = {};
  /// Position in a larger picture that it is a part of, and the size of that [pixels]; a size
  /// of 0 is its own.
  int x = 0, y = 0, full_width = 0, full_height = 0;

  /// Primaries of the space of R, G and B, where it is not sRGB's.
  std::optional<RgbChromaticities> chromaticities = {};

  std::size_t pixel_count() const { return static_cast<std::size_t>(width) * height; }
  /// The values of a pixel, one for each channel.
  const float* pixel(int column, int row) const {
    return values.data() + (static_cast<std::size_t>(row) * width + column) * channels.size();
  }
  float* pixel(int column, int row) {
    return values.data() + (static_cast<std::size_t>(row) * width + column) * channels.size();
  }
};

/// Number of the channel with this very name.
std::optional<int> find_channel(const Image& image, std::string_view name);

/// Numbers of the channels that make the colour: R, G and B by name, else the only colour channel
/// (Y, or the only channel there is) three times.
/// @param name what to call the image in a message
/// @throws Error that lists the channels, if there is no colour among them
std::array<int, 3> colour_channels(const Image& image, const std::string& name);

/// The matrix that takes an image's R, G, B to sRGB's; none where they are sRGB's. A colour stays
/// the same light: no white is adapted to another.
std::optional<Matrix3d> matrix_to_srgb(const Image& image);

/// The image with R, G and B in sRGB's primaries, where negative values are colours that these
/// can't mix. All other channels stay.
Image in_srgb(Image image);

/// Reads an image: the first part of the file, its data window. Formats that store sRGB values
/// (PNG, JPEG) are made linear, their alpha left as it is.
/// @throws Error that names the file, if it is missing, damaged or no image
Image read_image(const std::string& path);

/// The kinds of files that images are written to.
enum class ImageFormat { kExr, kPng };

/// The format that the extension stands for.
/// @throws Error for an extension that cannot be written
ImageFormat image_format(const std::string& path);

/// Checks that an image could be written, before the time for rendering it is spent: the extension
/// is known, the folder exists and can be written to, what stands there already is a file that is
/// not read-only, and the library of image formats is there.
/// @throws Error that names the file and what to do
void check_writable(const std::string& path);

/// How values are stored in an EXR file.
enum class ExrPrecision {
  kFloat,
  /// Floats of 16 bits, but for depths, positions, counts and variances, which need more. Values
  /// beyond ±65504 are stored as ±65504.
  kHalf
};

/// How an EXR file is packed.
enum class ExrCompression {
  kNone,
  kZip,   ///< 16 rows at a time.
  kZips,  ///< Row by row, for programs that read rows.
  kPiz,   ///< Wavelets, which suit grain.
  kDwaa,  ///< Lossy like JPEG, 32 rows at a time.
  kDwab   ///< Lossy like JPEG, 256 rows at a time.
};

/// The form of an EXR file.
struct ExrFormat {
  ExrPrecision precision = ExrPrecision::kFloat;
  ExrCompression compression = ExrCompression::kZip;
  /// Level of loss of kDwaa and kDwab: the larger, the smaller the file and the worse the picture.
  float dwa_level = 45;
};

/// Writes all channels and the metadata to an EXR file. Integers of the metadata
/// that need more than 32 bits are stored as decimal text, since EXR has no wider type.
///
/// The file is written aside, in the same folder, and then renamed: a reader never sees half of it,
/// and an old one survives a failure.
/// @throws Error that names the file
void write_exr(const std::string& path, const Image& image, const ExrFormat& format = {});

/// How light becomes a picture of 8 bits.
struct PictureLook {
  double exposure = 0;  ///< Values are multiplied by 2^exposure first [stops].
  ViewTransform view = ViewTransform::kStandard;
};

/// The bytes of a PNG file of the colour: 8 bits, sRGB's primaries and transfer function.
/// @param name what to call the image in a message
/// @throws Error if it can't be encoded
std::vector<uint8_t> encode_png(const Image& image, const PictureLook& look,
                                const std::string& name);

/// Writes the colour to a PNG file: as encode_png, in the same two steps as write_exr.
/// @throws Error that names the file
void write_png(const std::string& path, const Image& image, const PictureLook& look = {});

/// The sRGB transfer function, linear → encoded, both in [0, 1] [IEC61966].
float srgb_from_linear(float linear);
/// The linear value of one encoded by sRGB's curve: the inverse of srgb_from_linear.
float linear_from_srgb(float encoded);

}  // namespace freepath
