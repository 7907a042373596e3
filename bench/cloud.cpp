#include "bench/cloud.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "freepath/base/random.h"

namespace freepath::bench {
namespace {

constexpr int kBrick = BrickMap::kBrickSize;
constexpr double kUsedBricks = 0.45;
constexpr int kOctaves = 3;
constexpr float kFeature = 10;  ///< Size of the largest features [bricks].

/// Extinction per unit of density [1/voxel]: mean free paths of some three voxels in the cloud, for
/// about as many super-voxel steps a tentative collision as in a render of a real cloud (1.3).
constexpr float kExtinction = 2.0F;

/// Edge of a super-voxel [voxels].
constexpr int kSuperVoxel = 8;

float hash_noise(int x, int y, int z, uint32_t salt) {
  const auto words =
      philox({static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(z), salt},
             {0, 0}, 4);
  return uniform_from_bits(words[0]);
}

float mix(float a, float b, float part) { return a + (b - a) * part; }

/// Interpolates between the corners of a cube, x slowest.
float mix_corners(const std::array<float, 8>& corners, const Vec3f& fraction) {
  const float low = mix(mix(corners[0], corners[1], fraction.z),
                        mix(corners[2], corners[3], fraction.z), fraction.y);
  const float high = mix(mix(corners[4], corners[5], fraction.z),
                         mix(corners[6], corners[7], fraction.z), fraction.y);
  return mix(low, high, fraction.x);
}

float value_noise(const Vec3f& point, uint32_t salt) {
  const Vec3f base(std::floor(point.x), std::floor(point.y), std::floor(point.z));
  std::array<float, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[i] =
        hash_noise(static_cast<int>(base.x) + (i >> 2), static_cast<int>(base.y) + (i >> 1 & 1),
                   static_cast<int>(base.z) + (i & 1), salt);
  }
  return mix_corners(corners, point - base);
}

/// Values at the corners of bricks, (n+1)³ for n bricks an edge.
class CornerGrid {
 public:
  explicit CornerGrid(int bricks) : edge_(bricks + 1), values_(std::size_t(edge_) * edge_ * edge_) {
    tbb::parallel_for(0, edge_, [&](int x) {
      for (int y = 0; y < edge_; ++y) {
        for (int z = 0; z < edge_; ++z) values_[offset(x, y, z)] = shape(x, y, z);
      }
    });
  }

  std::array<float, 8> around(const Vec3i& brick) const {
    std::array<float, 8> corners;
    for (int i = 0; i < 8; ++i) {
      corners[i] = values_[offset(brick.x + (i >> 2), brick.y + (i >> 1 & 1), brick.z + (i & 1))];
    }
    return corners;
  }

 private:
  std::size_t offset(int x, int y, int z) const { return (std::size_t(x) * edge_ + y) * edge_ + z; }
  static float shape(int x, int y, int z) {
    const Vec3f position = Vec3f(float(x), float(y), float(z)) / kFeature;
    float sum = 0;
    for (int octave = 0; octave < kOctaves; ++octave) {
      const auto scale = static_cast<float>(1 << octave);
      sum += value_noise(position * scale, static_cast<uint32_t>(octave)) / scale;
    }
    return sum;
  }

