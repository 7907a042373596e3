#include "tests/certify/media.h"

#include <cmath>
#include <functional>
#include <utility>

#include "tests/media/make_field.h"
#include "tests/transport/media_for_tests.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {
namespace {

constexpr float kLooseness = 4;
/// Fewer than in the fixture, whose numbers are not asked for here: regular tracking visits each.
constexpr int kFixtureVoxels = 256;

const Rgb kNone(0.0F);
const Rgb kGreyAbsorption(0.5F);
const Rgb kGreyScattering(1.5F);
/// Every channel has another extinction and another albedo.
const Rgb kRedAbsorption(0.02F, 0.2F, 1.0F);
const Rgb kRedScattering(4.0F, 1.0F, 0.25F);
const Rgb kBlueAbsorption(1.5F, 0.3F, 0.0F);
const Rgb kBlueScattering(0.0F, 0.6F, 2.5F);
const Rgb kEmission(1.0F, 2.0F, 0.5F);

Component make_component(std::shared_ptr<const Field> density, const Rgb& sigma_a,
                         const Rgb& sigma_s, const Rgb& emission = kEmission) {
  Component component;
  component.density = std::move(density);
  component.sigma_a = sigma_a;
  component.sigma_s = sigma_s;
  component.emission = emission;
  return component;
}

/// A line of voxels whose length is 1, its density a function of x in [0,1].
std::shared_ptr<Field> line(int voxels, const std::function<double(double)>& density) {
  Matrix4d index_to_world;
  index_to_world.setScale(Vec3d(1.0 / voxels, 1, 1));
  index_to_world[3][0] = 0.5 / voxels;
  return make_field(
      Vec3i(0, -1, -1), Vec3i(voxels - 1, 1, 1),
      [&](const Vec3i& p) { return static_cast<float>(density((p.x + 0.5) / voxels)); },
      index_to_world);
}

/// Along the lines, from outside to outside.
CertifiedRay along_line() { return {Vec3f(-0.25F, 0.1F, -0.2F), Vec3f(1, 0, 0), 1.5F}; }

/// A brick map turned, mirrored and scaled, its density a function of the voxel.
std::shared_ptr<Field> crooked(const std::function<float(const Vec3i&)>& density) {
  return make_field(Vec3i(-12), Vec3i(11), density, crooked_transform());
}

std::shared_ptr<Field> dense_noise(int seed = 0) {
  return crooked([seed](const Vec3i& p) { return 0.3F + 0.7F * hash_noise(p + Vec3i(50 * seed)); });
}

/// The same voxels elsewhere: turned further, smaller and moved, partly outside the others.
std::shared_ptr<Field> turned_noise() {
  Matrix4d matrix = crooked_transform();
  matrix *= Matrix4d().setScale(Vec3d(0.6, 0.8, 0.7));
  matrix *= Matrix4d().rotate(Vec3d(-0.7, 0.4, 1.1));
  matrix *= Matrix4d().setTranslation(Vec3d(0.5, 0.2, -0.1));
  auto field = dense_noise(3);
  field->index_to_world = matrix;
  return field;
}

/// A few voxels in a large box: most super-voxels are empty.
std::shared_ptr<Field> sparse_field() {
  Matrix4d index_to_world;
  index_to_world.setScale(Vec3d(0.02));
  return make_field(
      Vec3i(-64, -20, -20), Vec3i(63, 19, 19),
      [](const Vec3i& p) {
        const float lump = hash_noise(Vec3i(p.x >> 3, p.y >> 3, p.z >> 3) + Vec3i(31));
        return lump < 0.12F ? 4 + 20 * hash_noise(p) : 0.0F;
      },
      index_to_world);
}

/// Constant bricks, as the tiles of a VDB become.
std::shared_ptr<Field> tiles() {
  BrickMapBuilder builder(Vec3i(0), Vec3i(63, 15, 15), 0);
  const float values[8] = {1, 0, 3, 0.5F, 0.5F, 0, 0, 2};
  for (int x = 0; x < 8; ++x) {
    builder.add_constant_bricks(Vec3i(x, 0, 0), Vec3i(x + 1, 2, 2), values[x]);
  }
  auto field = std::make_shared<Field>();
  field->name = "tiles";
  field->voxels = std::move(builder).finish();
  field->index_to_world.setScale(Vec3d(1.0 / 32));
  return field;
}

CertifiedRay through_tiles() {
  return {Vec3f(-0.2F, 0.11F, 0.13F), Vec3f(0.98F, 0.1F, 0.12F).normalized(), 2.6F};
}

CertifiedRay through_crooked(int number) {
  const TestRay ray = test_rays()[number];
  return {ray.origin, ray.direction, ray.t_max};
}

MediumChannels rgb_of(const std::vector<Component>& components) {
  MediumChannels channels;
  channels.count = kChannels;
  for (const Component& component : components) {
    ComponentChannels& target = channels.components.emplace_back();
    for (int c = 0; c < kChannels; ++c) {
      target.sigma_a[c] = component.sigma_a[c];
      target.sigma_s[c] = component.sigma_s[c];
      target.emission[c] = component.emission[c];
    }
  }
  return channels;
}

/// Extinctions from about 0.6 to 2.8, albedos from 0.3 to 0.9; of another component in other order.
ComponentChannels wavelengths_of(int count, int component) {
  ComponentChannels channels;
  for (int c = 0; c < count; ++c) {
    const auto share = static_cast<float>((c * (component == 0 ? 1 : 3) + component) % count) /
                       static_cast<float>(count);
    channels.sigma_s[c] = 0.3F + 2.2F * share * share;
    channels.sigma_a[c] = 0.3F + 0.4F * std::abs(share - 0.5F);
    channels.emission[c] = 0.5F + share;
  }
  return channels;
}

class MediaList {
 public:
  /// R, G and B of the components.
  void add(const char* name, std::vector<Component> components, const CertifiedRay& ray,
           int super_voxel = 8) {
    MediumChannels channels = rgb_of(components);
    add(name, std::move(components), std::move(channels), ray, super_voxel);
  }
  /// As many channels as there are wavelengths, each with a cross section and an albedo of its own.
  void add_wavelengths(const char* name, int count, std::vector<Component> components,
                       const CertifiedRay& ray) {
    MediumChannels channels;
    channels.count = count;
    for (std::size_t k = 0; k < components.size(); ++k) {
      channels.components.push_back(wavelengths_of(count, static_cast<int>(k)));
    }
    add(name, std::move(components), std::move(channels), ray, 4);
  }
  /// One component, its optical thickness in the thickest channel scaled to what is wanted.
  void add_thick(const char* name, double thickness, Component component, const CertifiedRay& ray) {
    const MediumChannels channels = rgb_of({component});
    const Medium medium({component});
    const RayProfile profile(medium, channels, ray, Interpolation::kNearest);
    double present = 0;
    for (int channel = 0; channel < kChannels; ++channel) {
      present = std::max(present, profile.depth(channel));
    }
    component.sigma_a *= static_cast<float>(thickness / present);
    component.sigma_s *= static_cast<float>(thickness / present);
    add(name, {component}, ray);
  }
  std::vector<CertifiedMedium> take() { return std::move(media_); }

