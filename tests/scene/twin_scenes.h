#pragma once
/// @file A stage on which the same thing is put in two ways.

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "tests/scene/rendered_scenes.h"

namespace freepath::testing {

/// The name of a file that goes with this object.
class TemporaryFile {
 public:
  /// @param name with its ending; tests that run at the same time share folders, but not processes
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("freepath_" + std::to_string(::getpid()) + "_" + name)) {}
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Lights of all kinds and a floor, so that whatever stands at the origin is lit from all sides,
/// but not evenly, and casts a shadow.
inline std::string stage(const std::string& world, const std::string& before = kUnlimited,
                         int film_size = 16) {
  return before + film(film_size) + R"(
      LookAt 1.5 1.2 -4  0 0 0  0 1 0
      Camera "perspective" "float fov" 36
      WorldBegin
      LightSource "infinite" "rgb L" [ .3 .3 .3 ]
      LightSource "distant" "rgb L" [ 2 2 2 ] "point3 from" [ 1 2 -1 ] "point3 to" [ 0 0 0 ]
      AttributeBegin
        Material "diffuse" "rgb reflectance" [ .6 .6 .6 ]
        Shape "bilinearmesh" "point3 P" [ -4 -1.6 -4  -4 -1.6 4  4 -1.6 -4  4 -1.6 4 ]
      AttributeEnd
      )" +
         world;
}

/// Both have the same mean, in both modes.
inline void expect_twins(const std::string& name, const std::string& a, const std::string& b,
                         uint32_t samples = 256,
                         const MeanTolerance& tolerance = {.absolute = 2e-5,
                                                           .largest_relative_error = 0.01}) {
  for (const ColorMode mode : kColorModes) {
    PictureOptions options{.mode = mode, .samples = samples};
    const Picture first = render_text(a, options);
    options.seed = 77;
    expect_alike(name + " " + name_of(mode), first, render_text(b, options), tolerance);
  }
}

}  // namespace freepath::testing
