#include "freepath/materials/textures/texture_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace freepath {
namespace {

/// The permutation of [Perlin02].
constexpr std::array<uint8_t, 256> kPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

/// Of a coordinate: the whole number below, by its remainder of 256, and the way from there.
struct CellCoordinate {
  explicit CellCoordinate(double coordinate) {
    const double below = std::floor(coordinate);
    number = static_cast<uint8_t>(below - 256.0 * std::floor(below / 256.0));
    way = coordinate - below;
    const double cube = way * way * way;
    weight = cube * (way * (way * 6 - 15) + 10);
  }
  uint8_t number;
  double way;
  double weight;  ///< Of what lies above.
};

uint8_t permuted(unsigned number) { return kPermutation[number % kPermutation.size()]; }

/// The way from a corner, along the corner's gradient: to an edge of a cube around it.
double ascent(unsigned hash, const Vec3d& way) {
  const unsigned number = hash % 16;
  // The pairs of axes, in fours of all signs; the last four numbers repeat some of them.
  const bool along_xy = number < 4 || number == 12 || number == 13;
  const bool along_xz = number >= 4 && number < 8;
  const double first = along_xy || along_xz ? way.x : way.y;
  const double second = along_xy ? way.y : way.z;
  return (number & 1U ? -first : first) + (number & 2U ? -second : second);
}

constexpr double kLacunarity = 1.99;  // not 2, so that the zeros of octaves do not coincide

/// The sum over octaves of what `shape` makes of noise.
template <class Shape>
double sum_of_octaves(const Vec3d& point, float omega, int octaves, Shape shape) {
  double sum = 0;
  double frequency = 1;
  double amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * shape(texture_noise(point * frequency));
    frequency *= kLacunarity;
    amplitude *= omega;
  }
  return sum;
}

}  // namespace

float texture_noise(const Vec3d& point) {
  if (!std::isfinite(point.x + point.y + point.z)) return 0;
  const std::array<CellCoordinate, 3> cell = {CellCoordinate(point.x), CellCoordinate(point.y),
                                              CellCoordinate(point.z)};
  double sum = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned x = corner & 1U;
    const unsigned y = corner >> 1U & 1U;
    const unsigned z = corner >> 2U;
    const unsigned hash =
        permuted(permuted(permuted(cell[0].number + x) + cell[1].number + y) + cell[2].number + z);
    const auto share = [&](int axis, unsigned above) {
      return above != 0 ? cell[axis].weight : 1 - cell[axis].weight;
    };
    sum += share(0, x) * share(1, y) * share(2, z) *
           ascent(hash, {cell[0].way - x, cell[1].way - y, cell[2].way - z});
  }
  return static_cast<float>(sum);
}

float fractal_motion(const Vec3d& point, float omega, int octaves) {
  return static_cast<float>(
      sum_of_octaves(point, omega, octaves, [](double noise) { return noise; }));
}

float turbulence(const Vec3d& point, float omega, int octaves) {
  constexpr double kMean = 0.2;  // of the absolute value of noise, as pbrt has it
  const double sum =
      sum_of_octaves(point, omega, octaves, [](double noise) { return std::abs(noise); });
  return static_cast<float>(sum + kMean * std::pow(static_cast<double>(omega), octaves));
}

bool in_polka_dot(float s, float t) {
  constexpr double kRadius = 0.35;
  constexpr double kFarthest = 0.5 - kRadius;  // of the centre, from the middle of its square
  const double column = std::floor(s + 0.5);
  const double row = std::floor(t + 0.5);
  const auto noise = [&](double x, double y) {
    return double{texture_noise({column + x, row + y, 0.5})};
  };
  if (!(noise(0.5, 0.5) > 0)) return false;
  const double ds = s - (column + kFarthest * noise(1.5, 2.8));
  const double dt = t - (row + kFarthest * noise(4.5, 9.8));
  return ds * ds + dt * dt < kRadius * kRadius;
}

Vec3f marble_color(float height) {
  // Control points of cubic Bezier curves, each of which begins at the next point.
  static constexpr float kColors[][3] = {
      {0.58F, 0.58F, 0.6F}, {0.58F, 0.58F, 0.6F}, {0.58F, 0.58F, 0.6F},
      {0.5F, 0.5F, 0.5F},   {0.6F, 0.59F, 0.58F}, {0.58F, 0.58F, 0.6F},
      {0.58F, 0.58F, 0.6F}, {0.2F, 0.2F, 0.33F},  {0.58F, 0.58F, 0.6F}};
  constexpr int kCurves = static_cast<int>(std::size(kColors)) - 3;
  const float at = std::clamp(height, 0.0F, 1.0F) * kCurves;
  const int curve = std::min(static_cast<int>(at), kCurves - 1);
  const float b = at - static_cast<float>(curve);
  const float a = 1 - b;
  const std::array<float, 4> weights = {a * a * a, 3 * a * a * b, 3 * a * b * b, b * b * b};
  Vec3f color(0);
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) color[c] += weights[i] * kColors[curve + i][c];
  }
  return color * 1.5F;
}

}  // namespace freepath
