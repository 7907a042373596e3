#include "freepath/paths/near_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "freepath/base/tangent_frame.h"
#include "freepath/paths/walk_batches.h"
#include "freepath/transport/walker.h"

namespace freepath {
namespace {

/// Mean transmittance from a light to the edge of its ball, at least.
constexpr double kTransmittance = 0.37;
constexpr auto kPi = std::numbers::pi_v<float>;
/// Directions from a light, and steps between a ball that is too large and one that is not.
constexpr uint32_t kDirections = 64;
constexpr float kStep = 0.7F;
constexpr int kSteps = 60;
/// Radius of a ball over that of a sphere around its light, at least: light of larger ones, which
/// paths find by chance too, varies little.
constexpr float kSmallest = 32;
/// Streams that no path has.
constexpr uint32_t kStream = 0xFFFFFFFBU;

/// The part of a ray in a box.
struct Interval {
  float begin = 0;
  float end = 0;
};

Interval clip(const Box3f& box, const Vec3f& origin, const Vec3f& direction, Interval part) {
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / direction[axis];
    const float a = (box.min[axis] - origin[axis]) * inverse;
    const float b = (box.max[axis] - origin[axis]) * inverse;
    if (std::isnan(a) || std::isnan(b)) continue;  // along a side
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  return part;
}

/// The part of a ray in a cone of less than a half.
/// @param nearest point of the ray to the cone's tip, relative to that
/// @param closest its distance along the ray
Interval clip_by_cone(const Vec3f& axis, float cosine, const Vec3f& nearest, const Vec3f& direction,
                      float closest, Interval part) {
  // Where (b + s a)² = cosine² (h² + s²), s counted from that point.
  const float a = direction.dot(axis);
  const float b = nearest.dot(axis);
  const float cosine2 = cosine * cosine;
  const float squares = a * a - cosine2;
  const float rest = b * b - cosine2 * nearest.length2();
  const float discriminant = a * a * b * b - squares * rest;
  if (squares == 0) return part;
  if (discriminant < 0) return squares < 0 ? Interval{} : part;
  const float root = std::sqrt(discriminant);
  const float first = (-a * b + (squares < 0 ? root : -root)) / squares;
  const float second = (-a * b + (squares < 0 ? -root : root)) / squares;
  if (squares < 0) {  // between both, if that is before the tip and not behind it
    if (b + 0.5F * (first + second) * a <= 0) return {};
    part.begin = std::max(part.begin, closest + first);
    part.end = std::min(part.end, closest + second);
  } else if (a > 0) {
    part.begin = std::max(part.begin, closest + second);
  } else {
    part.end = std::min(part.end, closest + first);
  }
  return part;
}

float distance_to(const Box3f& box, const Vec3f& point) {
  Vec3f inside;
  for (int axis = 0; axis < 3; ++axis) {
    inside[axis] = std::clamp(point[axis], box.min[axis], box.max[axis]);
  }
  return (point - inside).length();
}

float farthest_of(const Box3f& box, const Vec3f& point) {
  Vec3f corner;
  for (int axis = 0; axis < 3; ++axis) {
    corner[axis] =
        std::max(std::abs(box.min[axis] - point[axis]), std::abs(box.max[axis] - point[axis]));
  }
  return corner.length();
}

/// What is added to squared distances from a light, lest densities become infinite.
float soften(float size, float squared_radius) { return size * size + squared_radius * 1e-12F; }

/// Largest angle between the direction to a ball's middle and rays that pass it, or half of that of
/// all rays from within.
float widest_angle(float squared_distance, float squared_radius) {
  if (squared_distance < squared_radius) return kPi / 2;
  return std::asin(std::sqrt(squared_radius / squared_distance));
}

/// The entry of `weights` at which their running sum passes u.
std::size_t choose(std::span<const float> weights, float u) {
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    chosen = i;
    if (u < weights[i]) break;
    u -= weights[i];
  }
  return chosen;
}

/// Points of a Fibonacci lattice on the sphere.
Vec3f lattice_direction(uint32_t i) {
  const double z = 1 - (2 * i + 1.0) / kDirections;
  const double turns = i * (std::numbers::phi - 1);
  const double azimuth = 2 * std::numbers::pi * (turns - std::floor(turns));
  const double sine = std::sqrt(1 - z * z);
  return Vec3f(Vec3d(sine * std::cos(azimuth), sine * std::sin(azimuth), z));
}

/// Mean transmittance from a point over a distance in all directions.
double mean_transmittance(const Walker& walker, const Vec3f& from, float distance) {
  RayStream rays;
  rays.resize(kDirections);
  for (uint32_t i = 0; i < kDirections; ++i) {
    set_ray(rays, i, from, lattice_direction(i), distance);
    rays.pixel[i] = i;
    rays.sample[i] = 0;
    rays.stream[i] = kStream;
  }
  FlightStream flights;
  WalkStatistics statistics;
  walker.transmittance(rays, flights, statistics);
  double sum = 0;
  for (uint32_t i = 0; i < kDirections; ++i) sum += std::clamp(flights.weight[0][i], 0.0F, 1.0F);
  return sum / kDirections;
}

}  // namespace