 private:
  void add(const char* name, std::vector<Component> components, MediumChannels channels,
           const CertifiedRay& ray, int super_voxel) {
    auto tight = std::make_shared<const Medium>(std::move(components), super_voxel);
    auto loose = std::make_shared<const Medium>(tight->with_scaled_bounds(kLooseness));
    media_.push_back({name, std::move(tight), std::move(loose), std::move(channels), ray});
  }

  std::vector<CertifiedMedium> media_;
};

Component ramp() {
  return make_component(line(64, [](double x) { return 2 * x; }), kRedAbsorption, kRedScattering);
}

void add_lines(MediaList& list) {
  const auto constant = line(16, [](double) { return 1.0; });
  list.add("homogeneous, grey", {make_component(constant, kGreyAbsorption, kGreyScattering)},
           along_line());
  list.add("homogeneous, chromatic", {make_component(constant, kRedAbsorption, kRedScattering)},
           along_line());
  list.add("homogeneous, white, without emission",
           {make_component(constant, kNone, Rgb(2.0F), kNone)}, along_line());
  list.add("homogeneous, black", {make_component(constant, Rgb(1.0F, 2.0F, 3.0F), kNone)},
           along_line());
  list.add_thick("thickness 0.001", 1e-3, make_component(constant, kRedAbsorption, kRedScattering),
                 along_line());
  list.add_thick("thickness 10", 10, make_component(constant, kGreyAbsorption, kGreyScattering),
                 along_line());
  list.add_thick("thickness 1000", 1000, make_component(constant, kRedAbsorption, kRedScattering),
                 along_line());
  list.add("two boxes",
           {make_component(line(64, [](double x) { return x < 0.4 ? 0.3 : 1.7; }), kGreyAbsorption,
                           kGreyScattering)},
           along_line());
  list.add("ramp", {ramp()}, along_line());
  list.add("zeros",
           {make_component(line(96,
                                [](double x) {
                                  return x < 0.2 || (x > 0.5 && x < 0.7)    ? 0.0
                                         : std::abs(std::sin(40 * x)) < 0.3 ? 0.0
                                                                            : 2.0;
                                }),
                           kRedAbsorption, kRedScattering)},
           along_line());
}

void add_volumes(MediaList& list) {
  list.add("dense noise", {make_component(dense_noise(), kRedAbsorption, kRedScattering)},
           through_crooked(0), 4);
  list.add_thick("dense noise, thickness 1000", 1000,
                 make_component(dense_noise(), kGreyAbsorption, kGreyScattering),
                 through_crooked(1));
  list.add("sparse, chromatic", {make_component(sparse_field(), kBlueAbsorption, kBlueScattering)},
           {Vec3f(-2.0F, -0.1F, -0.15F), Vec3f(0.99F, 0.06F, 0.09F).normalized(), 4.0F}, 4);
  list.add("tiles", {make_component(tiles(), kGreyAbsorption, kGreyScattering)}, through_tiles());
  list.add("two components",
           {make_component(lumpy_field(0), kRedAbsorption, kRedScattering),
            make_component(lumpy_field(1), kBlueAbsorption, kBlueScattering, Rgb(0.3F, 1, 4))},
           through_crooked(0));
  list.add("three components",
           {make_component(lumpy_field(0), kRedAbsorption, kRedScattering),
            make_component(dense_noise(1), kBlueAbsorption, kBlueScattering, kNone),
            make_component(lumpy_field(2), Rgb(0.1F), kNone, Rgb(2.0F))},
           through_crooked(2));
  list.add("two transforms",
           {make_component(lumpy_field(0), kRedAbsorption, kRedScattering),
            make_component(turned_noise(), kBlueAbsorption, kBlueScattering)},
           through_crooked(0));
  list.add("RGB density",
           {make_component(lumpy_field(0), Rgb(0.5F, 0, 0), Rgb(1.5F, 0, 0)),
            make_component(lumpy_field(1), Rgb(0, 0.5F, 0), Rgb(0, 1.5F, 0)),
            make_component(lumpy_field(2), Rgb(0, 0, 0.5F), Rgb(0, 0, 1.5F))},
           through_crooked(0));
}

}  // namespace

