// Named scattering properties: spot checks, units and names.

#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "freepath/scene/assembly/scattering_presets.h"

namespace freepath {
namespace {

void expect_preset(std::string_view name, const Vec3d& sigma_prime_s, const Vec3d& sigma_a) {
  const auto found = find_scattering_preset(name);
  ASSERT_TRUE(found) << name;
  for (int i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(found->sigma_prime_s[i], sigma_prime_s[i]) << name << " channel " << i;
    EXPECT_DOUBLE_EQ(found->sigma_a[i], sigma_a[i]) << name << " channel " << i;
  }
}

// The table of [Jensen01, Fig. 5] as pbrt lists it.
TEST(ScatteringPresets, AreThoseOfJensenAndOthers) {
  expect_preset("Apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046});
  expect_preset("Marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071});
  expect_preset("Skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48});
  expect_preset("Spectralon", {11.6, 20.4, 14.9}, {0, 0, 0});
  expect_preset("Wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014});
}

/// Coefficients of one liquid in 23 litres of water, which agree with the preset in all its digits.
/// They are those of [Narasimhan06] from memory, not compared with the printed table.
struct Dilution {
  std::string_view name;
  double millilitres;
  Vec3d sigma_t, sigma_s;  ///< [0.01/mm]
  Vec3d g;
};

TEST(ScatteringPresets, AreThoseOfNarasimhanAndOthersWithoutTheWater) {
  const Dilution dilutions[] = {
      {"Lowfat Milk", 16, {0.9126, 1.0748, 1.2500}, {0.9124, 1.0744, 1.2492}, {.932, .902, .859}},
      {"Coke", 1600, {0.7143, 1.1688, 1.7169}, {0.0177, 0.0208, 0}, {.965, .972, 1}},
  };
  for (const Dilution& diluted : dilutions) {
    const auto found = find_scattering_preset(diluted.name);
    ASSERT_TRUE(found) << diluted.name;
    const double factor = 0.01 * 23000 / diluted.millilitres;
    for (int i = 0; i < 3; ++i) {
      const double sigma_prime_s = factor * (1 - diluted.g[i]) * diluted.sigma_s[i];
      const double sigma_a = factor * (diluted.sigma_t[i] - diluted.sigma_s[i]);
      // The table has five digits.
      EXPECT_NEAR(found->sigma_prime_s[i], sigma_prime_s, 5e-5 * sigma_prime_s) << diluted.name;
      EXPECT_NEAR(found->sigma_a[i], sigma_a, 5e-5 * sigma_a) << diluted.name;
    }
  }
}

TEST(ScatteringPresets, HaveNamesAndPossibleCoefficients) {
  const std::set<std::string_view> names(scattering_preset_names().begin(),
                                         scattering_preset_names().end());
  // 12 materials of the one paper and 35 of the other.
  EXPECT_EQ(names.size(), 47U);
  EXPECT_EQ(scattering_preset_names().size(), 47U);
  for (const std::string_view name : names) {
    const auto found = find_scattering_preset(name);
    ASSERT_TRUE(found) << name;
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(found->sigma_prime_s[i], 0) << name;
      EXPECT_GE(found->sigma_a[i], 0) << name;
      EXPECT_LT(found->sigma_a[i] + found->sigma_prime_s[i], 100) << name;
    }
  }
}

TEST(ScatteringPresets, UnknownNamesHaveNone) {
  EXPECT_FALSE(find_scattering_preset("apple"));
  EXPECT_FALSE(find_scattering_preset(""));
}

}  // namespace
}  // namespace freepath
