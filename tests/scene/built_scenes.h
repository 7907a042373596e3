#pragma once
/// @file Materials and textures built from scenes that are no files.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "freepath/scene/assembly/build_materials.h"
#include "freepath/scene/assembly/build_textures.h"
#include "freepath/spectra/rgb_color_space.h"
#include "tests/scene/scenes_in_memory.h"

namespace freepath::testing {

/// The textures and materials of a scene, at a point of a plane that is seen from straight above.
class ParsedScene {
 public:
  explicit ParsedScene(const std::string& text) : pbrt_(parse(text, diagnostics_)) {
    scene_.spectra = std::make_unique<SpectrumTable>(rgb_color_space("srgb"));
    build_textures(context_);
    build_materials(context_);
    values_ = scene_.spectra->in_rgb();
  }
  ParsedScene(const ParsedScene&) = delete;
  ParsedScene& operator=(const ParsedScene&) = delete;

  const PathScene& scene() const { return scene_; }
  const BuildContext& context() const { return context_; }
  const SpectrumValues& values() const { return values_; }
  const std::vector<std::optional<uint32_t>>& materials() const { return context_.materials; }
  std::vector<std::string> warnings() const { return diagnostics_.warnings(); }

  /// R, G, B of what a material of PathScene::materials reflects.
  Vec3f albedo(std::size_t material, float u = 0, float v = 0) const {
    return rgb(scene_.materials.at(material).albedo(point(u, v), Vec3f(0, 0, -1), surface()));
  }
  /// The refractive index of a dielectric.
  template <class Kind>
  float index_of(std::size_t material) const {
    return values_[std::get<Kind>(scene_.materials.at(material).kind()).eta][0];
  }

  float float_texture(const std::string& name, float u = 0, float v = 0) const {
    return scene_.textures.evaluate_float(context_.float_textures.at(name), point(u, v));
  }
  Vec3f spectrum_texture(const std::string& name, float u = 0, float v = 0) const {
    return rgb(scene_.textures.evaluate_spectrum(context_.reflectance_textures.at(name),
                                                 point(u, v), values_));
  }

 private:
  static SurfacePoint point(float u, float v) {
    SurfacePoint point;
    point.position = Vec3f(0);
    point.normal = point.shading_normal = Vec3f(0, 0, 1);
    point.dpdu = Vec3f(1, 0, 0);
    point.u = u;
    point.v = v;
    return point;
  }
  static Vec3f rgb(const SampledSpectrum& channels) {
    return {channels[0], channels[1], channels[2]};
  }
  SurfaceContext surface() const { return {values_, scene_.textures}; }

  Diagnostics diagnostics_;
  PbrtScene pbrt_;
  PathScene scene_;
  BuildContext context_{.pbrt = pbrt_, .diagnostics = diagnostics_, .scene = scene_};
  SpectrumValues values_;
};

/// The message of the error that building ends with; empty if there is none.
inline std::string build_error(const std::string& text) {
  try {
    const ParsedScene built(text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace freepath::testing
