#include "freepath/transport/end_scattering.h"

#include <array>

#include "freepath/base/random.h"
#include "freepath/base/vector.h"
#include "freepath/transport/ray_medium.h"

namespace freepath {
namespace {

/// A component of a RayMedium and its scattering coefficients over the probability of its choice.
struct DrawnComponent {
  int component = -1;  ///< -1: nothing scatters.
  double density_over_probability = 0;
};

/// Draws a component by the sum of its scattering coefficients over the channels.
DrawnComponent draw_component(const RayMedium& medium, const RayMedium::Densities& densities,
                              int channels, RandomStream& random) {
  RayMedium::Densities weights{};
  double sum = 0;
  int last = -1;
  for (int k = 0; k < medium.component_count(); ++k) {
    for (int c = 0; c < channels; ++c) {
      weights[k] += densities[k] * double{medium.component(k).sigma_s[c]};
    }
    sum += weights[k];
    if (weights[k] > 0) last = k;
  }
  if (last < 0) return {};
  double left = medium.component_count() > 1 ? random.uniform() * sum : 0;
  int drawn = 0;
  while (drawn < last && !(weights[drawn] > 0 && left < weights[drawn])) left -= weights[drawn++];
  return {drawn, densities[drawn] * sum / weights[drawn]};
}

}  // namespace

void scattering_at_ends_of(const MediumView& view, std::span<const float> /*options*/,
                           const WalkModes& /*modes*/, uint64_t seed, const RayStream& rays,
                           FlightStream& flights, WalkStatistics& statistics) {
  const RayMedium medium(view, view.channels);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    flights.event[i] = Event::kEscape;
    flights.t[i] = rays.t_max[i];
    flights.lookups[i] = 0;
    const RayMedium::Path path = medium.enter(
        Vec3d(rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]),
        Vec3d(rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]), rays.t_max[i]);
    const double t = rays.t_max[i] - path.begin;
    if (!(path.length > 0) || path.length < t) continue;
    RandomStream random(seed, rays.pixel[i], rays.sample[i], rays.stream[i]);
    const RayMedium::Densities densities = medium.densities(path, t, random);
    flights.lookups[i] = static_cast<uint32_t>(medium.component_count());
    statistics.lookups += flights.lookups[i];
    const DrawnComponent drawn = draw_component(medium, densities, view.channels, random);
    if (drawn.component < 0) continue;
    const ComponentView& component = medium.component(drawn.component);
    flights.event[i] = Event::kScatter;
    flights.component[i] = static_cast<uint8_t>(medium.number(drawn.component));
    for (int c = 0; c < view.channels; ++c) {
      flights.weight[c][i] =
          static_cast<float>(drawn.density_over_probability * component.sigma_s[c]);
    }
  }
}

}  // namespace freepath
