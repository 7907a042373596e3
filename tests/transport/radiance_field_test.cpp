// Emission that varies from place to place, against quadrature, by every null-collision tracker and
// in four channels.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/transport/kernels.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath {
namespace {

using testing::crooked_transform;
using testing::integrate;
using testing::lumpy_field;
using testing::make_field;
using testing::RayIntegrals;
using testing::Tally;
using testing::TestRay;

constexpr float kTableFirst = 0.1F;
constexpr float kTableStep = 0.02F;

/// Steep, as that of a fire is.
float steep(float value, int channel) {
  return std::exp(4 * value) * static_cast<float>(1 + channel);
}

/// Two components: one glows by a temperature that stands otherwise in the world, by a table; the
/// other by a field of radiance for each channel.
/// SampledSpectrum; no walk is compiled for so many, so that one of more repeats some.
constexpr int kCount = 5;

struct GlowingMedium {
  std::vector<std::shared_ptr<const Field>> densities = {lumpy_field(1), lumpy_field(2)};
  std::shared_ptr<const Field> temperature = make_temperature();
  std::vector<std::shared_ptr<const Field>> radiances;
  Medium medium;
  MediumChannels channels;

  GlowingMedium() : medium(make_medium(densities)) {
    channels.count = kCount;
    channels.components.resize(2);
    for (int c = 0; c < kCount; ++c) {
      radiances.push_back(lumpy_field(10 + c));
      ComponentChannels& fire = channels.components[0];
      fire.sigma_a[c] = 0.8F + 0.1F * static_cast<float>(c);
      fire.sigma_s[c] = 0.5F - 0.1F * static_cast<float>(c);
      fire.emission[c] = 0.25F;
      fire.radiance[c] = {temperature, make_table(c), kTableFirst, kTableStep};
      ComponentChannels& glow = channels.components[1];
      glow.sigma_a[c] = 0.3F;
      glow.sigma_s[c] = 0.4F * static_cast<float>(c);
      glow.emission[c] = 2.0F;
      glow.radiance[c] = {radiances.back(), nullptr, 0, 1};
    }
  }

  static std::shared_ptr<const Field> make_temperature() {
    Matrix4d transform;
    transform.setScale(Vec3d(0.3, 0.4, 0.25));
    transform *= Matrix4d().rotate(Vec3d(-0.2, 0.1, 0.4));
    return make_field(Vec3i(-6), Vec3i(6), testing::hash_noise, transform);
  }
  static std::shared_ptr<const std::vector<float>> make_table(int channel) {
    std::vector<float> table;
    for (float value = kTableFirst; value < 0.9F; value += kTableStep) {
      table.push_back(steep(value, channel));
    }
    return std::make_shared<const std::vector<float>>(std::move(table));
  }
  static Medium make_medium(const std::vector<std::shared_ptr<const Field>>& fields) {
    std::vector<Component> components(2);
    for (int k = 0; k < 2; ++k) {
      components[k].density = fields[k];
      components[k].sigma_a = Rgb(1.1F);
      components[k].sigma_s = Rgb(0.5F);
    }
    return Medium(std::move(components), 4);
  }

  /// What the two fields say of a channel at a point.
  double radiance(int component, int channel, const Vec3d& world) const {
    const Field& field = component == 0 ? *temperature : *radiances[channel];
    const double value = field.voxels.interpolate(world * field.index_to_world.inverse());
    if (component == 1) return 2.0 * value;
    const auto& table = *channels.components[0].radiance[channel].table;
    const double position =
        std::clamp((value - kTableFirst) / kTableStep, 0.0, static_cast<double>(table.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(position), table.size() - 2);
    const double part = position - static_cast<double>(i);
    return 0.25 * (table[i] * (1 - part) + table[i + 1] * part);
  }

  /// ∫ T Σ_k ρ_k sigma_a,k L_k dt by the midpoint rule.
  double emitted(const TestRay& ray, int channel) const {
    constexpr int kSteps = 20000;
    const double step = ray.t_max / double{kSteps};
    double depth = 0;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const Vec3d world = Vec3d(ray.origin) + Vec3d(ray.direction) * ((i + 0.5) * step);
      double sigma_t = 0;
      double source = 0;
      for (int k = 0; k < 2; ++k) {
        const Field& field = *densities[k];
        const double density = field.voxels.interpolate(world * field.index_to_world.inverse());
        const ComponentChannels& values = channels.components[k];
        sigma_t += density * (values.sigma_a[channel] + values.sigma_s[channel]);
        source += density * values.sigma_a[channel] * radiance(k, channel, world);
      }
      sum += std::exp(-depth - 0.5 * sigma_t * step) * source * step;
      depth += sigma_t * step;
    }
    return sum;
  }
};

const GlowingMedium& glowing() {
  static const GlowingMedium kMedium;
  return kMedium;
}

std::vector<std::string> null_collision_trackers() {
  std::vector<std::string> names;
  for (const Kernel& kernel : kernels(Simd::kBest).trackers) {
    if (!kernel.uniform_emission) names.emplace_back(kernel.info.name);
  }
  return names;
}

class RadianceField : public ::testing::TestWithParam<std::string> {};

TEST_P(RadianceField, IsCollectedAsQuadratureSays) {
  const GlowingMedium& glow = glowing();
  for (const Interpolation interpolation :
       {Interpolation::kTrilinear, Interpolation::kStochastic}) {
    WalkSettings settings;
    settings.tracker = GetParam();
    settings.interpolation = interpolation;
    settings.seed = 17;
    const bool shared = shares_paths(glow.channels, settings);
    constexpr std::size_t kPaths = 60'000;
    for (const TestRay& ray : testing::test_rays()) {
      Tally tally[kCount];
      for (int turn = 0; turn < (shared ? 1 : kCount); ++turn) {
        const Walker walker(glow.medium, shared ? glow.channels : glow.channels.only(turn),
                            settings);
        for_each_flight(walker, ray, kPaths, [&](const FlightStream& flights, std::size_t i) {
          for (int c = 0; c < walker.channels(); ++c) {
            tally[shared ? c : turn].add(flights.emitted[c][i]);
          }
        });
      }
      for (int c = 0; c < kCount; ++c) {
        const double expected = glow.emitted(ray, c);
        ASSERT_GT(expected, 0.01);
        // 22 cases of 30 numbers: beyond 4.9 standard errors at a family-wise 1e-3 or so.
        EXPECT_NEAR(tally[c].mean(kPaths), expected, 4.9 * tally[c].standard_error(kPaths))
            << testing::name_of(interpolation) << ", channel " << c;
        EXPECT_LT(tally[c].standard_error(kPaths), 0.02 * expected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RadianceField, ::testing::ValuesIn(null_collision_trackers()),
                         [](const auto& param) {
                           std::string name = param.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(RadianceFields, AreRefusedByMethodsThatKnowOneRadiance) {
  WalkSettings settings;
  settings.tracker = "regular";
  settings.interpolation = Interpolation::kTrilinear;
  try {
    const Walker walker(glowing().medium, glowing().channels.only(0), settings);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("take a null-collision tracker"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace freepath
