#pragma once
/// @file Rendering the scene of a pbrt file.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/freepath/film_options.h"
#include "apps/freepath/parse.h"
#include "apps/freepath/run_plan.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/renderer.h"
#include "freepath/scene/assembly/scene_builder.h"

namespace freepath::program {

/// What the command line says of a scene; what it does not say, the scene's file decides.
struct ScenePlan {
  std::string file;
  std::vector<std::string> outputs;  ///< None: the film's file name.
  std::string stats;                 ///< May be empty.
  std::optional<uint32_t> samples;
  std::optional<uint64_t> seed;
  std::optional<uint32_t> max_scatterings;
  std::optional<std::string> tracker, transmittance;
  std::optional<Interpolation> interpolation;
  ColorMode color = ColorMode::kSpectral;
  RenderSettings settings;  ///< All else.
  BuildOptions build;
  PictureLook look;
  FilmPlan film;  ///< Its crop goes before the scene's.
  RunPlan run;
};

/// Whether a file is a scene, by its name: *.pbrt or *.pbrt.gz.
bool is_scene_file(const std::string& file);

/// What the command line says of a rendering, else the scene, else what is standard: all but
/// layers.
/// @throws Error for methods that do not exist
RenderSettings settle(const ScenePlan& plan, const BuiltScene& built);

/// Renders and writes the picture of a scene; Ctrl-C while it is rendered ends it early.
/// @throws Error as the parser, the builder, the renderer and the writers
void render_scene_file(const ScenePlan& plan);

}  // namespace freepath::program
