#include "freepath/media/medium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Component component_of(std::shared_ptr<const Field> field) {
  Component component;
  component.density = std::move(field);
  return component;
}

Component plain() { return component_of(make_field(Vec3i(0), Vec3i(5), hash_noise)); }

/// Scaled differently along each axis, mirrored, turned and moved.
Matrix4d crooked_transform() {
  Matrix4d matrix;
  matrix.setScale(Vec3d(0.5, 2, -0.25));
  matrix *= Matrix4d().rotate(Vec3d(0.3, -1.1, 2.0));
  matrix *= Matrix4d().setTranslation(Vec3d(10, -20, 30));
  return matrix;
}

/// What the constructor complains of; empty if it does not.
std::string complaint(const std::vector<Component>& components) {
  try {
    const Medium medium(components);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Medium, HasNoSpreadOfBoundsWhereItEndsAtTheMiddlesOfEqualVoxels) {
  const auto share_of_minima = [](const std::function<float(const Vec3i&)>& density) {
    const Medium medium({component_of(make_field(Vec3i(0), Vec3i(2), density))});
    EXPECT_EQ(summarize(medium.super_voxels()).mean_minimum, 0) << "it fades beyond";
    const SuperVoxelSummary cells = summarize(medium.clipped_to_middles().super_voxels());
    EXPECT_GT(cells.mean_maximum, 0);
    return cells.mean_minimum / cells.mean_maximum;
  };
  EXPECT_EQ(share_of_minima([](const Vec3i&) { return 0.7F; }), 1);
  EXPECT_EQ(share_of_minima([](const Vec3i& p) { return p == Vec3i(1) ? 0.8F : 0.7F; }), 0);
}

TEST(Medium, RefusesCoefficientsThatAreNegativeOrNotFinite) {
  for (const float bad : {-1.0F, -1e-30F, kNan, kInfinity}) {
    for (int channel = 0; channel < kChannels; ++channel) {
      const std::pair<const char*, Rgb Component::*> members[] = {
          {"sigma_a", &Component::sigma_a},
          {"sigma_s", &Component::sigma_s},
          {"emission", &Component::emission}};
      for (const auto& [name, member] : members) {
        Component component = plain();
        (component.*member)[channel] = bad;
        const std::string message = complaint({plain(), component});
        EXPECT_EQ(message.find("component 1: " + std::string(name) + " of channel " +
                               std::to_string(channel)),
                  0U)
            << message;
      }
    }
  }
}

TEST(Medium, RefusesCoefficientsWhoseSumOrProductOverflows) {
  Component component = plain();
  component.sigma_a = component.sigma_s = Rgb(1, 2e38F, 1);
  EXPECT_EQ(
      complaint({component}),
      "component 0: sigma_a + sigma_s of channel 1 is inf; it must be finite and not negative");
  component.sigma_s = Rgb(1.0F);
  component.emission = Rgb(1, 1, 1e38F);
  EXPECT_EQ(complaint({component}), "");
  component.emission = Rgb(1, 2, 1);
  EXPECT_EQ(complaint({component}),
            "component 0: sigma_a · emission of channel 1 is inf; it must be finite and not "
            "negative");
}

TEST(Medium, HasOneToSixteenComponents) {
  EXPECT_EQ(complaint({}), "a medium has 1 to 16 components, not 0");
  EXPECT_EQ(complaint(std::vector<Component>(16, plain())), "");
  EXPECT_EQ(complaint(std::vector<Component>(17, plain())),
            "a medium has 1 to 16 components, not 17");
}

TEST(Medium, RefusesFieldsWithoutVoxels) {
  EXPECT_EQ(complaint({component_of(nullptr)}), "component 0: its density has no active voxel");
  EXPECT_EQ(complaint({plain(), component_of(std::make_shared<Field>())}),
            "component 1: its density has no active voxel");
}

TEST(Medium, IsAlignedWhereFieldsShareTransformAndBricks) {
  const auto turned = make_field(Vec3i(0), Vec3i(5), hash_noise, crooked_transform());
  const auto larger = make_field(Vec3i(0), Vec3i(50), hash_noise);
  for (const auto& other : {turned, larger}) {
    EXPECT_FALSE(Medium({plain(), component_of(other)}).aligned());
    EXPECT_TRUE(Medium({component_of(other), component_of(other)}).aligned());
  }
  // Active voxels may differ where the bricks are the same.
  EXPECT_TRUE(
      Medium({plain(), component_of(make_field(Vec3i(1), Vec3i(4), hash_noise))}).aligned());
}

TEST(Medium, RefusesOneMapFromTheWorldForFieldsThatDiffer) {
  const Component larger = component_of(make_field(Vec3i(0), Vec3i(50), hash_noise));
  try {
    const Medium medium({plain(), larger}, 4, Matrix4d());
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "fields that differ in transform or bounds can't be given one map from the world");
  }
}

