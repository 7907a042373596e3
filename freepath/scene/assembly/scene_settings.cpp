#include "freepath/scene/assembly/scene_settings.h"

#include "freepath/transport/auto_tracker.h"

namespace freepath {

RenderSettings settle_settings(const BuiltScene& built, const RenderWishes& wishes,
                               RenderSettings settings) {
  const PictureSettings& picture = built.picture;
  settings.samples = wishes.samples.value_or(settings.time_limit > 0 ? 0 : picture.samples);
  settings.max_scatterings = wishes.max_scatterings.value_or(picture.max_scatterings);
  WalkSettings& walk = settings.walk;
  walk.seed = wishes.seed.value_or(picture.seed);
  walk.tracker = wishes.tracker.value_or(picture.tracker);
  if (walk.tracker.empty() || is_automatic(walk.tracker)) {
    walk.tracker = standard_tracker(built.scene);
  }
  walk.tracker = to_string(parse_method(walk.tracker, tracker_infos()), tracker_infos());
  settings.chooses_transmittance = !wishes.transmittance && picture.transmittance.empty();
  walk.transmittance = wishes.transmittance.value_or(
      picture.transmittance.empty() ? "ratio" : picture.transmittance);
  walk.transmittance =
      to_string(parse_method(walk.transmittance, transmittance_infos()), transmittance_infos());
  walk.interpolation =
      wishes.interpolation.value_or(picture.interpolation.value_or(walk.interpolation));
  settings.buckets = picture.buckets;
  settings.crop = wishes.crop ? wishes.crop : picture.crop;
  settings.layers = wishes.layers.value_or(picture.all_layers ? LayerSet::all() : settings.layers);
  return settings;
}

}  // namespace freepath
