#pragma once
/// @file What the parts of the builder of scenes share.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/io/invalid_values.h"
#include "freepath/paths/path_scene.h"
#include "freepath/scene/assembly/camera_change.h"
#include "freepath/scene/ground.h"
#include "freepath/scene/pbrt/diagnostics.h"
#include "freepath/scene/pbrt/scene.h"
#include "freepath/scene/periodic_sides.h"
#include "freepath/scene/surroundings.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath {

/// The film's size [pixels].
struct FilmSize {
  int width = 1280, height = 720;
};

/// What may be said about a scene from outside of its file.
struct BuildOptions {
  std::optional<FilmSize> size = {};  ///< Replaces the film's.
  /// Policy for voxels and pixels that are NaN or infinite.
  InvalidPolicy invalid = InvalidPolicy::kZero;
  int super_voxel = 0;  ///< Edge of the super-voxels of all media [voxels], 0 for automatic.
  /// An environment replaces the scene's lights from everywhere around; the sun is added.
  Surroundings surroundings = {};
  std::optional<Ground> ground = {};  ///< Is added.
  PeriodicSides sides = {};           ///< Axes along which it repeats.
  std::optional<CameraChange> camera = {};
  /// Coefficients of media whose statements say nothing of them [1/m per density].
  std::optional<Rgb> sigma_a = {}, sigma_s = {};
  std::optional<PhaseFunction> phase = {};
};

/// A scene on its way from its description to what is rendered. Parts fill `scene`; each reports
/// the parameters of its statements that it did not ask for (ParameterList::report_unused).
struct BuildContext {
  const PbrtScene& pbrt;
  Diagnostics& diagnostics;
  PathScene& scene;
  /// Names of media → PathScene::media.
  std::map<std::string, MediumId, std::less<>> media = {};
  /// Names of float textures → PathScene::textures.
  std::map<std::string, FloatTextureId, std::less<>> float_textures = {};
  /// Names of spectrum textures whose colours are reflectances; of those that nothing uses, too.
  std::map<std::string, SpectrumTextureId, std::less<>> reflectance_textures = {};
  /// Names of spectrum textures whose colours are coefficients. A texture may be in both.
  std::map<std::string, SpectrumTextureId, std::less<>> unbounded_textures = {};
  /// Index in PathScene::materials of each of PbrtScene::materials; nothing for an `interface`.
  std::vector<std::optional<uint32_t>> materials = {};
  /// Files that statements name (file_of).
  std::vector<std::filesystem::path> files = {};
  BuildOptions options = {};
};

/// Which spectrum a parameter's colour stands for.
enum class ColorMeaning {
  kReflectance,  ///< Reflectance, in [0, 1].
  kUnbounded,    ///< A coefficient.
  kIlluminant,   ///< Light.
};

/// The spectrum of a parameter. RGB becomes smooth spectra; an RGB reflectance is clipped to
/// [0, 1] with a warning.
/// @param list,name where to say that it stands, in errors
/// @throws Error with file:line:column for negative or infinite values
SpectralDistribution distribution_of(BuildContext& context, const SpectrumValue& value,
                                     ColorMeaning meaning, const ParameterList& list,
                                     std::string_view name);

/// The file that a parameter of type string names: as it stands, beside the file that the parameter
/// stands in, or beside the main file, whichever exists. It is kept in BuildContext::files.
/// @throws Error with file:line:column if there is none
std::filesystem::path file_of(BuildContext& context, const ParameterList& list,
                              std::string_view name);

/// The image that a statement names, in sRGB; pixels that can't be used are treated as
/// BuildOptions::invalid says.
/// @throws Error with file:line:column
Image read_scene_image(BuildContext& context, const std::string& path,
                       const SourceLocation& location);

/// Calls a function and puts file:line:column before the message of an Error that it throws.
template <class Function>
auto at_location(const SourceLocation& location, Function function) {
  try {
    return function();
  } catch (const Error& error) {
    const std::string text = error.what();
    const std::string text_location = to_string(location);
    if (text.compare(0, location.file->size() + 1, *location.file + ":") == 0) throw;
    throw Error(text_location + ": " + text);
  }
}

}  // namespace freepath