NearLights::NearLights(const WavelengthSampler& factory, uint64_t seed) {
  const PathScene& scene = factory.scene();
  if (scene.domain || scene.media.empty()) return;
  find_lights(scene);
  if (!balls_.empty()) find_radii(factory, seed);
  std::erase_if(balls_, [](const Ball& ball) {
    return std::all_of(ball.squared_radii.begin(), ball.squared_radii.end(),
                       [](float squared) { return squared == 0; });
  });
  numbers_.assign(scene.lights->within().size(), kNone);
  for (uint32_t i = 0; i < balls_.size(); ++i) numbers_[balls_[i].light] = i;
}

void NearLights::find_lights(const PathScene& scene) {
  const std::vector<LightBounds>& lights = scene.lights->within();
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (!(lights[i].power > 0)) continue;
    const LightBounds& light = lights[i];
    Ball ball{.light = i,
              .middle = light.box.center(),
              .size = 0.5F * light.box.size().length(),
              .power = static_cast<float>(light.power),
              .squared_radii = {}};
    if (ball.size == 0 && light.normals.cosine == 1 && light.cosine_reach > 0) {
      ball.axis = light.normals.axis;
      ball.cosine = light.cosine_reach;
    }
    balls_.push_back(std::move(ball));
  }
  std::stable_sort(balls_.begin(), balls_.end(),
                   [](const Ball& a, const Ball& b) { return a.power > b.power; });
  if (balls_.size() > kMostLights) balls_.resize(kMostLights);
}

void NearLights::find_radii(const WavelengthSampler& factory, uint64_t seed) {
  const PathScene& scene = factory.scene();
  for (Ball& ball : balls_) ball.squared_radii.assign(scene.media.size() + 1, 0.0F);
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const BoundMedium bound = factory.bound_in_rgb(i);
    const Box3d box = scene.media[i].outer_bounds();
    bounds_.emplace_back(Vec3f(box.min - scene.origin), Vec3f(box.max - scene.origin));
    const WalkSettings settings{.seed = seed, .origin = scene.origin};
    const Walker walker(*bound.medium, bound.channels.only(0), settings);
    for (Ball& ball : balls_) {
      float radius = farthest_of(bounds_[i], ball.middle);
      for (int step = 0; step < kSteps; ++step, radius *= kStep) {
        if (mean_transmittance(walker, ball.middle, radius) >= kTransmittance) break;
      }
      if (radius <= distance_to(bounds_[i], ball.middle) || radius < kSmallest * ball.size)
        continue;
      ball.squared_radii[i] = radius * radius;
    }
  }
  for (Ball& ball : balls_) {
    float smallest = std::numeric_limits<float>::infinity();
    for (const float squared : ball.squared_radii) {
      if (squared > 0) smallest = std::min(smallest, squared);
    }
    ball.squared_radii.back() = std::isfinite(smallest) ? smallest : 0;
  }
}

std::optional<NearLights::Passed> NearLights::pass(const Ball& ball, std::size_t medium,
                                                   const Vec3f& origin, const Vec3f& direction,
                                                   float length) const {
  const float squared = ball.squared_radii[medium];
  const Vec3f to = ball.middle - origin;
  const float closest = to.dot(direction);
  const float height2 = (to - direction * closest).length2();
  if (!(height2 < squared)) return std::nullopt;
  const float half = std::sqrt(squared - height2);
  Interval part{std::max(closest - half, 0.0F), std::min(closest + half, length)};
  if (medium < bounds_.size()) part = clip(bounds_[medium], origin, direction, part);
  if (ball.cosine > 0) {
    part = clip_by_cone(ball.axis, ball.cosine, direction * closest - to, direction, closest, part);
  }
  if (!(part.begin < part.end)) return std::nullopt;
  const float height = std::sqrt(height2 + soften(ball.size, squared));
  const float begin = std::atan((part.begin - closest) / height);
  const float end = std::atan((part.end - closest) / height);
  if (!(begin < end)) return std::nullopt;
  return Passed{ball.light, closest, height, begin, end};
}

