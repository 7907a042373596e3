#include "freepath/lights/infinite_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "freepath/lights/photometry.h"

namespace freepath {
namespace {

/// Cells of a portal's grid along an axis, for an image.
int portal_cells(int image_size) { return std::clamp(image_size, 64, 1024); }

/// Illuminance of a surface whose normal is `up`, by the midpoint rule on the octahedral map.
template <class Environment>
double illuminance_of(const Environment& environment, const Vec3f& up, const Vec3d& weights,
                      int image_size) {
  // Some points for each pixel, even if there are few.
  constexpr int kLeast = 512;
  const int size = image_size * std::max(1, kLeast / image_size);
  double sum = 0;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const Vec3f d =
          direction_from_octahedral({(static_cast<float>(column) + 0.5F) / static_cast<float>(size),
                                     (static_cast<float>(row) + 0.5F) / static_cast<float>(size)});
      const double cosine = d.dot(up);
      if (cosine <= 0) continue;
      sum += cosine * weights.dot(Vec3d(environment.evaluate(d).radiance));
    }
  }
  return 4 * std::numbers::pi * sum / (static_cast<double>(size) * size);
}

/// An image is drawn if that makes the variance so many times smaller: PixelDraws::gain_above_mean.
/// A path whose scatterings draw takes some three times as long as one whose don't, and its
/// transmittances have variances of their own; a cloud under nine skies breaks even here, and
/// beside a sun, which is drawn in any case and loses draws to the image, at twice as much.
constexpr double kLeastGain = 8;
constexpr double kLeastGainBesideSun = 16;

Image without_negative(Image image) {
  for (float& value : image.values) value = value < 0 ? 0 : value;
  return image;
}

}  // namespace

void InfiniteLights::add(const ConstantInfiniteLight& light, const Vec3d& origin,
                         const SpectrumTable& table) {
  const SpectralDistribution& spectrum = table.spectrum(light.radiance);
  const double factor =
      light_factor(spectrum, light.scale, light.illuminance, std::numbers::pi, light.name);
  const double importance = 4 * std::numbers::pi * factor * brightness(spectrum);
  if (importance <= 0) return;
  Light result{Constant{light.radiance}, static_cast<float>(factor)};
  if (light.portal) {
    result.portal.emplace(
        *light.portal, origin, [](const Vec3f&) { return 1.0; }, portal_cells(0), light.name);
  }
  result.importance = importance;
  lights_.push_back(std::move(result));
}

void InfiniteLights::add(ImageInfiniteLight light, const Vec3d& origin) {
  const Vec3d weights = luminance_weights(rgb_color_space("srgb"));
  const std::string name = light.name + ": " + light.image.name;
  const LightFrame frame(light.light_to_world, light.name);
  Radiance radiance;
  double fluence = 0;
  double illuminance = 0;
  const int size = light.image.pixels.width;
  if (light.mapping == SphereMapping::kOctahedral) {
    OctahedralEnvironment image(light.image.pixels, Vec3f(weights), name);
    fluence = image.fluence();
    if (light.illuminance) illuminance = illuminance_of(image, {0, 0, 1}, weights, size);
    radiance = std::move(image);
  } else {
    ImageEnvironment image(without_negative(std::move(light.image.pixels)), UpAxis::kY, name);
    fluence = weights.dot(Vec3d(image.fluence()));
    if (light.illuminance) illuminance = illuminance_of(image, {0, 1, 0}, weights, size);
    radiance = std::move(image);
  }
  const double factor = light_factor(light.scale, light.illuminance, illuminance, name);
  if (!(fluence * factor > 0)) return;
  Light result{std::move(radiance), static_cast<float>(factor), frame};
  if (light.portal) {
    const auto brightness = [&](const Vec3f& direction) {
      const Vec3f d = frame.to_light(direction).normalized();
      const auto* const octahedral = std::get_if<OctahedralEnvironment>(&result.radiance);
      return weights.dot(Vec3d(
          octahedral ? octahedral->evaluate(d).radiance
                     : std::get_if<ImageEnvironment>(&result.radiance)->evaluate(d).radiance));
    };
    result.portal.emplace(*light.portal, origin, brightness, portal_cells(size), light.name);
  }
  result.importance = fluence * factor;
  lights_.push_back(std::move(result));
}

