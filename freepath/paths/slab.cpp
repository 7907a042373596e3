#include "freepath/paths/slab.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/paths/path_scene.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/weight_growth.h"

namespace freepath {
namespace {

constexpr float kLargestBoundScale = 1000;

void check_settings(const SlabSettings& settings) {
  if (!settings.diffuse && !(settings.mu0 > 0 && settings.mu0 <= 1)) {
    fail("mu0 is {}; the cosine of incidence lies in (0, 1], 1 being along the normal",
         settings.mu0);
  }
  if (!(settings.bound_scale >= 1 && settings.bound_scale <= kLargestBoundScale)) {
    fail("the bounds can't be scaled by {}: from 1, tight, to {} is possible", settings.bound_scale,
         kLargestBoundScale);
  }
}

/// E_2, the share of isotropic light that an absorber of this thickness lets through.
double exponential_integral_2(double x) {
  if (x == 0) return 1;
  return std::isinf(x) ? 0 : std::exp(-x) + x * std::expint(-x);
}

/// Refuses trackers whose weights may have an infinite mean square in these layers. The mean square
/// obeys a transfer equation of its own, whose collisions multiply; it is finite where fewer than
/// one follows each. Of isotropic scattering that share is at most 1 - E_2 of half the thickness,
/// in the middle; Henyey and Greenstein's phase function exceeds the isotropic one by at most
/// (1 + |g|)/(1 - |g|)², of others nothing is taken for known.
/// @throws Error that says what to take instead
void check_growth(std::span<const SlabLayer> layers, const SlabMedium& slab,
                  const WalkSettings& walk) {
  const WeightGrowth growth = weight_growth(channels_of(slab.medium, 0), walk);
  if (growth.bounded()) return;
  double tau = 0;
  double albedo = 0;
  double peak = 0;
  for (const SlabLayer& layer : layers) {
    tau += layer.tau;
    albedo = std::max(albedo, layer.albedo);
    const double g = std::abs(layer.g);
    peak = layer.phase ? std::numeric_limits<double>::infinity()
                       : std::max(peak, (1 + g) / ((1 - g) * (1 - g)));
  }
  // What scatters keeps the albedo in its weight, or survives with that probability.
  const double kept = walk.absorption == Absorption::kWeighted ? albedo * albedo : albedo;
  const double loss = growth.per_mean_free_path / growth.per_flight;
  const double share = std::min(1.0, peak * (1 - exponential_integral_2(0.5 * loss * tau)));
  if (kept == 0 || growth.per_flight * kept * share < 1) return;
  fail("{}; the variance may be infinite in these layers", growth.reason);
}

/// The layers as a scene: their medium, and nothing around it.
PathScene make_scene(SlabMedium&& slab) {
  PathScene scene;
  scene.spectra = std::make_unique<SpectrumTable>(rgb_color_space("srgb"));
  const auto add = [&](float coefficient) {
    return scene.spectra->add(double{coefficient}, SpectrumRole::kReflectance);
  };
  std::vector<SceneMediumComponent> components;
  for (const Component& component : slab.medium.components()) {
    SceneMediumComponent& target = components.emplace_back();
    target.sigma_a = add(component.sigma_a[0]);
    target.sigma_s = add(component.sigma_s[0]);
    target.phase = component.phase;
  }
  scene.media.emplace_back("layers", std::make_shared<const Medium>(std::move(slab.medium)),
                           std::move(components));
  scene.camera_media.add(0, 1);
  return scene;
}

FluxMeter make_meter(SlabMedium& slab, const SlabSettings& settings) {
  // As wide as anything: all places of one depth are the same.
  FluxMeter meter(Box3d(Vec3d(0), Vec3d(1, 1, slab.thickness)), 2, false);
  const auto mu = static_cast<float>(settings.mu0);
  if (!settings.diffuse) meter.beam = Vec3f(std::sqrt((1.0F - mu) * (1.0F + mu)), 0, mu);
  meter.has_no_bottom = slab.half_space;
  meter.splits = std::move(slab.splits);
  return meter;
}

}  // namespace

SlabResult trace_slab(std::span<const SlabLayer> layers, const SlabSettings& settings,
                      const FluxProgress& progress) {
  check_settings(settings);
  SlabMedium slab =
      make_slab_medium(layers, settings.super_voxel, settings.diffuse ? 1 : settings.mu0);
  if (settings.bound_scale != 1) slab.medium = slab.medium.with_scaled_bounds(settings.bound_scale);
  WalkSettings walk = settings.walk;
  walk.interpolation = Interpolation::kNearest;
  TrackerChoice choice = settle_tracker(walk.tracker, slab.medium);
  walk.tracker = std::move(choice.tracker);
  check_growth(layers, slab, walk);
  // Weights that grow would split without end.
  if (!weight_growth(channels_of(slab.medium, 0), walk).bounded()) slab.splits.clear();
  FluxSettings flux;
  flux.paths = settings.paths;
  flux.threads = settings.threads;
  flux.batch = settings.batch;
  flux.roulette_threshold = settings.roulette_threshold;
  flux.tells_absorption = false;          // it is all that does not leave
  flux.studies_unbounded_weights = true;  // check_growth knows more of layers
  flux.walk = walk;
  const FluxMeter meter = make_meter(slab, settings);
  const FluxResult fluxes = trace_flux(make_scene(std::move(slab)), meter, flux, progress);
  SlabResult result;
  result.reflectance = fluxes.reflectance.all;
  result.transmittance = fluxes.transmittance.all;
  result.unscattered = fluxes.unscattered.all;
  result.total = fluxes.leaving;
  result.largest_weight = fluxes.largest_weight;
  result.paths = fluxes.paths;
  result.tracker_reason = std::move(choice.reason);
  result.tracker = to_string(parse_method(walk.tracker, tracker_infos()), tracker_infos());
  return result;
}

}  // namespace freepath
