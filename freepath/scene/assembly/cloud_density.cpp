#include "freepath/scene/assembly/cloud_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "freepath/base/box.h"
#include "freepath/base/error.h"
#include "freepath/media/density_function.h"

namespace freepath {
namespace {

/// The permutation of Perlin's reference implementation [Perlin02].
// clang-format off
constexpr std::array<uint8_t, 256> kPermutation = {
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69,
    142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219,
    203, 117, 35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175,
    74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230,
    220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76,
    132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186,
    3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59,
    227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70,
    221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178,
    185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241, 81,
    51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176, 115,
    121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195,
    78, 66, 215, 61, 156, 180};
// clang-format on

uint8_t permuted(int value) { return kPermutation[static_cast<std::size_t>(value & 255)]; }

/// The dot product of an offset with one of the twelve gradients to the middles of a cube's edges,
/// four of them twice.
double gradient(int x, int y, int z, const Vec3d& offset) {
  const int hash = permuted(permuted(permuted(x) + y) + z) & 15;
  const bool twice = hash == 12 || hash == 13;
  const double u = hash < 8 || twice ? offset.x : offset.y;
  const double v = hash < 4 || twice ? offset.y : offset.z;
  return ((hash & 1) != 0 ? -u : u) + ((hash & 2) != 0 ? -v : v);
}

double smooth(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// Forward differences of the noise.
Vec3d noise_slope(const Vec3d& point) {
  constexpr double kStep = 0.01;
  const double here = lattice_noise(point);
  Vec3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d ahead = point;
    ahead[axis] += kStep;
    slope[axis] = (lattice_noise(ahead) - here) / kStep;
  }
  return slope;
}

}  // namespace

double lattice_noise(const Vec3d& point) {
  int cell[3];
  Vec3d offset;
  Vec3d weight;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = std::floor(point[axis]);
    // The lattice repeats itself after 256 cells.
    cell[axis] = static_cast<int>(std::fmod(whole, 256.0));
    offset[axis] = point[axis] - whole;
    weight[axis] = smooth(offset[axis]);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner >> 2;
    const int dy = corner >> 1 & 1;
    const int dz = corner & 1;
    const double share = (dx != 0 ? weight.x : 1 - weight.x) * (dy != 0 ? weight.y : 1 - weight.y) *
                         (dz != 0 ? weight.z : 1 - weight.z);
    sum += share * gradient(cell[0] + dx, cell[1] + dy, cell[2] + dz, offset - Vec3d(dx, dy, dz));
  }
  return sum;
}

double CloudDensity::at(const Vec3d& point) const {
  Vec3d position = point * frequency;
  if (wispiness > 0) {
    double strength = 0.05 * wispiness;
    double scale = 10;
    for (int octave = 0; octave < 2; ++octave) {
      position += noise_slope(position * scale) * strength;
      strength *= 0.5;
      scale *= 1.99;
    }
  }
  double sum = 0;
  double strength = 0.5;
  double scale = 1;
  for (int octave = 0; octave < 5; ++octave) {
    sum += strength * lattice_noise(position * scale);
    strength *= 0.5;
    scale *= 1.99;
  }
  const double billows = std::clamp((1 - point.y) * 4.5 * density * sum, 0.0, 1.0);
  return std::clamp(billows + 2 * std::max(0.0, 0.5 - point.y), 0.0, 1.0);
}

std::shared_ptr<const Field> make_cloud_field(const std::string& name, const CloudDensity& cloud,
                                              const Matrix4d& medium_to_world) {
  const double determinant = medium_to_world.determinant();
  if (!std::isfinite(determinant) || determinant == 0) fail("its transform has no inverse");
  const Matrix4d to_medium = medium_to_world.inverse();
  Box3d inside;
  inside.extendBy(cloud.p0);
  inside.extendBy(cloud.p1);
  const Box3d world = Imath::transform(inside, medium_to_world);
  DensityFunction function;
  function.box = {Vec3f(world.min), Vec3f(world.max)};
  function.cells = Vec3i(16);
  function.evaluate = [cloud, to_medium, inside](std::span<const Vec3f> positions,
                                                 std::span<float> densities) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3d point = Vec3d(positions[i]) * to_medium;
      densities[i] = inside.intersects(point) ? static_cast<float>(cloud.at(point)) : 0.0F;
    }
  };
  function.bounds = [](const Box3f& /*part*/) { return DensityFunction::Bounds{0, 1}; };
  return make_function_field(name, std::move(function));
}

}  // namespace freepath
