#include "freepath/transport/auto_tracker.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/transport/media_for_tests.h"

namespace freepath::testing {
namespace {

Medium cloud_of(const Rgb& sigma_s, const Rgb& sigma_a) {
  Component component;
  component.density = make_field(Vec3i(0), Vec3i(15), hash_noise);
  component.sigma_a = sigma_a;
  component.sigma_s = sigma_s;
  return Medium({component});
}

std::string choice(const Rgb& sigma_s, const Rgb& sigma_a) {
  return settle_picture_tracker("auto", cloud_of(sigma_s, sigma_a)).tracker;
}

// A path for each channel was 3.9 and 1.3 times as efficient as one path for all.
TEST(AutoTracker, ChannelsOfPicturesGoApartWhereExtinctionsDifferMuch) {
  EXPECT_EQ(choice({0.8F, 0.2F, 0.05F}, {0.002F, 0.01F, 0.05F}), "delta");
  EXPECT_EQ(choice({1, 0.7F, 0.5F}, Rgb(0.01F)), "delta");
  EXPECT_EQ(choice({1, 0.5F, 0}, Rgb(0.0F)), "delta");  // a channel that sees nothing
}

// Here it was 0.58, 0.9 and 0.6 times as efficient.
TEST(AutoTracker, ChannelsShareAPathWhereWeightsSpreadLittle) {
  EXPECT_EQ(choice({1, 0.9F, 0.8F}, Rgb(0.01F)), "spectral");
  EXPECT_EQ(choice({0.3F, 0.15F, 0.07F}, {0.7F, 0.35F, 0.18F}), "spectral");
  EXPECT_EQ(choice(Rgb(0.05F), {0.2F, 0.5F, 0.9F}), "spectral");
}

TEST(AutoTracker, WhatCarriesAllChannelsIsChosenForThem) {
  const Medium medium = cloud_of({0.8F, 0.2F, 0.05F}, {0.002F, 0.01F, 0.05F});
  EXPECT_EQ(settle_tracker("auto", medium).tracker, "spectral");
}

TEST(AutoTracker, GreyMediaAndNamesStayAsTheyAre) {
  EXPECT_EQ(choice(Rgb(1.0F), Rgb(0.1F)), "delta");
  EXPECT_EQ(settle_picture_tracker("ratio", cloud_of({1, 0, 0}, Rgb(0.0F))).tracker, "ratio");
}

}  // namespace
}  // namespace freepath::testing