void InfiniteLights::add(EnvironmentLight light) {
  const double factor = light_factor(light.scale, {}, 0, light.name);
  const double fluence =
      luminance_weights(rgb_color_space("srgb")).dot(Vec3d(light.environment.fluence()));
  if (!(fluence * factor > 0)) return;
  Light result{std::move(light.environment), static_cast<float>(factor)};
  result.importance = fluence * factor;
  lights_.push_back(std::move(result));
}

void InfiniteLights::add(const SunLight& light) {
  const double factor = light_factor(light.scale, {}, 0, light.name);
  const double irradiance =
      luminance_weights(rgb_color_space("srgb")).dot(Vec3d(light.sun.irradiance()));
  if (!(irradiance * factor > 0)) return;
  Light result{light.sun, static_cast<float>(factor)};
  result.importance = irradiance * factor;
  lights_.push_back(std::move(result));
}

void InfiniteLights::choose_draws(Light& light) const {
  if (light.portal) return;
  const bool has_sun = std::any_of(lights_.begin(), lights_.end(), [](const Light& other) {
    return std::holds_alternative<Sun>(other.radiance);
  });
  const auto choose = [&](auto& image) {
    light.is_drawn =
        image.draws().gain_above_mean() >= (has_sun ? kLeastGainBesideSun : kLeastGain);
    if (light.is_drawn) image.set_draws(image.draws().above_mean());
  };
  if (std::holds_alternative<Constant>(light.radiance)) {
    light.is_drawn = false;
  } else if (auto* const image = std::get_if<ImageEnvironment>(&light.radiance)) {
    choose(*image);
  } else if (auto* const image = std::get_if<OctahedralEnvironment>(&light.radiance)) {
    choose(*image);
  }
}

void InfiniteLights::finish() {
  // A light counts by the integral of its radiance over all directions; but a fainter one may count
  // for more where the others are in shadow.
  constexpr double kEvenPart = 0.2;
  double sum = 0;
  double drawn = 0;
  for (Light& light : lights_) {
    choose_draws(light);
    fluence_ += light.importance;
    if (!light.is_drawn) continue;
    sum += light.importance;
    ++drawn;
  }
  is_drawn_ = drawn > 0;
  if (std::count_if(lights_.begin(), lights_.end(), is_plain_image) == 1) {
    only_image_ = std::find_if(lights_.begin(), lights_.end(), is_plain_image) - lights_.begin();
  }
  for (Light& light : lights_) {
    if (!light.is_drawn) continue;
    light.share = static_cast<float>((1 - kEvenPart) * light.importance / sum + kEvenPart / drawn);
  }
}

const InfiniteLights::Light* InfiniteLights::only_drawn() const {
  const Light* only = nullptr;
  for (const Light& light : lights_) {
    if (!light.is_drawn) continue;
    if (only != nullptr) return nullptr;
    only = &light;
  }
  return only;
}

const Sun* InfiniteLights::only_sun() const {
  const Light* const only = only_drawn();
  return only == nullptr ? nullptr : std::get_if<Sun>(&only->radiance);
}

SampledSpectrum InfiniteLights::only_radiance(const SpectrumValues& values) const {
  const Light& sun = *only_drawn();
  return radiance_of(sun, {std::get_if<Sun>(&sun.radiance)->radiance(), 0}, values);
}

SampledSpectrum InfiniteLights::radiance_of(const Light& light, const LightValue& value,
                                            const SpectrumValues& values) {
  if (const auto* const constant = std::get_if<Constant>(&light.radiance)) {
    return values[constant->radiance] * light.scale;
  }
  return values.illuminant(value.radiance) * light.scale;
}