  int edge_;
  std::vector<float> values_;
};

/// The shape's value above which voxels are filled, so that kUsedBricks of the bricks hold some.
float find_threshold(const CornerGrid& shape, const std::vector<Vec3i>& bricks) {
  std::vector<float> largest;
  for (const Vec3i& brick : bricks) {
    const auto corners = shape.around(brick);
    largest.push_back(*std::max_element(corners.begin(), corners.end()));
  }
  const auto middle =
      largest.begin() + static_cast<std::ptrdiff_t>(double(largest.size()) * (1 - kUsedBricks));
  std::nth_element(largest.begin(), middle, largest.end());
  return *middle;
}

/// One brick: the smooth shape above its threshold, times lumps of four voxels.
void fill_brick(const Vec3i& brick, const std::array<float, 8>& shape, float threshold,
                std::span<float> voxels) {
  constexpr int kLump = 4;
  constexpr int kLumps = kBrick / kLump + 1;
  float lumps[kLumps][kLumps][kLumps];
  for (int x = 0; x < kLumps; ++x) {
    for (int y = 0; y < kLumps; ++y) {
      for (int z = 0; z < kLumps; ++z) {
        const Vec3i at = brick * (kLumps - 1) + Vec3i(x, y, z);
        const float noise = hash_noise(at.x, at.y, at.z, kOctaves);
        lumps[x][y][z] = 0.1F + 0.9F * noise * noise;
      }
    }
  }
  for (int i = 0; i < BrickMap::kBrickVoxels; ++i) {
    const Vec3i at(i >> 6, i >> 3 & 7, i & 7);
    const float smooth = mix_corners(shape, Vec3f(at) / float(kBrick));
    const Vec3i lump = at / kLump;
    std::array<float, 8> corners;
    for (int k = 0; k < 8; ++k) {
      corners[k] = lumps[lump.x + (k >> 2)][lump.y + (k >> 1 & 1)][lump.z + (k & 1)];
    }
    const float detail = mix_corners(corners, Vec3f(at - lump * kLump) / float(kLump));
    voxels[i] = std::clamp(4 * (smooth - threshold), 0.0F, 1.0F) * detail;
  }
}

/// @param draw a ray's origin and direction, from random numbers of the batch
template <class Draw>
std::vector<RayStream> make_streams(std::size_t batches, const Draw& draw) {
  std::vector<RayStream> streams(batches);
  for (std::size_t batch = 0; batch < batches; ++batch) {
    RayStream& rays = streams[batch];
    rays.resize(kRaysPerBatch);
    RandomStream random(1, static_cast<uint32_t>(batch), 0, 0);
    for (std::size_t i = 0; i < kRaysPerBatch; ++i) {
      const auto [origin, direction] = draw(random);
      for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis][i] = origin[axis];
        rays.direction[axis][i] = direction[axis];
      }
      rays.t_max[i] = std::numeric_limits<float>::infinity();
      rays.pixel[i] = static_cast<uint32_t>(batch);
      rays.sample[i] = static_cast<uint32_t>(i);
      rays.stream[i] = 0;
    }
  }
  return streams;
}

}  // namespace

Medium make_cloud(int size) {
  const int edge = size / kBrick;
  const CornerGrid shape(edge);
  std::vector<Vec3i> bricks;
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) bricks.emplace_back(x, y, z);
    }
  }
  const float threshold = find_threshold(shape, bricks);
  std::erase_if(bricks, [&](const Vec3i& brick) {
    const auto corners = shape.around(brick);
    return *std::max_element(corners.begin(), corners.end()) <= threshold;
  });

  BrickMapBuilder builder(Vec3i(0), Vec3i(size - 1), bricks.size());
  const std::span<float> voxels = builder.add_bricks(bricks);
  tbb::parallel_for(std::size_t{0}, bricks.size(), [&](std::size_t i) {
    fill_brick(bricks[i], shape.around(bricks[i]), threshold,
               voxels.subspan(i * BrickMap::kBrickVoxels, BrickMap::kBrickVoxels));
  });
  auto field = std::make_shared<Field>();
  field->name = "cloud";
  field->voxels = std::move(builder).finish();
  Component component;
  component.density = std::move(field);
  component.sigma_s = Rgb(kExtinction);
  return Medium({component}, kSuperVoxel);
}

std::vector<RayStream> make_rays(const Medium& medium, std::size_t batches) {
  const Box3d box = medium.world_bounds();
  const BrickMap& map = medium.components()[0].density->voxels;
  return make_streams(batches, [&](RandomStream& random) {
    Vec3d origin;
    do {
      for (int axis = 0; axis < 3; ++axis) {
        origin[axis] = box.min[axis] + (box.max[axis] - box.min[axis]) * random.uniform();
      }
    } while (map.interpolate(origin) == 0);
    const float height = 2 * random.uniform() - 1;
    const float angle = 2 * std::numbers::pi_v<float> * random.uniform();
    const float radius = std::sqrt(1 - height * height);
    return std::pair(Vec3f(origin),
                     Vec3f(radius * std::cos(angle), radius * std::sin(angle), height));
  });
}

std::vector<RayStream> make_view_rays(const Medium& medium, std::size_t batches) {
  const Box3d box = medium.world_bounds();
  return make_streams(batches, [&](RandomStream& random) {
    Vec3d origin = box.min;
    origin.x -= box.size().x;
    for (int axis = 1; axis < 3; ++axis) origin[axis] += box.size()[axis] * random.uniform();
    return std::pair(Vec3f(origin), Vec3f(1, 0, 0));
  });
}

double majorant_ratio(const Medium& medium) {
  const SuperVoxels& cells = medium.super_voxels();
  const BrickMap& map = medium.components()[0].density->voxels;
  double majorants = 0;
  double filled = 0;
  for (const float majorant : cells.maxima) {
    majorants += majorant;
    filled += majorant > 0 ? 1 : 0;
  }
  double sum = 0;
  for (const float voxel : map.voxels()) sum += voxel;
  const double cell_voxels = std::pow(cells.cell_size, 3);
  return majorants / filled / (sum / (filled * cell_voxels));
}

}  // namespace freepath::bench
