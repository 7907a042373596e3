// The table through which colours become spectra, and the spectra of images that emit light.

#include "freepath/spectra/reflectance_table.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/spectra/light_table.h"
#include "tests/spectra/largest_difference.h"

namespace freepath {
namespace {

using testing::largest_difference;

const RgbColorSpace& srgb() { return rgb_color_space("srgb"); }

/// The colour that the observer sees of a reflectance under the white of the space.
template <class Reflectance>
Vec3d seen(const Reflectance& reflectance, const RgbColorSpace& space) {
  Vec3d rgb(0);
  const auto weights = space.reflectance_weights();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    rgb += weights[i] * reflectance(kShortestWavelength + 2.0 * static_cast<double>(i));
  }
  return rgb;
}

/// The same as an integral over steps of 0.1 nm.
template <class Reflectance>
Vec3d integrated(const Reflectance& reflectance, const RgbColorSpace& space) {
  Vec3d xyz(0);
  for (int i = 0; i < 4700; ++i) {
    const double lambda = kShortestWavelength + 0.1 * (i + 0.5);
    xyz += color_matching(lambda) *
           (0.1 / kLuminousIntegral * space.illuminant()(lambda) * reflectance(lambda));
  }
  return space.from_xyz(xyz);
}

std::vector<Vec3d> random_colours(int count, double least, double most) {
  RandomStream random(7, 0, 0, 0);
  std::vector<Vec3d> colours;
  for (int i = 0; i < count; ++i) {
    Vec3d rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = least + (most - least) * random.uniform();
    colours.push_back(rgb);
  }
  return colours;
}

const std::vector<Vec3d> kExtremes = {
    {1, 0, 0},    {0, 1, 0},           {0, 0, 1},           {1, 1, 0},      {0, 1, 1},
    {1, 0, 1},    {0, 0, 0},           {1, 1, 1},           {1, 1, 0.99},   {1, 0.99, 0.99},
    {0.5, 0, 0},  {0, 0.5, 0.5},       {1e-9, 0, 0},        {1e-300, 0, 0}, {1e-6, 2e-6, 3e-6},
    {0, 1e-3, 0}, {1, 1, 1 - 0x1p-53}, {1 - 1e-9, 1, 1e-9}, {0.5, 0.5, 0.1}};

TEST(ReflectanceTable, GivesTheFitsAtItsNodes) {
  const ReflectanceTable& table = srgb().reflectances();
  for (const int slice : {5, 20, 31, 50, 63}) {
    const double size = ReflectanceTable::level(slice);
    for (const auto& [second, third] : {std::pair{0, 0}, {63, 0}, {10, 40}, {62, 62}, {7, 63}}) {
      for (int largest = 0; largest < 3; ++largest) {
        Vec3d rgb;
        rgb[largest] = size;
        rgb[(largest + 1) % 3] = size * second / 63;
        rgb[(largest + 2) % 3] = size * third / 63;
        const SigmoidPolynomial expected = fit_reflectance(rgb, srgb());
        const SigmoidPolynomial found = table(rgb);
        for (double wavelength = 360; wavelength <= 830; wavelength += 47) {
          EXPECT_NEAR(found(wavelength), expected(wavelength), 1e-9) << rgb;
        }
      }
    }
  }
}

TEST(ReflectanceTable, GreysAreExactlyConstant) {
  for (const double grey : {0.0, 1e-9, 0.18, 0.5, 1.0}) {
    const SigmoidPolynomial found = srgb().reflectances()(Vec3d(grey));
    EXPECT_EQ(found.c[0], 0);
    EXPECT_EQ(found.c[1], 0);
    EXPECT_NEAR(found(555), grey, 1e-15);
  }
}

TEST(ReflectanceTable, ColoursComeBackButForWhatItInterpolates) {
  const std::vector<Vec3d> colours = random_colours(300, 0.05, 0.9);
  double sum = 0;
  for (const Vec3d& rgb : colours) {
    const double size = std::max({rgb.x, rgb.y, rgb.z});
    const double off = largest_difference(seen(srgb().reflectances()(rgb), srgb()), rgb) / size;
    EXPECT_LT(off, 0.003) << rgb;
    sum += off;
  }
  EXPECT_LT(sum / static_cast<double>(colours.size()), 0.0005);
}

/// Between slices of the table, which are a factor apart in the dark, little of a colour is lost in
/// the middle and much at the dark end.
TEST(ReflectanceTable, DarkColoursAreOffAsTheSlicesOfTheTableAreApart) {
  struct Band {
    double size, most;
  };
  for (const Band& band : {Band{0.1, 0.01}, Band{0.03, 0.03}, Band{0.002, 0.12}}) {
    for (const Vec3d& colour : random_colours(50, 0, band.size)) {
      const double size = std::max({colour.x, colour.y, colour.z});
      const Vec3d rgb = colour * (band.size / size);
      const Vec3d found = seen(srgb().reflectances()(rgb), srgb());
      EXPECT_LT(largest_difference(found, rgb), band.most * band.size) << rgb;
    }
  }
}

/// Means of pictures of pbrt-v4 where such a light is seen directly, relative to the colour given,
/// with a standard error of 4e-5.
TEST(ReflectanceTable, IsOffWhereAndAsMuchAsThePublishedTable) {
  struct Light {
    Vec3d rgb;
    double red, green;
  };
  for (const Light& light :
       {Light{{0.32, 0.48, 0.8}, -1.04e-3, -0.63e-3}, Light{{0.08, 0.1, 0.14}, -0.73e-3, -0.48e-3},
        Light{{0.02, 0.025, 0.03}, -0.56e-3, -0.27e-3}}) {
    const RgbSpectrum spectrum = RgbSpectrum::unbounded(light.rgb, srgb());
    const Vec3d found = seen(spectrum, srgb()) / light.rgb;
    EXPECT_NEAR(found.x - 1, light.red, 2.5e-4);
    EXPECT_NEAR(found.y - 1, light.green, 2.5e-4);
  }
}

TEST(ReflectanceTable, ExtremeColoursGiveFiniteValuesNearThem) {
  for (const char* name : {"srgb", "aces2065-1"}) {
    const RgbColorSpace& space = rgb_color_space(name);
    for (const Vec3d& rgb : kExtremes) {
      const SigmoidPolynomial found = space.reflectances()(rgb);
      for (double wavelength = 360; wavelength <= 830; wavelength += 10) {
        ASSERT_GE(found(wavelength), 0) << rgb;
        ASSERT_LE(found(wavelength), 1) << rgb;
      }
      if (&space == &srgb()) {
        EXPECT_LT(largest_difference(seen(found, space), rgb), 0.02) << rgb;
      }
    }
  }
}

TEST(ReflectanceTable, RefusesWhatIsNoColour) {
  const ReflectanceTable& table = srgb().reflectances();
  EXPECT_THROW(table({0.1, 1.01, 0.2}), Error);
  EXPECT_THROW(table({0.5, -0.1, 0.2}), Error);
  EXPECT_THROW(table({0.5, std::nan(""), 0.2}), Error);
  EXPECT_THROW(table({std::nan(""), 0.5, 0.2}), Error);
}

TEST(ReflectanceTable, IsTheSameInWhateverOrderAndByHoweverManyItIsAsked) {
  const std::vector<Vec3d> colours = random_colours(200, 0, 1);
  const ReflectanceTable forwards(srgb());
  const ReflectanceTable together(srgb());
  std::vector<SigmoidPolynomial> expected(colours.size());
  std::vector<SigmoidPolynomial> found(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) expected[i] = forwards(colours[i]);
  tbb::parallel_for(std::size_t{0}, 4 * colours.size(), [&](std::size_t i) {
    const std::size_t one = colours.size() - 1 - i % colours.size();
    const SigmoidPolynomial polynomial = together(colours[one]);
    if (i < colours.size()) found[one] = polynomial;
  });
  for (std::size_t i = 0; i < colours.size(); ++i) EXPECT_EQ(found[i].c, expected[i].c);
}

TEST(LightTable, IsWhatAConstantLightOfTheColourIs) {
  const LightTable table(srgb());
  std::vector<Vec3d> colours = random_colours(300, 0, 5);
  colours.insert(colours.end(), kExtremes.begin(), kExtremes.end());
  for (const Vec3d& wide : colours) {
    const Vec3f rgb(wide);  // which may be 0 or grey where the wide one is not
    const RgbSpectrum expected = RgbSpectrum::unbounded(Vec3d(rgb), srgb());
    const LightTable::Light found = table.light(rgb);
    const double size = std::max({rgb.x, rgb.y, rgb.z});
    for (double wavelength = 360; wavelength <= 830; wavelength += 10) {
      const auto u = static_cast<float>(SigmoidPolynomial::coordinate(wavelength));
      ASSERT_NEAR(found(u), expected(wavelength), 1e-5 * size) << rgb << wavelength;
    }
  }
}

TEST(LightTable, KnowsTheColourOfItsSpectra) {
  const LightTable table(srgb());
  std::vector<Vec3d> colours = random_colours(300, 0, 5);
  colours.insert(colours.end(), kExtremes.begin(), kExtremes.end());
  for (const Vec3d& wide : colours) {
    const Vec3f rgb(wide);
    const Vec3d expected = integrated(RgbSpectrum::unbounded(Vec3d(rgb), srgb()), srgb());
    const double size = std::max({rgb.x, rgb.y, rgb.z});
    EXPECT_LE(largest_difference(Vec3d(table.seen(rgb)), expected), 2e-5 * size) << rgb;
  }
  EXPECT_EQ(table.seen(Vec3f(0.7F)), Vec3f(0.7F));
}

TEST(LightTable, ReturnsColoursOfAnySizeAndNeverNaN) {
  const LightTable table(srgb());
  for (const float size : {1e-20F, 1.0F, 1e30F}) {
    for (const Vec3f& direction : {Vec3f(1, 0, 0), Vec3f(0, 1, 1), Vec3f(0.2F, 0.4F, 0.9F)}) {
      const Vec3f rgb = direction * size;
      const Vec3f found = table.seen(rgb);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / size, rgb[c] / size, 0.01) << rgb;
      for (const float u : {-1.0F, 0.0F, 0.7F}) {
        const float value = table.light(rgb)(u);
        EXPECT_TRUE(value >= 0 && value <= 2.01F * size) << value << rgb;
      }
    }
  }
  for (const Vec3f& rgb : {Vec3f(0), Vec3f(0, 0, 1e-44F), Vec3f(1e-32F, 0, 0)}) {
    EXPECT_EQ(table.seen(rgb), Vec3f(0));
    EXPECT_EQ(table.light(rgb)(0.5F), 0);
  }
}

TEST(LightTable, IsTheSameForHoweverManyAsk) {
  const std::vector<Vec3d> colours = random_colours(200, 0, 3);
  const LightTable alone(srgb());
  const LightTable together(srgb());
  std::vector<Vec3f> found(colours.size() * 4);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
    found[i] = together.seen(Vec3f(colours[i % colours.size()]));
  });
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i], alone.seen(Vec3f(colours[i % colours.size()])));
  }
}

}  // namespace
}  // namespace freepath