LightValue InfiniteLights::plain_value(const Light& light, const Vec3f& towards) {
  if (const auto* const image = std::get_if<ImageEnvironment>(&light.radiance)) {
    return image->evaluate(towards);
  }
  if (const auto* const sun = std::get_if<Sun>(&light.radiance)) {
    return sun->disc().contains(towards) ? LightValue{sun->radiance(), sun->pdf()} : LightValue{};
  }
  if (std::holds_alternative<Constant>(light.radiance)) return {{}, kUniformSpherePdf};
  return std::get_if<OctahedralEnvironment>(&light.radiance)->evaluate(towards);
}

void InfiniteLights::add_seen(const Light& light, const Vec3f& from, const Vec3f& direction,
                              const SpectrumValues& values, LightSeen& all,
                              const LightValue* known) {
  float portal_pdf = 0;
  if (light.portal) {
    portal_pdf = light.portal->pdf(from, direction);
    if (portal_pdf == 0) return;
  }
  Vec3f towards = direction;
  float solid_angle = 1;
  if (light.frame) {
    towards = light.frame->to_light(direction);
    const float length = towards.length();
    towards *= 1.0F / length;
    solid_angle = light.frame->light_solid_angle(length);
  }
  const LightValue value = known != nullptr ? *known : plain_value(light, towards);
  // Most rays miss a sun's disc.
  if (value.pdf == 0 && std::holds_alternative<Sun>(light.radiance)) return;
  (light.is_drawn ? all.radiance : all.undrawn) += radiance_of(light, value, values);
  all.pdf += light.share * (light.portal ? portal_pdf : value.pdf * solid_angle);
}

LightSeen InfiniteLights::evaluate(const Vec3f& from, const Vec3f& direction,
                                   const SpectrumValues& values, const LightValue* in_image) const {
  LightSeen all;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    add_seen(lights_[i], from, direction, values, all, i == only_image_ ? in_image : nullptr);
  }
  return all;
}

const ImageEnvironment* InfiniteLights::only_image() const {
  if (only_image_ == SIZE_MAX) return nullptr;
  return std::get_if<ImageEnvironment>(&lights_[only_image_].radiance);
}

LightDirection InfiniteLights::sample_plain(const Light& light, float u0, float u1) {
  if (const auto* const octahedral = std::get_if<OctahedralEnvironment>(&light.radiance)) {
    return octahedral->sample(u0, u1);
  }
  if (const auto* const image = std::get_if<ImageEnvironment>(&light.radiance)) {
    return image->sample(u0, u1);
  }
  const auto& sun = *std::get_if<Sun>(&light.radiance);  // all else is drawn through portals alone
  return {sun.disc().sample(u0, u1), {sun.radiance(), sun.pdf()}};
}

LightSample InfiniteLights::sample(const Vec3f& from, const SpectrumValues& values, float u0,
                                   float u1, float u2) const {
  LightSample draw;
  const Light* chosen = nullptr;
  for (const Light& light : lights_) {
    if (light.share == 0) continue;
    chosen = &light;
    if (u2 < light.share) break;
    u2 -= light.share;
  }
  if (chosen == nullptr) return draw;
  LightSeen seen;
  if (chosen->portal) {
    const std::optional<Vec3f> direction = chosen->portal->sample(from, u0, u1);
    if (!direction) return draw;
    draw.direction = *direction;
    add_seen(*chosen, from, draw.direction, values, seen);
  } else {
    const LightDirection drawn = sample_plain(*chosen, u0, u1);
    draw.direction = drawn.direction;
    float solid_angle = 1;
    if (chosen->frame) {
      const Vec3f world = chosen->frame->to_world(drawn.direction);
      const float per_length = 1.0F / world.length();
      draw.direction = world * per_length;
      solid_angle = chosen->frame->light_solid_angle(per_length);
    }
    seen.radiance = radiance_of(*chosen, drawn.light, values);
    seen.pdf = chosen->share * drawn.light.pdf * solid_angle;
  }
  for (const Light& light : lights_) {
    if (&light != chosen && light.is_drawn) add_seen(light, from, draw.direction, values, seen);
  }
  draw.radiance = seen.radiance;
  draw.pdf = seen.pdf;
  return draw;
}

}  // namespace freepath
