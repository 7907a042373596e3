#pragma once
/// @file Images that scenes of tests read.

#include <cmath>
#include <functional>
#include <string>

#include "freepath/base/vector.h"
#include "freepath/io/image.h"
#include "tests/scene/twin_scenes.h"

namespace freepath::testing {

/// A file of an image in colours of R, G, B.
class ImageFile {
 public:
  ImageFile(const std::string& name, int width, int height,
            const std::function<Vec3f(int column, int row)>& colour)
      : file_(name) {
    Image image{width, height, {"R", "G", "B"}};
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const Vec3f value = colour(column, row);
        image.values.insert(image.values.end(), {value.x, value.y, value.z});
      }
    }
    write_exr(file_.path().string(), image);
  }
  /// The parameter of a light.
  std::string parameter() const { return R"("string filename" ")" + file_.path().string() + "\" "; }

 private:
  TemporaryFile file_;
};

/// Skies that add up to 1 everywhere: half a cap of a fifth of all directions, which is drawn, half
/// the rest, and a half that is the same from everywhere, which are found by chance.
class WhiteSkies {
 public:
  std::string lights() const {
    const std::string half = R"(LightSource "infinite" "float scale" 0.5 )";
    return half + cap_.parameter() + "\n" + half + rest_.parameter() + "\n" + half +
           "\"rgb L\" [ 1 1 1 ]\n";
  }

 private:
  static constexpr int kSize = 16;
  static bool in_cap(int column, int row) {
    constexpr int kCap = 7;
    return column < kCap && row < kCap;
  }

  ImageFile cap_{"cap.exr", kSize, kSize,
                 [](int column, int row) { return Vec3f(in_cap(column, row) ? 1.0F : 0.0F); }};
  ImageFile rest_{"rest.exr", kSize, kSize,
                  [](int column, int row) { return Vec3f(in_cap(column, row) ? 0.0F : 1.0F); }};
};

}  // namespace freepath::testing
