// Any bytes as a pbrt scene: the parser must end, with a scene or with an Error of one line.
//
// The input holds several files, separated by the byte 0x1e: the scene, then "1.pbrt", "2.pbrt" and
// so on for it to include. Nothing touches the file system.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/scene/pbrt/parser.h"

namespace freepath {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "pbrt_fuzz: %s\n", what);
  std::abort();
}

std::vector<std::string> split_files(std::string_view input) {
  constexpr char kSeparator = '\x1e';
  std::vector<std::string> files;
  while (true) {
    const std::size_t end = input.find(kSeparator);
    files.emplace_back(input.substr(0, end));
    if (end == std::string_view::npos) return files;
    input.remove_prefix(end + 1);
  }
}

class InputReader final : public FileReader {
 public:
  explicit InputReader(const std::vector<std::string>& files) : files_(files) {}

  bool exists(const std::filesystem::path& path) const override {
    return find(path) < files_.size();
  }
  std::string read(const std::filesystem::path& path, std::size_t limit) const override {
    const std::size_t file = find(path);
    if (file >= files_.size()) fail("there is no such file");
    if (files_[file].size() > limit) fail("it is too large");
    return files_[file];
  }

 private:
  std::size_t find(const std::filesystem::path& path) const {
    std::size_t file = 1;
    while (file < files_.size() && path != std::to_string(file) + ".pbrt") ++file;
    return file;
  }

  const std::vector<std::string>& files_;
};

void check_message(const std::string& message) {
  require(message.rfind("scene.pbrt:", 0) == 0 || message.find(".pbrt:") != std::string::npos,
          "an error does not begin with the name of a file");
  require(message.find('\n') == std::string::npos, "an error has more than one line");
  require(message.size() < 1000, "an error is very long");
}

/// Asks for every parameter as each type in turn.
void ask_for_all(const ParameterList& list, Diagnostics& diagnostics) {
  list.report_unused(diagnostics);
  for (const auto& parameter : list.all()) {
    const std::string& name = parameter->name;
    const auto attempt = [&](const auto& ask) {
      try {
        ask();
      } catch (const Error& error) {
        check_message(error.what());
      }
    };
    attempt([&] { list.get_integer(name, 0); });
    attempt([&] { list.get_float(name, 0); });
    attempt([&] { list.get_point2s(name); });
    attempt([&] { list.get_points(name); });
    attempt([&] { list.get_normals(name); });
    attempt([&] { list.get_bool(name, false); });
    attempt([&] { list.get_string(name, ""); });
    attempt([&] { list.get_texture(name); });
    attempt([&] { list.get_spectrum(name, RgbValue{}); });
    attempt([&] { list.get_spectra(name); });
  }
}

void check_index(int index, std::size_t size) {
  require(index >= 0 && static_cast<std::size_t>(index) < size, "an index points nowhere");
}

void check_scene(const PbrtScene& scene, Diagnostics& diagnostics) {
  for (const PbrtShape& shape : scene.shapes) {
    check_index(shape.material, scene.materials.size());
    if (shape.area_light) check_index(*shape.area_light, scene.area_lights.size());
    if (shape.object) check_index(*shape.object, scene.objects.size());
    require(is_usable(shape.world_from_object.start) && is_usable(shape.world_from_object.end),
            "a shape's transform has no inverse");
  }
  for (const PbrtObject& object : scene.objects) {
    for (const int shape : object.shapes) check_index(shape, scene.shapes.size());
  }
  for (const PbrtInstance& instance : scene.instances) {
    check_index(instance.object, scene.objects.size());
  }
  // A few are as good as all, and unused names are compared with each other.
  constexpr std::size_t kMost = 20;
  for (std::size_t i = 0; i < scene.shapes.size() && i < kMost; ++i) {
    ask_for_all(scene.shapes[i].parameters, diagnostics);
  }
  for (std::size_t i = 0; i < scene.materials.size() && i < kMost; ++i) {
    ask_for_all(scene.materials[i].parameters, diagnostics);
  }
  for (std::size_t i = 0; i < scene.media.size() && i < kMost; ++i) {
    ask_for_all(scene.media[i].parameters, diagnostics);
  }
  if (scene.camera) ask_for_all(scene.camera->parameters, diagnostics);
}

void parse_input(std::string_view input) {
  const std::vector<std::string> files = split_files(input);
  const ParseLimits limits{
      .include_depth = 8, .attribute_depth = 50, .files = 20, .file_bytes = 1U << 20U};
  Diagnostics diagnostics;
  try {
    check_scene(parse_pbrt_text(files[0], "scene.pbrt", diagnostics, InputReader(files), limits),
                diagnostics);
  } catch (const Error& error) {
    check_message(error.what());
  }
  for (const std::string& warning : diagnostics.warnings()) check_message(warning);
}

}  // namespace
}  // namespace freepath

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  freepath::parse_input({reinterpret_cast<const char*>(data), size});
  return 0;
}