std::optional<NearLights::Point> NearLights::point_on(const Passed& passed, float u) {
  const float range = passed.end - passed.begin;
  const float t = passed.closest + passed.height * std::tan(passed.begin + range * u);
  if (!(t > 0)) return std::nullopt;
  // Of the distance as it was rounded.
  const float along = t - passed.closest;
  return Point{passed.light, t,
               range * (passed.height * passed.height + along * along) / passed.height};
}

std::optional<NearLights::Point> NearLights::sample(MediumId medium, const Vec3f& origin,
                                                    const Vec3f& direction, float length,
                                                    RandomStream& random) const {
  const std::size_t number = number_of(medium);
  std::array<Passed, kMostLights> passed;
  std::array<float, kMostLights> weights{};
  std::size_t count = 0;
  float sum = 0;
  for (const Ball& ball : balls_) {
    const auto one = pass(ball, number, origin, direction, length);
    if (!one) continue;
    passed[count] = *one;
    weights[count] = ball.power * (one->end - one->begin) / one->height;
    sum += weights[count++];
  }
  if (count == 0) return std::nullopt;
  const std::size_t i = choose(std::span(weights).first(count), random.uniform() * sum);
  auto point = point_on(passed[i], random.uniform());
  if (point) point->weight *= sum / weights[i];
  return point;
}

std::optional<NearLights::Point> NearLights::sample_on(uint32_t ball, MediumId medium,
                                                       const Vec3f& origin, const Vec3f& direction,
                                                       float length, RandomStream& random) const {
  const auto passed = pass(balls_[ball], number_of(medium), origin, direction, length);
  if (!passed) return std::nullopt;
  return point_on(*passed, random.uniform());
}

std::optional<NearLights::Aim> NearLights::aim(MediumId medium, const Vec3f& position,
                                               RandomStream& random) const {
  const std::size_t number = number_of(medium);
  std::array<float, kMostLights> weights{};
  float sum = 0;
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    const float squared = ball.squared_radii[number];
    if (squared == 0) continue;
    const float distance2 = (ball.middle - position).length2();
    weights[i] = ball.power * widest_angle(distance2, squared) /
                 std::sqrt(distance2 + soften(ball.size, squared));
    sum += weights[i];
  }
  if (sum == 0) return std::nullopt;
  const std::size_t i = choose(std::span(weights).first(balls_.size()), random.uniform() * sum);
  const Vec3f to = balls_[i].middle - position;
  const float distance2 = to.length2();
  const float squared = balls_[i].squared_radii[number];
  const float u = random.uniform();
  const float angle =
      distance2 < squared ? kPi * (1 - std::sqrt(1 - u)) : u * widest_angle(distance2, squared);
  const float azimuth = 2 * kPi * random.uniform();
  const TangentFrame frame(distance2 > 0 ? to / std::sqrt(distance2) : Vec3f(0, 0, 1));
  const float sine = std::sin(angle);
  const Vec3f direction =
      frame.to_world(sine * std::cos(azimuth), sine * std::sin(azimuth), std::cos(angle));
  return Aim{static_cast<uint32_t>(i), direction.normalized(), weights[i] / sum};
}

float NearLights::aim_pdf(uint32_t ball, MediumId medium, const Vec3f& position,
                          const Vec3f& direction) const {
  const Vec3f to = balls_[ball].middle - position;
  const float along = to.dot(direction);
  const float across = to.cross(direction).length();
  const float angle = std::atan2(across, along);
  const float sine = std::max(std::sin(angle), 1e-9F);
  const float squared = balls_[ball].squared_radii[number_of(medium)];
  if (to.length2() < squared) return (kPi - angle) / (kPi * kPi * kPi * sine);
  const float widest = widest_angle(to.length2(), squared);
  return angle < widest ? 1 / (2 * kPi * widest * sine) : 0.0F;
}

}  // namespace freepath