const std::vector<CertifiedMedium>& certified_media() {
  static const std::vector<CertifiedMedium> kMedia = [] {
    MediaList list;
    add_lines(list);
    add_volumes(list);
    const CertifiedRay ray = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), 10};
    list.add_wavelengths("ramp, two wavelengths", 2, {ramp()}, along_line());
    list.add_wavelengths("dense noise, four wavelengths", 4,
                         {make_component(dense_noise(), kRedAbsorption, kRedScattering)},
                         through_crooked(0));
    list.add_wavelengths("two components, five wavelengths", 5,
                         {make_component(lumpy_field(0), kRedAbsorption, kRedScattering),
                          make_component(lumpy_field(1), kBlueAbsorption, kBlueScattering)},
                         through_crooked(0));
    list.add_wavelengths("dense noise, eight wavelengths", 8,
                         {make_component(dense_noise(2), kRedAbsorption, kRedScattering)},
                         through_crooked(2));
    if constexpr (kMaxChannels > 8) {  // a build for more than is usual
      list.add_wavelengths("dense noise, as many wavelengths as a path carries", kMaxChannels,
                           {make_component(dense_noise(2), kRedAbsorption, kRedScattering)},
                           through_crooked(2));
    }
    list.add("fixture A", FixtureA::medium(64, kFixtureVoxels).components(), ray, 64);
    return list.take();
  }();
  return kMedia;
}

double scattered_radiance(int component, int channel, double t) {
  constexpr double kOfComponent[] = {0.8, 0.3, 1.4};  // so that a wrong component shows
  return kOfComponent[component] + 0.3 * std::cos(3 * t + channel);
}

}  // namespace freepath::testing
