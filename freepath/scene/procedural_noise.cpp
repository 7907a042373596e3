#include "freepath/scene/procedural_noise.h"

#include <algorithm>

namespace freepath::procedural {
namespace {

// The loops over corners and cells below are written over arrays, without branches, so that the
// compiler takes several at once.

int floor_of(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < static_cast<float>(truncated) ? 1 : 0);
}

struct Cell {
  int x, y, z;
  float fraction[3];

  explicit Cell(const Vec3f& point)
      : x(floor_of(point.x)),
        y(floor_of(point.y)),
        z(floor_of(point.z)),
        fraction{point.x - static_cast<float>(x), point.y - static_cast<float>(y),
                 point.z - static_cast<float>(z)} {}
};

/// Ten of the bits as a number in [0,1].
float ten_bits(uint32_t bits, int shift) {
  return static_cast<float>(static_cast<int>(bits >> shift & 1023)) * (1.0F / 1023);
}

constexpr int kCorners = 8;

/// Offsets of a cell and its 26 neighbours, and the last once more to fill a vector.
struct Neighbours {
  static constexpr int kCount = 28;
  int x[kCount]{}, y[kCount]{}, z[kCount]{};

  constexpr Neighbours() {
    for (int i = 0; i < kCount; ++i) {
      const int n = std::min(i, 26);
      x[i] = n / 9 - 1;
      y[i] = n / 3 % 3 - 1;
      z[i] = n % 3 - 1;
    }
  }
};
constexpr Neighbours kNeighbours;

/// Quintic fade: its first two derivatives are 0 at the lattice.
float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// Its derivative.
float fade_slope(float t) { return 30 * t * t * (t - 1) * (t - 1); }

/// The slopes of gradient noise at the corners of a cell, and the values they give in it.
struct CornerValues {
  float gradient[3][kCorners], value[kCorners];

  CornerValues(const Cell& cell, uint32_t seed) {
    constexpr float kLength = 1.5F;  // makes the noise's range about -1 to 1
    for (int i = 0; i < kCorners; ++i) {
      const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
      const uint32_t bits = hash(cell.x + dx, cell.y + dy, cell.z + dz, seed);
      gradient[0][i] = kLength * (2 * ten_bits(bits, 0) - 1);
      gradient[1][i] = kLength * (2 * ten_bits(bits, 10) - 1);
      gradient[2][i] = kLength * (2 * ten_bits(bits, 20) - 1);
      value[i] = gradient[0][i] * (cell.fraction[0] - static_cast<float>(dx)) +
                 gradient[1][i] * (cell.fraction[1] - static_cast<float>(dy)) +
                 gradient[2][i] * (cell.fraction[2] - static_cast<float>(dz));
    }
  }
};

/// Trilinear interpolation of values at the corners, x fastest.
float blend(const float* v, float x, float y, float z) {
  const auto lerp = [](float a, float b, float t) { return a + (b - a) * t; };
  return lerp(lerp(lerp(v[0], v[1], x), lerp(v[2], v[3], x), y),
              lerp(lerp(v[4], v[5], x), lerp(v[6], v[7], x), y), z);
}

/// The gradient of gradient noise.
Vec3f noise_gradient(const Vec3f& point, uint32_t seed) {
  const Cell cell(point);
  const CornerValues corners(cell, seed);
  const float* const f = cell.fraction;
  const float x = fade(f[0]), y = fade(f[1]), z = fade(f[2]);
  const float* const v = corners.value;
  Vec3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    // The change along the axis is the blend, over the other two, of differences of corner values.
    const int step = 1 << axis;
    float change[kCorners];
    for (int i = 0; i < kCorners; ++i) change[i] = v[i | step] - v[i & ~step];
    gradient[axis] =
        blend(corners.gradient[axis], x, y, z) + fade_slope(f[axis]) * blend(change, x, y, z);
  }
  return gradient;
}

}  // namespace

float gradient_noise(const Vec3f& point, uint32_t seed) {
  const Cell cell(point);
  const CornerValues corners(cell, seed);
  return blend(corners.value, fade(cell.fraction[0]), fade(cell.fraction[1]),
               fade(cell.fraction[2]));
}

float fractal_noise(const Vec3f& point, int octaves, float gain, uint32_t seed) {
  float sum = 0, amplitude = 1, total = 0;
  Vec3f scaled = point;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * gradient_noise(scaled, seed + static_cast<uint32_t>(octave) * 131U);
    total += amplitude;
    amplitude *= gain;
    scaled *= 2.03F;  // not 2, so that the zeros at the lattice points don't fall together
  }
  return total > 0 ? sum / total : 0;
}

float billow_noise(const Vec3f& point, uint32_t seed) {
  const Cell cell(point);
  float squared[Neighbours::kCount];
  for (int i = 0; i < Neighbours::kCount; ++i) {
    const int dx = kNeighbours.x[i], dy = kNeighbours.y[i], dz = kNeighbours.z[i];
    const uint32_t bits = hash(cell.x + dx, cell.y + dy, cell.z + dz, seed);
    const float x = static_cast<float>(dx) + ten_bits(bits, 0) - cell.fraction[0];
    const float y = static_cast<float>(dy) + ten_bits(bits, 10) - cell.fraction[1];
    const float z = static_cast<float>(dz) + ten_bits(bits, 20) - cell.fraction[2];
    squared[i] = x * x + y * y + z * z;
  }
  float nearest[4] = {1, 1, 1, 1};
  for (int i = 0; i < Neighbours::kCount; i += 4) {
    for (int lane = 0; lane < 4; ++lane) {
      nearest[lane] = squared[i + lane] < nearest[lane] ? squared[i + lane] : nearest[lane];
    }
  }
  return 1 - std::min(std::min(nearest[0], nearest[1]), std::min(nearest[2], nearest[3]));
}

Vec3f curl_noise(const Vec3f& point, uint32_t seed) {
  const Vec3f a = noise_gradient(point, seed);
  const Vec3f b = noise_gradient(point, seed + 7919U);
  const Vec3f c = noise_gradient(point, seed + 15823U);
  return {c.y - b.z, a.z - c.x, b.x - a.y};
}

Vec3f Sequence::direction() {
  const float y = uniform(-1, 1);
  const float angle = uniform(0, 6.2831853F);
  const float radius = std::sqrt(std::max(0.0F, 1 - y * y));
  return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

}  // namespace freepath::procedural
