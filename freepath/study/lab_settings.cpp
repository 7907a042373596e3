#include "freepath/study/lab_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/media/density_function.h"

namespace freepath {
namespace {

/// A density along x.
using Shape = std::function<double(double x)>;

/// The column of voxels reaches this far beyond the ray: the cells next to it are filled, and the
/// brick map's index, which grows by two voxels and begins at a whole brick, begins at a whole
/// cell.
constexpr int kMargin = kLabCell - 2;
/// The ray is in the middle of a cell, off the faces of voxels.
constexpr double kRayVoxel = 8.3;

const Rgb kNone(0.0F);
const Rgb kGreyAbsorption(0.6F);
const Rgb kGreyScattering(2.4F);

/// Wide enough in y and z for super-voxels around the ray to be full of it.
std::shared_ptr<const Field> make_field(const Shape& shape) {
  const Vec3i low(-kMargin);
  const Vec3i high(kLabVoxels - 1 + kMargin, kLabCell - 1 + kMargin, kLabCell - 1 + kMargin);
  const Vec3i first = Vec3i(-kLabCell / BrickMap::kBrickSize);
  const Vec3i last((kLabVoxels + kLabCell) / BrickMap::kBrickSize,
                   2 * kLabCell / BrickMap::kBrickSize, 2 * kLabCell / BrickMap::kBrickSize);
  BrickMapBuilder builder(low, high, 0);
  constexpr int kPlane = BrickMap::kBrickSize * BrickMap::kBrickSize;
  for (int x = first.x; x < last.x; ++x) {
    std::array<float, BrickMap::kBrickSize> densities{};
    for (int i = 0; i < BrickMap::kBrickSize; ++i) {
      const int voxel = std::clamp(x * BrickMap::kBrickSize + i, 0, kLabVoxels - 1);
      densities[i] = static_cast<float>(shape((voxel + 0.5) / kLabVoxels));
    }
    for (int y = first.y; y < last.y; ++y) {
      for (int z = first.z; z < last.z; ++z) {
        const auto voxels = builder.add_brick(Vec3i(x, y, z));
        for (int i = 0; i < BrickMap::kBrickVoxels; ++i) voxels[i] = densities[i / kPlane];
      }
    }
  }
  auto field = std::make_shared<Field>();
  field->name = "lab";
  field->voxels = std::move(builder).finish();
  field->index_to_world.setScale(1.0 / kLabVoxels);
  for (int axis = 0; axis < 3; ++axis) field->index_to_world[3][axis] = 0.5 / kLabVoxels;
  return field;
}

Component component(const Shape& shape, const Rgb& sigma_a, const Rgb& sigma_s,
                    const Rgb& emission = kNone) {
  Component result;
  result.density = make_field(shape);
  result.sigma_a = sigma_a;
  result.sigma_s = sigma_s;
  result.emission = emission;
  return result;
}

std::vector<Component> grey(const Shape& shape) {
  return {component(shape, kGreyAbsorption, kGreyScattering)};
}

/// A lump of a given integral on top of a floor.
double spike(double x, double floor, double integral) {
  constexpr double kMiddle = 0.6;
  constexpr double kWidth = 0.015;
  constexpr double kReach = 6;  // widths; far from it there is nothing, and not a trace
  const double off = (x - kMiddle) / kWidth;
  if (std::abs(off) > kReach) return floor;
  return floor + integral / (kWidth * 2.5066282746310002) * std::exp(-0.5 * off * off);
}

/// Four octaves of smooth noise, in [0.1, 2.1].
double noise(double x) {
  double sum = 0;
  double size = 1;
  for (uint32_t octave = 0; octave < 4; ++octave) {
    const double position = x * (6U << octave);
    const auto cell = static_cast<uint32_t>(position);
    const double s = position - cell;
    const auto value = [&](uint32_t at) {
      return uniform_from_bits(philox({at, octave, 0, 0}, {20170720U, 0})[0]);
    };
    sum += size * std::lerp(value(cell), value(cell + 1), s * s * (3 - 2 * s));
    size /= 2;
  }
  return 0.1 + 2 * sum / 1.875;
}

/// r(x) of fixture A.
double fixture_shape(double x) {
  return 0.15 + 0.85 * (0.5 + 0.5 * std::sin(17 * x) * std::cos(5 * x * x + 1));
}

/// mu_s = (6r, 0.9 + 2.1r², r), mu_a = (0.5r, 1.5r, 3√r). The components that absorb are split so
/// that sums of constant emissions make L_e = (1+x, 2-x, 0.5+x²):
/// 1+x = 1(1-x) + 2x, 2-x = 2(1-x) + 1x, 0.5+x² = 0.5(1-x²) + 1.5x².
std::vector<Component> fixture_components() {
  const auto r = fixture_shape;
  return {
      component(r, kNone, Rgb(6, 0, 1)),
      component([=](double x) { return r(x) * r(x); }, kNone, Rgb(0, 2.1F, 0)),
      component([](double) { return 1.0; }, kNone, Rgb(0, 0.9F, 0)),
      component([=](double x) { return r(x) * (1 - x); }, Rgb(0.5F, 1.5F, 0), kNone, Rgb(1, 2, 0)),
      component([=](double x) { return r(x) * x; }, Rgb(0.5F, 1.5F, 0), kNone, Rgb(2, 1, 0)),
      component([=](double x) { return std::sqrt(r(x)) * (1 - x * x); }, Rgb(0, 0, 3), kNone,
                Rgb(0, 0, 0.5F)),
      component([=](double x) { return std::sqrt(r(x)) * x * x; }, Rgb(0, 0, 3), kNone,
                Rgb(0, 0, 1.5F)),
  };
}

double fixture_scattered(double x, int channel) {
  return channel == 0 ? 0.7 : channel == 1 ? 1.1 - x : 1 + 0.3 * std::sin(9 * x);
}

/// Of the other settings: nothing that a tracker could guess.
double usual_scattered(double x, int channel) { return 1 + 0.5 * std::cos(3 * x + channel); }

std::vector<Component> homogeneous() {
  return grey([](double) { return 1.0; });
}
std::vector<Component> two_boxes() {
  return grey([](double x) { return x < 120.0 / kLabVoxels ? 0.4 : 1.6; });
}
std::vector<Component> ramp() {
  return grey([](double x) { return 2 * x; });
}
std::vector<Component> grey_spike() {
  return grey([](double x) { return spike(x, 0.4, 0.6); });
}
std::vector<Component> grey_noise() { return grey(noise); }

/// One density for all channels, and in each channel one albedo: 0.95, 0.98 and 0.9.
std::vector<Component> chromatic_ramp() {
  return {component([](double x) { return 2 * x; }, Rgb(0.3F, 0.04F, 0.075F),
                    Rgb(5.7F, 1.96F, 0.675F))};
}
/// The lump is thick in red, what is around it in blue.
std::vector<Component> chromatic_spike() {
  return {component([](double) { return 1.0; }, Rgb(0.1F, 0.2F, 0.3F), Rgb(0.3F, 0.9F, 2.7F)),
          component([](double x) { return spike(x, 0, 0.5); }, Rgb(0.6F, 0.3F, 0.1F),
                    Rgb(6.0F, 1.5F, 0.3F))};
}

struct Entry {
  LabSettingInfo info;
  std::vector<Component> (*components)();
  int channels;
};

constexpr Entry kEntries[] = {
    {{"homogeneous", "the same density everywhere"}, homogeneous, 1},
    {{"two-boxes", "a thin box, then a thick one, their seam within a super-voxel"}, two_boxes, 1},
    {{"ramp", "a density that grows from 0"}, ramp, 1},
    {{"spike", "a narrow lump in thin surroundings: one super-voxel holds most of it"},
     grey_spike,
     1},
    {{"noise", "four octaves of noise"}, grey_noise, 1},
    {{"fixture-a", "three channels that differ everywhere, with emission"}, fixture_components, 3},
    {{"chromatic-ramp", "the ramp, eight times as thick in red as in blue, high albedos"},
     chromatic_ramp,
     3},
    {{"chromatic-spike", "a red lump in blue surroundings"}, chromatic_spike, 3},
};

}  // namespace

std::span<const LabSettingInfo> lab_setting_infos() {
  static const std::vector<LabSettingInfo> kInfos = [] {
    std::vector<LabSettingInfo> infos;
    for (const Entry& entry : kEntries) infos.push_back(entry.info);
    return infos;
  }();
  return kInfos;
}

LabSetting make_lab_setting(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Entry& entry : kEntries) {
    names.push_back(entry.info.name);
    if (entry.info.name != name) continue;
    LabSetting setting;
    setting.name = entry.info.name;
    setting.summary = entry.info.summary;
    setting.medium = std::make_shared<const Medium>(entry.components(), kLabCell);
    setting.channels = entry.channels;
    const bool fixture = entry.components == fixture_components;
    setting.scattered = fixture ? fixture_scattered : usual_scattered;
    setting.background = fixture ? 1 : 0.5;
    return setting;
  }
  fail("there is no setting '{}'; there are {}", name, fmt::join(names, ", "));
}