TEST(Medium, RefusesATransformWithoutInverseUnlessGivenOne) {
  Matrix4d flat;
  flat.setScale(Vec3d(1, 1, 0));
  const Component component = component_of(make_field(Vec3i(0), Vec3i(5), hash_noise, flat));
  EXPECT_EQ(complaint({component}), "grid 'test': its transform has no inverse");
  EXPECT_NO_THROW(Medium({component}, 4, Matrix4d()));
}

TEST(Medium, RefusesATransformThatIsNotFinite) {
  for (const double bad : {double{kNan}, double{kInfinity}}) {
    Matrix4d matrix;
    matrix[1][1] = bad;
    const Component component = component_of(make_field(Vec3i(0), Vec3i(5), hash_noise, matrix));
    for (const auto& components : {std::vector{component}, std::vector{plain(), component}}) {
      EXPECT_EQ(complaint(components), "grid 'test': its transform is not finite; set another");
    }
  }
}

TEST(Medium, RefusesSuperVoxelsOfOtherSizes) {
  EXPECT_THROW(Medium({plain()}, 7), Error);
  EXPECT_EQ(Medium({plain()}, 16).super_voxels().cell_size, 16);
}

TEST(Medium, WorldBoundsAreTheBoxAroundItsTurnedVoxels) {
  const Vec3i low(-4, 2, 7);
  const Vec3i high(9, 8, 20);
  const Medium medium({component_of(make_field(low, high, hash_noise, crooked_transform()))});
  Box3d expected;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d index((corner & 1) != 0 ? high.x + 0.5 : low.x - 0.5,
                      (corner & 2) != 0 ? high.y + 0.5 : low.y - 0.5,
                      (corner & 4) != 0 ? high.z + 0.5 : low.z - 0.5);
    expected.extendBy(index * crooked_transform());
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(medium.world_bounds().min[axis], expected.min[axis], 1e-12);
    EXPECT_NEAR(medium.world_bounds().max[axis], expected.max[axis], 1e-12);
  }
}

TEST(Medium, WorldBoundsOfAMirroredFieldAreOrdered) {
  Matrix4d mirror;
  mirror.setScale(Vec3d(-1, 1, -2));
  const Medium medium({component_of(make_field(Vec3i(0), Vec3i(3), hash_noise, mirror))});
  EXPECT_EQ(medium.world_bounds().min, Vec3d(-3.5, -0.5, -7));
  EXPECT_EQ(medium.world_bounds().max, Vec3d(0.5, 3.5, 1));
}

TEST(Medium, BoundsHoldAllComponents) {
  const Medium medium({component_of(make_field(Vec3i(0), Vec3i(2), hash_noise)),
                       component_of(make_field(Vec3i(1), Vec3i(5), hash_noise))},
                      4);
  EXPECT_EQ(medium.world_bounds().min, Vec3d(-0.5));
  EXPECT_EQ(medium.world_bounds().max, Vec3d(5.5));
  // The index begins at voxel -8, and a cell has four.
  const Box3f nearest = medium.walk_bounds(Interpolation::kNearest);
  EXPECT_EQ(nearest.min, Vec3f(8.0F / 4));
  EXPECT_EQ(nearest.max, Vec3f(14.0F / 4));
  // The trilinear filter reaches to the centres of the voxels around.
  for (const Interpolation filtered : {Interpolation::kTrilinear, Interpolation::kStochastic}) {
    EXPECT_EQ(medium.walk_bounds(filtered).min, Vec3f(7.5F / 4));
    EXPECT_EQ(medium.walk_bounds(filtered).max, Vec3f(14.5F / 4));
  }
}

TEST(Medium, WorldToWalkPutsVoxelCentresIntoTheMiddleOfTheirPlace) {
  const Vec3i low(-14, 2, 7);
  const Vec3i high(9, 18, 20);
  for (const Matrix4d& matrix : {Matrix4d(), crooked_transform()}) {
    const auto field = make_field(low, high, hash_noise, matrix);
    for (const int size : kSuperVoxelSizes) {
      const Medium medium({component_of(field)}, size);
      const AffineMap& map = medium.world_to_walk();
      for (const Vec3i& voxel : {low, high, Vec3i(0, 5, 9), Vec3i(-8, 8, 16)}) {
        const Vec3d world = Vec3d(voxel) * matrix;
        for (int axis = 0; axis < 3; ++axis) {
          double walk = map.offset[axis];
          for (int from = 0; from < 3; ++from) walk += world[from] * map.linear[from][axis];
          const double expected = (voxel[axis] - field->voxels.origin()[axis] + 0.5) / size;
          EXPECT_NEAR(walk, expected, 1e-4 / size) << voxel << ", cells of " << size;
        }
      }
    }
  }
}

