#pragma once
/// @file Options on what a picture is of, for the commands that make pictures.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/freepath/domain_options.h"
#include "apps/freepath/film_options.h"
#include "apps/freepath/render_volumes.h"
#include "freepath/paths/path_scene.h"
#include "freepath/paths/renderer.h"
#include "freepath/scene/assembly/build_context.h"
#include "freepath/scene/volume_camera.h"
#include "freepath/scene/volume_scene.h"

namespace freepath::program {

/// The options as they were typed; read_* turn them into what the library takes.
struct PictureOptions {
  VolumeOptions volumes;
  std::string size = "640x360", color;
  std::string environment, sun;
  int wavelengths = RenderSettings{}.wavelengths;
  double turbidity = SunParameters{}.turbidity;
  std::string up = "y", look_at, camera = "perspective", ground, periodic, domain;
  double fov = CameraOptions{}.fov;
  int super_voxel = 0;
  std::string absorption = "weighted";
  std::vector<std::string> emission;
  uint32_t max_scatterings = 0;  ///< 0: no limit.
  bool all_shadow_rays = false;
  bool no_near_light_lines = false;
  bool no_lobe_splitting = false;
  bool no_light_through_glass = false;
  uint64_t seed = 0;
  int threads = 0;
  std::size_t batch = RenderSettings{}.batch;
  std::string simd = "best";
};

/// Adds all of them: volumes or a scene, size, camera, lights, what paths do and what they run on.
void add_picture_options(CLI::App& command, PictureOptions& options);

/// What to load, where a number given to --emission counts as one given to --le.
std::vector<VolumePlan> read_volumes(const PictureOptions& options);
LightOptions read_lights(const PictureOptions& options);
/// @throws Error, too, for a picture that memory can't hold
CameraOptions read_camera(const PictureOptions& options, const FilmPlan& film);
UpAxis read_up(const PictureOptions& options);
/// Sides that --periodic and --domain make repeat.
PeriodicSides read_sides(const PictureOptions& options);
/// The ground that is asked for, if one is.
std::optional<Ground> read_ground(const PictureOptions& options);
/// Options that change or add to what the file of a scene says.
/// @param warnings gets what there is to say about an image
BuildOptions read_build_options(const CLI::App& command, const PictureOptions& options,
                                std::vector<std::string>& warnings);
/// @param usual the mode where none is given
ColorMode read_color(const PictureOptions& options, ColorMode usual);
Interpolation read_interpolation(const std::string& text);
/// All but samples, time, methods and interpolation, which have their standard values.
RenderSettings read_run_settings(const PictureOptions& options);
/// A method with its options, in one spelling.
std::string read_method(const std::string& text, std::string_view option,
                        std::span<const MethodInfo> infos);
/// The same of --tracker, which may be `auto`.
std::string read_tracker(const std::string& text, std::string_view option);
/// "delta, ratio, ..."
std::string method_names(std::span<const MethodInfo> infos);

/// Whether a scene is asked for.
/// @throws Error for a scene among other files
bool is_scene(const PictureOptions& options);
/// Refuses options that a scene's file has the say in.
void check_scene_options(const CLI::App& command, const PictureOptions& options);
/// Refuses --wavelengths where there are none.
void check_wavelengths(const CLI::App& command, ColorMode color);

}  // namespace freepath::program