Medium medium_along_ray(const LabSetting& setting) {
  std::vector<Component> components = setting.medium->components();
  for (Component& component : components) {
    DensityFunction function;
    function.box = Box3f(Vec3f(0), Vec3f(1));
    function.cells = Vec3i(kLabVoxels / kLabCell, 1, 1);
    const auto value = [field = component.density](int voxel) {
      return field->voxels.value(Vec3i(voxel, 0, 0));
    };
    function.evaluate = [value](std::span<const Vec3f> positions, std::span<float> densities) {
      for (std::size_t i = 0; i < positions.size(); ++i) {
        densities[i] = value(static_cast<int>(std::floor(positions[i].x * kLabVoxels)));
      }
    };
    function.bounds = [value](const Box3f& part) {
      const auto first = static_cast<int>(std::floor(part.min.x * kLabVoxels + 0.5F));
      DensityFunction::Bounds bounds{value(first), value(first)};
      for (int voxel = first - 1; voxel <= first + kLabCell; ++voxel) {
        bounds.minimum = std::min(bounds.minimum, value(voxel));
        bounds.maximum = std::max(bounds.maximum, value(voxel));
      }
      return bounds;
    };
    component.density = make_function_field("lab", std::move(function));
  }
  return Medium(std::move(components));
}

void set_lab_ray(std::size_t slot, float x, float length, RayStream& rays) {
  rays.origin[0][slot] = x;
  for (int axis = 1; axis < 3; ++axis) rays.origin[axis][slot] = float(kRayVoxel / kLabVoxels);
  for (int axis = 0; axis < 3; ++axis) rays.direction[axis][slot] = axis == 0 ? 1.0F : 0.0F;
  rays.t_max[slot] = length;
}

void set_lab_rays(uint64_t first, std::size_t count, RayStream& rays) {
  rays.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    set_lab_ray(i, 0, 1, rays);
    rays.pixel[i] = static_cast<uint32_t>((first + i) >> 32);
    rays.sample[i] = static_cast<uint32_t>(first + i);
    rays.stream[i] = 0;
  }
}

}  // namespace freepath
