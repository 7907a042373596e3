#include "freepath/lights/punctual_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "freepath/base/error.h"
#include "freepath/base/tangent_frame.h"
#include "freepath/lights/photometry.h"

namespace freepath {
namespace {

double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

/// Solid angle of a rectangle from the axis to (x, y) in the plane at distance 1.
double solid_angle_to(double x, double y) {
  return std::atan(x * y / std::sqrt(1 + x * x + y * y));
}

/// The pixel in which a coordinate in [0, 1] lies.
int pixel_at(float coordinate, int size) {
  return std::clamp(static_cast<int>(coordinate * static_cast<float>(size)), 0, size - 1);
}

Vec3d transform_point(const Vec3d& point, const Matrix4d& matrix) { return point * matrix; }

}  // namespace

void PunctualLight::set_position(const Vec3d& position) {
  position_ = Vec3f(position);
  bounds_.box = Box3f(position_);
}

void PunctualLight::set_spectrum(SpectrumId intensity, double scale,
                                 const std::optional<double>& power, double flux_of_one,
                                 const SpectrumTable& table, const std::string& name) {
  const SpectralDistribution& spectrum = table.spectrum(intensity);
  intensity_ = intensity;
  scale_ = static_cast<float>(light_factor(spectrum, scale, power, flux_of_one, name));
  bounds_.power = flux_of_one * scale_ * brightness(spectrum);
}

PunctualLight::PunctualLight(const PointLight& light, const Vec3d& origin,
                             const SpectrumTable& table)
    : kind_(Kind::kPoint) {
  set_position(transform_point(light.from, light.light_to_world) - origin);
  set_spectrum(light.intensity, light.scale, light.power, 4 * std::numbers::pi, table, light.name);
  bounds_.normals.cosine = -1;
}

PunctualLight::PunctualLight(const SpotLight& light, const Vec3d& origin,
                             const SpectrumTable& table)
    : kind_(Kind::kSpot) {
  const Vec3d axis = light.to - light.from;
  if (!(axis.length() > 0)) fail("{}: it is directed to where it is", light.name);
  const double end = light.cone_angle;
  const double start = light.cone_angle - light.cone_delta_angle;
  if (!(0 < end && end <= 180 && 0 <= start && start <= end)) {
    fail("{}: a cone of {} degrees cannot have an edge of {} degrees", light.name, end,
         light.cone_delta_angle);
  }
  // Only the angle from the axis counts, so that any basis around it will do.
  const TangentFrame basis{Vec3f(axis.normalized())};
  Matrix4d axes;
  for (int i = 0; i < 3; ++i) {
    axes[0][i] = basis.tangent[i];
    axes[1][i] = basis.bitangent[i];
    axes[2][i] = basis.normal[i];
  }
  frame_ = LightFrame(axes * light.light_to_world, light.name);
  set_position(transform_point(light.from, light.light_to_world) - origin);
  cosine_end_ = static_cast<float>(std::cos(radians(end)));
  cosine_start_ = static_cast<float>(std::cos(radians(start)));
  // The mean of the smooth step is 1/2.
  const double flux =
      2 * std::numbers::pi * (1 - 0.5 * (static_cast<double>(cosine_start_) + cosine_end_));
  set_spectrum(light.intensity, light.scale, light.power, flux, table, light.name);
  bounds_.normals.axis = frame_.to_world({0, 0, 1}).normalized();
  bounds_.cosine_reach = cosine_end_ - 1e-3F;
  // A cone that is bent by uneven scales or wider than a half is bounded by all directions.
  bounds_.normals.cosine = frame_.keeps_angles() && bounds_.cosine_reach > 0 ? 1 : -1;
}

PunctualLight::PunctualLight(const GoniometricLight& light, const Vec3d& origin,
                             const SpectrumTable& table)
    : kind_(Kind::kGoniometric) {
  Matrix4d swap;  // y and z
  swap[1][1] = swap[2][2] = 0;
  swap[1][2] = swap[2][1] = 1;
  frame_ = LightFrame(swap * light.light_to_world, light.name);
  set_position(transform_point(Vec3d(0), light.light_to_world) - origin);
  double mean = 1;
  if (light.image) {
    const std::string name = light.name + ": " + light.image->name;
    check_octahedral(light.image->pixels, name);
    width_ = height_ = light.image->pixels.width;
    for (const Vec3f& c : light_colours(light.image->pixels, name)) {
      factors_.push_back((c.x + c.y + c.z) / 3);
    }
    mean = std::accumulate(factors_.begin(), factors_.end(), 0.0) /
           static_cast<double>(factors_.size());
  }
  set_spectrum(light.intensity, light.scale, light.power, 4 * std::numbers::pi * mean, table,
               light.name);
  bounds_.normals.cosine = -1;
}

PunctualLight::PunctualLight(const ProjectionLight& light, const Vec3d& origin,
                             const SpectrumTable& /*table*/)
    : kind_(Kind::kProjection) {
  const Image& image = light.image.pixels;
  const std::string name = light.name + ": " + light.image.name;
  if (image.width < 1 || image.height < 1) fail("{}: the image is empty", name);
  if (!(light.fov > 0 && light.fov < 180)) {
    fail("{}: its field of view is {} degrees; it must lie between 0 and 180", light.name,
         light.fov);
  }
  colours_ = light_colours(image, name);
  width_ = image.width;
  height_ = image.height;
  const double pixel = 2 * std::tan(radians(light.fov) / 2) / std::min(width_, height_);
  half_width_ = static_cast<float>(0.5 * pixel * width_);
  half_height_ = static_cast<float>(0.5 * pixel * height_);
  const Vec3d weights = luminance_weights(rgb_color_space("srgb"));
  double flux = 0;
  for (int row = 0; row < height_; ++row) {
    const double y = pixel * (row - 0.5 * height_);
    for (int column = 0; column < width_; ++column) {
      const double x = pixel * (column - 0.5 * width_);
      const double solid_angle = solid_angle_to(x + pixel, y + pixel) -
                                 solid_angle_to(x, y + pixel) - solid_angle_to(x + pixel, y) +
                                 solid_angle_to(x, y);
      const Vec3f& colour = colours_[static_cast<std::size_t>(row) * width_ + column];
      flux += solid_angle * weights.dot(Vec3d(colour));
    }
  }
  frame_ = LightFrame(light.light_to_world, light.name);
  set_position(transform_point(Vec3d(0), light.light_to_world) - origin);
  scale_ = static_cast<float>(light_factor(light.scale, light.power, flux, name));
  bounds_.power = scale_ * flux;
  bounds_.normals = {frame_.to_world({0, 0, 1}).normalized(), 1};
  const std::array<float, 2> signs{-1, 1};
  bounds_.cosine_reach = 1;
  for (const float sx : signs) {
    for (const float sy : signs) {
      const Vec3f corner = frame_.to_world({sx * half_width_, sy * half_height_, 1}).normalized();
      bounds_.cosine_reach =
          std::min(bounds_.cosine_reach, corner.dot(bounds_.normals.axis) - 1e-3F);
    }
  }
  if (bounds_.cosine_reach < 0) bounds_.normals.cosine = -1;
}

SampledSpectrum PunctualLight::intensity(const Vec3f& away, const SpectrumValues& values) const {
  if (kind_ == Kind::kPoint) return values[intensity_] * scale_;
  const Vec3f local = frame_.to_light(away);
  if (kind_ == Kind::kSpot) {
    const float cosine = local.z / local.length();
    if (cosine <= cosine_end_) return {};
    if (cosine >= cosine_start_) return values[intensity_] * scale_;
    const float t = (cosine - cosine_end_) / (cosine_start_ - cosine_end_);
    return values[intensity_] * (scale_ * t * t * (3.0F - 2.0F * t));
  }
  if (kind_ == Kind::kGoniometric) {
    if (factors_.empty()) return values[intensity_] * scale_;
    const SquarePoint p = octahedral_from_direction(local);
    const auto row = static_cast<std::size_t>(pixel_at(p.v, height_));
    return values[intensity_] * (scale_ * factors_[row * width_ + pixel_at(p.u, width_)]);
  }
  if (local.z <= 0) return {};
  const float x = local.x / (local.z * half_width_);
  const float y = local.y / (local.z * half_height_);
  if (!(std::abs(x) <= 1 && std::abs(y) <= 1)) return {};
  const auto row = static_cast<std::size_t>(pixel_at(0.5F - 0.5F * y, height_));
  return values.illuminant(colours_[row * width_ + pixel_at(0.5F + 0.5F * x, width_)]) * scale_;
}

LightSample PunctualLight::sample(const Vec3f& from, const SpectrumValues& values) const {
  LightSample draw;
  draw.delta = true;
  const Vec3f towards = position_ - from;
  const float distance2 = towards.length2();
  if (!(distance2 > 0)) return draw;
  draw.distance = std::sqrt(distance2);
  draw.direction = towards * (1.0F / draw.distance);
  draw.radiance = intensity(-draw.direction, values) * (1.0F / distance2);
  draw.pdf = 1;
  return draw;
}

}  // namespace freepath
