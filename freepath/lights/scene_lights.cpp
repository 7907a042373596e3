#include "freepath/lights/scene_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>
#include <variant>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/lights/photometry.h"

namespace freepath {
namespace {

/// Bilinear interpolant at (u, v), continued by the pixels of the edge; v = 0 is the last row.
Vec3f image_colour(const std::vector<Vec3f>& colours, int width, int height, float u, float v) {
  const float x = std::clamp(u, 0.0F, 1.0F) * static_cast<float>(width) - 0.5F;
  const float y = (1.0F - std::clamp(v, 0.0F, 1.0F)) * static_cast<float>(height) - 0.5F;
  const int left = static_cast<int>(x + 1.0F) - 1;  // rounds down, as x is at least -0.5
  const int above = static_cast<int>(y + 1.0F) - 1;
  const auto at = [&](int column, int row) {
    return colours[static_cast<std::size_t>(std::clamp(row, 0, height - 1)) * width +
                   std::clamp(column, 0, width - 1)];
  };
  const float fx = x - static_cast<float>(left);
  const float fy = y - static_cast<float>(above);
  return (at(left, above) * (1.0F - fx) + at(left + 1, above) * fx) * (1.0F - fy) +
         (at(left, above + 1) * (1.0F - fx) + at(left + 1, above + 1) * fx) * fy;
}

}  // namespace

SceneLights::SceneLights(SceneLightsDescription description, const SpectrumTable& table) {
  const Vec3d origin = description.origin;
  for (LightDescription& light : description.lights) {
    std::visit(
        [&](auto& one) {
          using Kind = std::decay_t<decltype(one)>;
          if constexpr (std::is_same_v<Kind, DistantLight>) {
            add(one, table);
          } else if constexpr (std::is_constructible_v<PunctualLight, const Kind&, const Vec3d&,
                                                       const SpectrumTable&>) {
            punctual_.emplace_back(one, origin, table);
          } else if constexpr (std::is_same_v<Kind, EnvironmentLight> ||
                               std::is_same_v<Kind, SunLight>) {
            infinite_.add(std::move(one));
          } else if constexpr (std::is_same_v<Kind, ImageInfiniteLight>) {
            infinite_.add(std::move(one), origin);
          } else {
            infinite_.add(one, origin, table);
          }
        },
        light);
  }
  infinite_.finish();
  for (const PunctualLight& light : punctual_) within_.push_back(light.bounds());
  const std::vector<LightBounds> areas = add_area_lights(description, table);
  within_.insert(within_.end(), areas.begin(), areas.end());
  chooser_ = LightSampler(within_);
  set_shares();
}

void SceneLights::set_shares() {
  for (const Distant& light : distant_) distant_illuminance_ += light.share;
  for (Distant& light : distant_) {
    light.share = static_cast<float>(light.share / distant_illuminance_);
  }
  const bool infinite = infinite_.is_drawn();
  const bool distant = !distant_.empty();
  const bool within = !chooser_.is_dark();
  const int kinds = int{infinite} + int{distant} + int{within};
  if (kinds == 0) return;
  const float share = 1.0F / static_cast<float>(kinds);
  infinite_share_ = infinite ? share : 0;
  distant_share_ = distant ? share : 0;
  within_share_ = within ? share : 0;
}

void SceneLights::add(const DistantLight& light, const SpectrumTable& table) {
  const LightFrame frame(light.light_to_world, light.name);  // which checks the transform
  Vec3d towards;
  light.light_to_world.multDirMatrix(light.from - light.to, towards);
  if (!(towards.length() > 0)) fail("{}: it is directed to where it comes from", light.name);
  const SpectralDistribution& spectrum = table.spectrum(light.radiance);
  const double factor = light_factor(spectrum, light.scale, light.illuminance, 1, light.name);
  const double illuminance = factor * brightness(spectrum);
  if (!(illuminance > 0)) return;
  distant_.push_back({Vec3f(towards.normalized()), light.radiance, static_cast<float>(factor),
                      static_cast<float>(illuminance), light.distance});
}

SceneLights::Emission SceneLights::make_emission(const AreaEmission& description) {
  Emission emission;
  emission.radiance = description.radiance;
  emission.two_sided = description.two_sided;
  if (description.image) {
    const std::string name = description.name + ": " + description.image->name;
    emission.width = description.image->pixels.width;
    emission.height = description.image->pixels.height;
    emission.colours = light_colours(description.image->pixels, name);
    if (emission.colours.empty()) fail("{}: the image is empty", name);
  }
  return emission;
}

std::vector<LightBounds> SceneLights::add_area_lights(const SceneLightsDescription& description,
                                                      const SpectrumTable& table) {
  const Vec3d weights = luminance_weights(rgb_color_space("srgb"));
  std::vector<double> means;  // luminance of each emission's image
  for (const AreaEmission& emission : description.emissions) {
    emissions_.push_back(make_emission(emission));
    double sum = 0;
    for (const Vec3f& colour : emissions_.back().colours) sum += weights.dot(Vec3d(colour));
    means.push_back(sum /
                    std::max<double>(1, static_cast<double>(emissions_.back().colours.size())));
  }
  std::vector<LightBounds> all;
  for (const AreaLight& light : description.area_lights) {
    if (light.emission >= emissions_.size()) {
      fail("area light {}: there is no emission {}", areas_.size(), light.emission);
    }
    if (!light.geometry) fail("area light {}: it has no geometry", areas_.size());
    const AreaEmission& emission = description.emissions[light.emission];
    const SpectralDistribution& spectrum = table.spectrum(emission.radiance);
    const bool has_image = emission.image.has_value();
    const double mean = has_image ? means[light.emission] : brightness(spectrum);
    const double sides = emission.two_sided ? 2 : 1;
    const double plain = has_image ? light_factor(emission.scale, {}, 0, emission.name)
                                   : light_factor(spectrum, emission.scale, {}, 0, emission.name);
    const auto index = static_cast<uint32_t>(areas_.size());
    areas_.push_back({light.geometry, light.emission, static_cast<uint32_t>(parts_.size()),
                      light.reversed, light.invisible});
    for (uint32_t part = 0; part < light.geometry->part_count(); ++part) {
      const EmitterBounds bounds = light.geometry->bounds(part);
      const double spread = sides * std::numbers::pi * bounds.area;  // [m² sr]
      double factor = plain;
      // A triangle without area emits nothing, whatever power it was to have.
      if (emission.power && bounds.area > 0) {
        factor =
            has_image
                ? light_factor(emission.scale, emission.power, spread * mean, emission.name)
                : light_factor(spectrum, emission.scale, emission.power, spread, emission.name);
      }
      parts_.push_back({index, static_cast<float>(factor)});
      all.push_back({.box = bounds.box,
                     .normals = {light.reversed ? -bounds.axis : bounds.axis, bounds.cosine_spread},
                     .cosine_reach = 0,
                     .two_sided = emission.two_sided,
                     .power = factor * spread * mean});
    }
  }
  return all;
}

SampledSpectrum SceneLights::radiance(const Part& part, const Vec3f& normal, float u, float v,
                                      const Vec3f& towards, const SpectrumValues& values) const {
  const Area& area = areas_[part.area];
  const Emission& emission = emissions_[area.emission];
  const float cosine = normal.dot(towards);
  if (!emission.two_sided && (area.reversed ? cosine >= 0 : cosine <= 0)) return {};
  if (emission.colours.empty()) return values[emission.radiance] * part.scale;
  return values.illuminant(image_colour(emission.colours, emission.width, emission.height, u, v)) *
         part.scale;
}

SampledSpectrum SceneLights::emitted(uint32_t light, const SurfacePoint& point,
                                     const Vec3f& towards, const SpectrumValues& values) const {
  const Part& part = parts_[areas_[light].first_part + point.primitive];
  return radiance(part, point.normal, point.u, point.v, towards, values);
}

LightSeen SceneLights::hit(const Vec3f& from, uint32_t light, const SurfacePoint& point,
                           const SpectrumValues& values) const {
  const Area& area = areas_[light];
  const uint32_t part = area.first_part + point.primitive;
  LightSeen seen;
  seen.radiance =
      radiance(parts_[part], point.normal, point.u, point.v, from - point.position, values);
  const float choice = chooser_.probability(from, static_cast<uint32_t>(punctual_.size()) + part);
  if (choice > 0) seen.pdf = within_share_ * choice * area.geometry->pdf(from, point);
  return seen;
}

LightSample SceneLights::sample_distant(const SpectrumValues& values, float u) const {
  std::size_t chosen = 0;
  while (chosen + 1 < distant_.size() && u >= distant_[chosen].share) {
    u -= distant_[chosen++].share;
  }
  const Distant& light = distant_[chosen];
  LightSample draw;
  draw.direction = light.towards;
  draw.distance = light.distance;
  draw.radiance = values[light.radiance] * light.scale;
  draw.pdf = light.share;
  draw.delta = true;
  return draw;
}

std::optional<SceneLights::OnlyLight> SceneLights::only_light() const {
  if (distant_share_ == 1 && distant_.size() == 1) {
    return OnlyLight{distant_[0].towards, distant_[0].distance, 1, nullptr};
  }
  const Sun* const sun = infinite_share_ == 1 ? infinite_.only_sun() : nullptr;
  if (sun == nullptr) return std::nullopt;
  return OnlyLight{sun->direction(), LightSample().distance, sun->pdf(), &sun->disc()};
}

SampledSpectrum SceneLights::only_radiance(const SpectrumValues& values) const {
  if (distant_share_ == 1) return values[distant_[0].radiance] * distant_[0].scale;
  return infinite_.only_radiance(values);
}

LightSample SceneLights::sample_within(const Vec3f& position, const SpectrumValues& values,
                                       float u0, float u1, float u2) const {
  const LightChoice choice = chooser_.choose(position, u2);
  if (choice.probability == 0) return {};
  LightSample draw = sample_of(choice.light, position, values, u0, u1);
  draw.pdf *= choice.probability;
  return draw;
}

LightSample SceneLights::sample_of(uint32_t light, const Vec3f& position,
                                   const SpectrumValues& values, float u0, float u1) const {
  LightSample draw;
  if (light < punctual_.size()) {
    draw = punctual_[light].sample(position, values);
    draw.within = light;
    return draw;
  }
  const auto index = light - static_cast<uint32_t>(punctual_.size());
  const Part& part = parts_[index];
  const Area& area = areas_[part.area];
  const EmitterPoint point = area.geometry->sample(index - area.first_part, position, u0, u1);
  const Vec3f towards = point.position - position;
  const float distance = towards.length();
  if (!(point.pdf > 0 && distance > 0)) return draw;
  draw.direction = towards * (1.0F / distance);
  draw.distance = distance;
  draw.radiance = radiance(part, point.normal, point.u, point.v, -draw.direction, values);
  draw.pdf = point.pdf;
  draw.delta = area.invisible;
  draw.area = {part.area, index - area.first_part, point.normal, point.u, point.v};
  draw.within = light;
  return draw;
}

LightSample SceneLights::sample(const Vec3f& position, const SpectrumValues& values, float u0,
                                float u1, float u2) const {
  LightSample draw;
  float share = 0;
  float above = u2 - infinite_share_;
  if (above < 0) {
    share = infinite_share_;
    draw = infinite_.sample(position, values, u0, u1, std::min(u2 / share, kOneMinusEpsilon));
  } else if (above < distant_share_ || (distant_share_ > 0 && within_share_ == 0)) {
    share = distant_share_;
    draw = sample_distant(values, std::min(above / share, kOneMinusEpsilon));
  } else if (within_share_ > 0) {
    share = within_share_;
    above -= distant_share_;
    draw = sample_within(position, values, u0, u1, std::min(above / share, kOneMinusEpsilon));
  }
  draw.pdf *= share;
  return draw;
}

}  // namespace freepath