// Relative to a point near it, the map of a medium does not depend on where in the world it is.
TEST(Medium, WorldToWalkRelativeToAPointNearByHasNoDistance) {
  const Vec3i low(-14, 2, 7);
  const Vec3i high(9, 18, 20);
  const Vec3d near(11, -20, 29);
  const auto map_at = [&](const Vec3d& origin) {
    const Matrix4d matrix = crooked_transform() * Matrix4d().setTranslation(origin);
    const Medium medium({component_of(make_field(low, high, hash_noise, matrix))}, 4);
    return medium.world_to_walk(near + origin);
  };
  const AffineMap here = map_at(Vec3d(0));
  for (const double distance : {1e6, 1e9}) {
    const AffineMap there = map_at(Vec3d(distance, -distance, 2 * distance));
    EXPECT_EQ(there.linear, here.linear);
    for (int axis = 0; axis < 3; ++axis) {
      // Doubles at this distance, divided by the smallest edge of a voxel, and a few roundings.
      const double rounding = 2 * distance * 0x1p-53 / 0.25 * 16;
      EXPECT_NEAR(there.offset[axis], here.offset[axis], rounding) << distance;
      EXPECT_LT(rounding, 2e-5);
    }
  }
}

/// What an albedo makes of an extinction that is one for all channels.
Component coloured(std::shared_ptr<const Field> field, const Rgb& albedo, float sigma_t,
                   float scale) {
  Component component = component_of(std::move(field));
  component.sigma_a = (Rgb(1.0F) - albedo) * sigma_t * scale;
  component.sigma_s = albedo * sigma_t * scale;
  return component;
}

// Each difference, product and sum rounds on its own; one path must carry all channels nonetheless.
TEST(Medium, ExtinctionStaysGreyUnderAnyAlbedo) {
  const auto field = plain().density;
  RandomStream random(3, 0, 0, 0);
  int rounded = 0;
  for (int i = 0; i < 3000; ++i) {
    const Rgb albedo(random.uniform(), 1 - 0x1p-20F * random.uniform(), random.uniform());
    const float sigma_t = std::exp(20 * random.uniform() - 10);
    for (const float scale : {1.0F, 0.3F, random.uniform() + 0.01F}) {
      const Component component = coloured(field, albedo, sigma_t, scale);
      if (!is_grey(component.sigma_t())) ++rounded;
      const Medium medium({component}, 8);
      ASSERT_TRUE(medium.has_grey_extinction()) << albedo << ' ' << sigma_t << ' ' << scale;
    }
  }
  EXPECT_GT(rounded, 1000) << "rounding was not put to the test";
}

TEST(Medium, ExtinctionIsGreyUnlessAComponentIsNot) {
  const Component colourful = coloured(plain().density, Rgb(0.9F, 0.7F, 0.1F), 3, 0.3F);
  const Medium grey({colourful, plain()});
  EXPECT_TRUE(grey.has_grey_extinction());
  EXPECT_FALSE(grey.is_grey());
  EXPECT_TRUE(Medium({plain()}).has_grey_extinction());
  EXPECT_TRUE(Medium({plain()}).is_grey());
  for (int channel = 0; channel < kChannels; ++channel) {
    Component component = colourful;
    component.sigma_a[channel] += 1e-4F;
    EXPECT_FALSE(Medium({plain(), component}).has_grey_extinction()) << channel;
  }
}

TEST(Medium, IsGreyOnlyIfEmissionIsToo) {
  Component component = plain();
  component.emission = Rgb(1, 1, 2);
  EXPECT_TRUE(Medium({component}).has_grey_extinction());
  EXPECT_FALSE(Medium({component}).is_grey());
  component.emission = Rgb(2.0F);
  EXPECT_TRUE(Medium({component}).is_grey());
}

TEST(Medium, EmitsIfAComponentAbsorbsAndEmits) {
  Component component = plain();
  component.emission = Rgb(1.0F);
  EXPECT_FALSE(Medium({component}).emits());
  component.sigma_a = Rgb(0.5F);
  EXPECT_TRUE(Medium({component}).emits());
  EXPECT_TRUE(Medium({plain(), component}).emits());
  component.emission = Rgb(0.0F);
  EXPECT_FALSE(Medium({component}).emits());
}

}  // namespace
}  // namespace freepath::testing
