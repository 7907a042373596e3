#include "freepath/io/image_codec.h"

#include "freepath/io/format_library.h"

namespace freepath {

const ImageCodec& image_codec() {
  static const auto& codec =
      load_codec<ImageCodec>("libfreepath_images.so", kImageCodecFunction, "images");
  return codec;
}

}  // namespace freepath
