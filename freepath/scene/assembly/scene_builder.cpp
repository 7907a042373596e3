#include "freepath/scene/assembly/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/scene/assembly/build_lights.h"
#include "freepath/scene/assembly/build_materials.h"
#include "freepath/scene/assembly/build_media.h"
#include "freepath/scene/assembly/build_shapes.h"
#include "freepath/scene/assembly/build_textures.h"
#include "freepath/scene/assembly/periodic_scene.h"
#include "freepath/scene/assembly/region_simplifier.h"
#include "freepath/scene/pbrt/parser.h"

namespace freepath {
namespace {

/// Rays know places in single precision, and products of coordinates have to fit it too.
constexpr double kFarthest = 1e15;

void check_extent(const PbrtScene& pbrt, const Box3d& box, const char* what) {
  for (int axis = 0; axis < 3; ++axis) {
    const double farthest = std::max(std::abs(box.min[axis]), std::abs(box.max[axis]));
    if (farthest < kFarthest) continue;
    fail(
        "{}: {} reach to {:.3g} along {}, and nothing further than {:.0e} can be rendered: scale "
        "the "
        "scene",
        pbrt.file, what, farthest, "xyz"[axis], kFarthest);
  }
}

/// Near what is seen: the middle of the media that have bounds, else of everything.
Vec3d origin_of(const PathScene& scene, const Box3d& extent) {
  Box3d box;
  for (const SceneMedium& medium : scene.media) {
    if (medium.bounds().size().length() < 2 * extent.size().length()) {
      box.extendBy(medium.bounds());
    }
  }
  return (box.isEmpty() ? extent : box).center();
}

/// Lets parallel light begin at twice the radius of the scene from what it shines on, as pbrt does,
/// if homogeneous fog is around the camera: where it has no end, nothing would come through. Where
/// it has one, that lies nearer.
/// @param standing around all shapes and all media with bounds of their own
void bring_near_in_fog(const PathScene& scene, const Box3d& standing,
                       std::vector<LightDescription>& lights) {
  const bool is_in_fog =
      std::ranges::any_of(scene.camera_media.entries(), [&](const MediaSet::Entry& entry) {
        return scene.media[static_cast<std::size_t>(entry.medium)].is_homogeneous();
      });
  if (!is_in_fog || standing.isEmpty()) return;
  for (LightDescription& light : lights) {
    if (auto* const distant = std::get_if<DistantLight>(&light)) {
      distant->distance = static_cast<float>(standing.size().length());
    }
  }
}

/// Adds lights from outside of the file, which take the place of some of its own.
void add_surroundings(const Surroundings& surroundings, std::vector<LightDescription>& lights,
                      SpectrumTable& table) {
  if (surroundings.environment) {
    std::erase_if(lights, [](const LightDescription& light) {
      return std::holds_alternative<ConstantInfiniteLight>(light) ||
             std::holds_alternative<ImageInfiniteLight>(light);
    });
  }
  for (LightDescription& light : to_lights(surroundings, table)) lights.push_back(std::move(light));
}

/// Remembers what was read.
class RecordingReader final : public FileReader {
 public:
  bool exists(const std::filesystem::path& path) const override { return disk_.exists(path); }
  std::string read(const std::filesystem::path& path, std::size_t limit) const override {
    files_.push_back(path);
    return disk_.read(path, limit);
  }
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  DiskFileReader disk_;
  mutable std::vector<std::filesystem::path> files_;
};

/// Texture coordinates where nothing looks at them.
void leave_out_uv(const TextureTable& textures, BuiltShapes& built) {
  const bool has_images =
      std::any_of(built.emissions.begin(), built.emissions.end(),
                  [](const AreaEmission& one) { return one.image.has_value(); });
  if (has_images || textures.float_count() + textures.spectrum_count() > 0) return;
  for (SurfaceShape& shape : built.surfaces.shapes) shape.needs_uv = false;
  for (SurfaceShape& shape : built.invisible) shape.needs_uv = false;
  for (auto& group : built.surfaces.groups) {
    for (SurfaceShape& shape : group) shape.needs_uv = false;
  }
}

}  // namespace

BuiltScene build_scene(const PbrtScene& pbrt, Diagnostics& diagnostics,
                       const BuildOptions& options) {
  BuiltScene built;
  PathScene& scene = built.scene;
  scene.spectra = std::make_unique<SpectrumTable>(rgb_color_space(name_of(pbrt.color_space)));
  BuildContext context{pbrt, diagnostics, scene};
  context.options = options;
  FilmSize size;
  built.picture = build_picture(context, size);
  scene.exposure_scale = built.picture.exposure_scale;
  scene.white_balance = Imath::M33f(built.picture.white_balance);
  name_media(context);
  build_camera(context, options.size.value_or(size));
  const Vec3d stood = scene.camera->position();  // where the file puts it, and says what is around
  build_textures(context);
  build_materials(context);
  BuiltShapes shapes = build_shapes(context);
  leave_out_uv(scene.textures, shapes);
  Box3d standing =
      extent_of(shapes.surfaces);  // and, once they are built, media with bounds of their own
  if (options.camera) scene.camera = changed_camera(*options.camera, *scene.camera, standing);
  Box3d extent = standing;
  extent.extendBy(stood);
  extent.extendBy(scene.camera->position());
  if (options.sides.extents) {  // fog without a boundary fills the domain
    for (int axis = 0; axis < 3; ++axis) {
      if (!options.sides.axes[axis]) continue;
      extent.min[axis] = std::min(extent.min[axis], options.sides.extents->min[axis]);
      extent.max[axis] = std::max(extent.max[axis], options.sides.extents->max[axis]);
    }
  }
  check_extent(pbrt, extent, "shapes, the camera or the domain");
  build_media(context, extent);
  for (const SceneMedium& medium : scene.media) {
    check_extent(pbrt, medium.bounds(), ("the medium '" + medium.name() + "'").c_str());
    if (!medium.is_homogeneous()) standing.extendBy(medium.bounds());
  }
  scene.origin = origin_of(scene, extent);
  scene.textures.set_origin(scene.origin);
  scene.shapes = shapes.shapes;
  if (options.ground) {
    add_ground(*options.ground, standing, scene.camera->position(), scene, shapes.surfaces);
  }
  SceneLightsDescription lights;
  lights.lights = build_lights(context);
  add_surroundings(options.surroundings, lights.lights, *scene.spectra);
  lights.emissions = shapes.emissions;
  lights.area_lights = build_area_lights(shapes, scene.origin);
  lights.origin = scene.origin;
  if (options.sides.any()) {
    check_lights_of_domain(lights);
  } else if (!options.ground) {  // which reaches further than all else, and is shaded from afar
    bring_near_in_fog(scene, standing, lights.lights);
  }
  scene.lights.emplace(std::move(lights), *scene.spectra);
  const SurfaceScene surfaces = options.sides.any() ? shapes.surfaces : SurfaceScene();
  simplify_regions(std::move(shapes.surfaces), scene, stood);
  if (options.sides.any()) {
    make_periodic(scene, options.sides, standing, surfaces, options.super_voxel);
  }
  built.files = std::move(context.files);
  return built;
}

BuiltScene load_scene(const std::filesystem::path& file, Diagnostics& diagnostics,
                      const BuildOptions& options) {
  const RecordingReader reader;
  BuiltScene built = build_scene(parse_pbrt_file(file, diagnostics, reader), diagnostics, options);
  built.files.insert(built.files.begin(), reader.files().begin(), reader.files().end());
  return built;
}

}  // namespace freepath
