#pragma once
/// @file Rendering what the options ask for: one picture, or the frames of a sequence.

#include <optional>
#include <vector>

#include "apps/freepath/film_options.h"
#include "apps/freepath/frames.h"
#include "apps/freepath/render_volumes.h"
#include "apps/freepath/run_plan.h"
#include "freepath/scene/volume_camera.h"
#include "freepath/scene/volume_scene.h"

namespace freepath::program {

/// What all pictures of a command have in common.
struct RenderPlan {
  RenderSettings settings;          ///< Of frames, their number is added to the seed.
  std::vector<VolumePlan> volumes;  ///< Each picture has files of its own for them.
  FilmPlan film;
  CameraOptions camera;
  UpAxis up = UpAxis::kY;
  std::optional<Ground> ground;  ///< Without a height, that of the first frame.
  Surroundings surroundings;
  ColorMode color = ColorMode::kRgb;
  int super_voxel = 0;
  PeriodicSides sides;
  PictureLook look;
  RunPlan run;
};

/// Renders and writes a picture; Ctrl-C while it is rendered ends it early.
/// @throws Error as the loaders, the renderer and the writers, and for a picture of nothing
void render_picture(const RenderPlan& plan, const PictureFiles& files);

/// Renders and writes the frames one after the other, with a line on each. All are seen by the
/// camera of the first one. Of a frame that fails is told why, and the others are rendered. Ctrl-C
/// ends the frame under way early and the sequence with it, and what is done is told.
/// @throws Error that names the frames that failed
void render_frames(const RenderPlan& plan, const std::vector<PictureFiles>& frames);

}  // namespace freepath::program
