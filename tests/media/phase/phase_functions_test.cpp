#include "freepath/media/phase/phase_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/base/tangent_frame.h"
#include "freepath/media/phase/parse_phase_function.h"
#include "tests/statistics.h"

namespace freepath {
namespace {

using testing::check_chi_square;
using testing::chi_square_test;
using testing::RunningStatistics;

// --- What is tested: every name that the parser knows, and what no name can say. ----------------

PhaseFunction table(std::initializer_list<PhaseTablePoint> points) {
  return PhaseFunction::tabulated(std::vector<PhaseTablePoint>(points));
}

/// Like a cloud's: a narrow peak, a fog bow and a glory.
PhaseFunction cloud_table() {
  return table({{0, 4000},
                {0.5, 2500},
                {1, 700},
                {2, 90},
                {5, 20},
                {10, 9},
                {30, 1.5},
                {60, 0.2},
                {90, 0.05},
                {120, 0.04},
                {135, 0.09},
                {142, 0.2},
                {150, 0.1},
                {170, 0.08},
                {178, 0.2},
                {179, 0.35},
                {180, 0.3}});
}

struct Case {
  std::string name;
  PhaseFunction function;
};

/// How GoogleTest shows a case.
void PrintTo(const Case& shown, std::ostream* out) {  // NOLINT(readability-identifier-naming)
  *out << shown.name;
}

/// Texts for each name.
const std::map<std::string_view, std::vector<std::string>> kExamples = {
    {"isotropic", {"isotropic"}},
    {"henyey-greenstein",
     {"henyey-greenstein:g=1e-4", "henyey-greenstein:g=-0.5", "henyey-greenstein:g=0.85",
      "henyey-greenstein:g=0.999"}},
    {"rayleigh", {"rayleigh"}},
    {"draine",
     {"draine:g=0,alpha=0", "draine:g=0,alpha=1", "draine:g=1e-5,alpha=250",
      "draine:g=-0.3,alpha=1e-5", "draine:g=0.5,alpha=1", "draine:g=-0.7,alpha=30",
      "draine:g=0.999,alpha=2", "draine:g=0.62,alpha=1e5"}},
    {"droplets",
     {"droplets:diameter=0.01", "droplets:diameter=0.09", "droplets:diameter=0.15",
      "droplets:diameter=0.8", "droplets:diameter=1.6", "droplets:diameter=4",
      "droplets:diameter=5", "droplets:diameter=20", "droplets:diameter=50"}},
    {"tabulated", {}},  // below, without a file
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& [name, texts] : kExamples) {
    for (const std::string& text : texts) all.push_back({text, parse_phase_function(text)});
  }
  for (const std::string text :
       {"0.7*henyey-greenstein:g=0.8+0.3*rayleigh",
        "0.01*henyey-greenstein:g=-0.9+0.49*droplets:diameter=10+0.5*draine:g=0.2,alpha=3"}) {
    all.push_back({text, parse_phase_function(text)});
  }
  all.push_back({"table of two points", table({{0, 3}, {180, 1}})});
  all.push_back({"table with zeros",
                 table({{0, 0}, {20, 0}, {40, 1}, {41, 0}, {90, 0}, {91, 5}, {150, 0}, {180, 0}})});
  all.push_back({"table like a cloud", cloud_table()});
  all.push_back({"mixture of a mixture and a table",
                 PhaseFunction::mixture({{0.4F, parse_phase_function("0.5*rayleigh+0.5*isotropic")},
                                         {0.6F, cloud_table()}})});
  return all;
}

TEST(PhaseFunctions, AllHaveExamplesInThisSuite) {
  for (const std::string_view name : phase_function_names()) {
    EXPECT_TRUE(kExamples.contains(name)) << name << ": add texts to kExamples";
  }
}

// --- Quadrature over the sphere, in cells that crowd at both poles of the axis. -----------------

constexpr int kCells = 40'000;  // half of them in each hemisphere

/// (1 - cosine) / 2, and its complement, which keeps the digits at the backward pole.
struct Polar {
  double h, rest;
};

Polar polar_at(double cell) {
  const double q = 2 * cell / kCells - 1;  // -1: forward, 1: backward
  const double near = 0.5 * std::pow(1 - std::abs(q), 4);
  return q < 0 ? Polar{near, 1 - near} : Polar{1 - near, near};
}

double cell_of(const Polar& polar) {
  const double q = 1 - std::pow(2 * std::min(polar.h, polar.rest), 0.25);
  return 0.5 * kCells * (1 + (polar.h < polar.rest ? -q : q));
}

Polar polar_of(const Vec3f& before, const Vec3f& after) {
  const double ahead = 0.25 * (Vec3d(after) - Vec3d(before)).length2();
  const double behind = 0.25 * (Vec3d(after) + Vec3d(before)).length2();
  return ahead < behind ? Polar{ahead, 1 - ahead} : Polar{1 - behind, behind};
}

double evaluate(const PhaseFunction& function, const Polar& polar) {
  const Vec3f before(0, 0, 1);
  const Vec3f after(static_cast<float>(2 * std::sqrt(polar.h * polar.rest)), 0,
                    static_cast<float>(polar.rest - polar.h));
  return function.evaluate(before, after);
}

/// The integral of the function over each cell, by Simpson's rule.
std::vector<double> cell_masses(const PhaseFunction& function) {
  const auto density = [&](double cell) {
    const double q = std::abs(2 * cell / kCells - 1);
    const double dh = 2 * std::pow(1 - q, 3) * 2 / kCells;  // |dh / dcell|
    return evaluate(function, polar_at(cell)) * 4 * std::numbers::pi * dh;
  };
  std::vector<double> masses(kCells);
  double begin = density(0);
  for (int cell = 0; cell < kCells; ++cell) {
    const double end = density(cell + 1);
    masses[cell] = (begin + 4 * density(cell + 0.5) + end) / 6;
    begin = end;
  }
  return masses;
}

// --- The conformance suite. ---------------------------------------------------------------------

class PhaseFunctionsTest : public ::testing::TestWithParam<Case> {
 protected:
  const PhaseFunction function_ = GetParam().function;
};

TEST_P(PhaseFunctionsTest, IntegratesToOneAndToItsMeanCosine) {
  const std::vector<double> masses = cell_masses(function_);
  double norm = 0;
  double moment = 0;
  for (int cell = 0; cell < kCells; ++cell) {
    const Polar polar = polar_at(cell + 0.5);
    norm += masses[cell];
    moment += masses[cell] * (polar.rest - polar.h);
  }
  EXPECT_NEAR(norm, 1, 1e-4);
  EXPECT_NEAR(moment, function_.mean_cosine(), 1e-4);
}

TEST_P(PhaseFunctionsTest, SamplesFollowTheFunction) {
  constexpr int kRings = 60;  // bins of nearly equal chance, made of whole cells
  constexpr int kSectors = 8;
  constexpr int kSamples = 400'000;
  const std::vector<double> masses = cell_masses(function_);
  std::vector<int> ring_of_cell(kCells);
  std::vector<double> expected(std::size_t{kRings} * kSectors, 0.0);
  double sum = 0;
  for (int cell = 0; cell < kCells; ++cell) {
    ring_of_cell[cell] = std::clamp(static_cast<int>(sum * kRings), 0, kRings - 1);
    sum += masses[cell];
    for (int sector = 0; sector < kSectors; ++sector) {
      expected[ring_of_cell[cell] * kSectors + sector] += masses[cell] * kSamples / kSectors;
    }
  }
  const Vec3f before = Vec3f(1, -2, 0.5F).normalized();
  const TangentFrame frame(before);
  std::vector<uint64_t> counts(expected.size(), 0);
  RunningStatistics cosines;
  RandomStream random(1, 2, 3, 4);
  for (int i = 0; i < kSamples; ++i) {
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const Vec3f after = function_.sample(before, u1, u2).direction;
    const Polar polar = polar_of(before, after);
    cosines.add(polar.rest - polar.h);
    const Vec3f local = frame.to_local(after);
    const double azimuth = std::atan2(local.y, local.x) / (2 * std::numbers::pi) + 0.5;
    const int sector = std::clamp(static_cast<int>(azimuth * kSectors), 0, kSectors - 1);
    const int cell = std::clamp(static_cast<int>(cell_of(polar)), 0, kCells - 1);
    ++counts[ring_of_cell[cell] * kSectors + sector];
  }
  EXPECT_TRUE(check_chi_square("direction", chi_square_test(counts, expected)));
  EXPECT_TRUE(
      testing::check_mean("mean cosine", cosines, function_.mean_cosine(), {.absolute = 1e-6}));
}

TEST_P(PhaseFunctionsTest, ReportsTheDensityThatEvaluationGives) {
  RandomStream random(5, 6, 7, 8);
  Vec3f direction(0, 1, 0);
  for (int i = 0; i < 20'000; ++i) {
    const float u1 = random.uniform();
    const float u2 = random.uniform();
    const PhaseSample sample = function_.sample(direction, u1, u2);
    const float expected = function_.evaluate(direction, sample.direction);
    // The rounding of a direction, by 1e-7, shows where a function is steep.
    const float slack = 1e-3F * expected + 1e-6F;
    ASSERT_NEAR(sample.pdf, expected, slack) << u1 << " " << u2;
    ASSERT_NEAR(sample.direction.length(), 1, 1e-6);
    direction = sample.direction;
  }
}

TEST_P(PhaseFunctionsTest, StaysFiniteForTheExtremesOfTheUniformNumbers) {
  constexpr float kLast = 1.0F - 0x1p-24F;
  for (const Vec3f& before : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(1, 0, 0), Vec3f(0, -1, 0)}) {
    for (const float u1 : {0.0F, 0x1p-24F, 0.5F, kLast}) {
      for (const float u2 : {0.0F, 0x1p-24F, 0.25F, 0.5F, kLast}) {
        const PhaseSample sample = function_.sample(before, u1, u2);
        EXPECT_NEAR(sample.direction.length(), 1, 1e-6) << u1 << " " << u2;
        EXPECT_TRUE(std::isfinite(sample.pdf)) << u1 << " " << u2;
        EXPECT_GT(sample.pdf, 0) << u1 << " " << u2;
      }
    }
    EXPECT_TRUE(std::isfinite(function_.evaluate(before, before)));
    EXPECT_TRUE(std::isfinite(function_.evaluate(before, -before)));
  }
}

TEST_P(PhaseFunctionsTest, IsNeverNegativeAndTheSameAllAround) {
  const Vec3f before = Vec3f(-1, 3, 2).normalized();
  for (double cell = 0; cell <= kCells; cell += 100) {
    const Polar polar = polar_at(cell);
    const double expected = evaluate(function_, polar);
    EXPECT_GE(expected, 0);
    if (std::min(polar.h, polar.rest) < 0.01) continue;  // rounding shows at the poles
    const double sine = 2 * std::sqrt(polar.h * polar.rest);
    for (const double azimuth : {0.3, 2.0, 4.5}) {
      const Vec3f after = TangentFrame(before).to_world(
          static_cast<float>(sine * std::cos(azimuth)),
          static_cast<float>(sine * std::sin(azimuth)), static_cast<float>(polar.rest - polar.h));
      EXPECT_NEAR(function_.evaluate(before, after), expected, 1e-4 * expected + 1e-5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PhaseFunctionsTest, ::testing::ValuesIn(cases()),
                         [](const ::testing::TestParamInfo<Case>& info) {
                           std::string name = info.param.name;
                           std::ranges::replace_if(
                               name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

// --- Formulas and limits. -----------------------------------------------------------------------

double at_cosine(const PhaseFunction& function, double cosine) {
  return evaluate(function, {0.5 * (1 - cosine), 0.5 * (1 + cosine)});
}

/// [Draine03] in double precision.
double draine_reference(double g, double alpha, double cosine) {
  return (1 - g * g) * (1 + alpha * cosine * cosine) /
         (4 * std::numbers::pi * (1 + alpha * (1 + 2 * g * g) / 3) *
          std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

TEST(Rayleigh, EqualsTheFormula) {
  for (double cosine = -1; cosine <= 1; cosine += 0.05) {
    const double expected = 3 * (1 + cosine * cosine) / (16 * std::numbers::pi);
    EXPECT_NEAR(at_cosine(PhaseFunction::rayleigh(), cosine), expected, 1e-6 * expected);
  }
}

TEST(Draine, EqualsTheFormulaInDoublePrecision) {
  for (const float g : {0.0F, 0.3F, -0.6F, 0.95F}) {
    for (const float alpha : {0.0F, 0.5F, 1.0F, 27.0F, 250.0F}) {
      const PhaseFunction function = PhaseFunction::draine(g, alpha);
      for (double cosine = -1; cosine <= 1; cosine += 0.05) {
        const double expected = draine_reference(g, alpha, cosine);
        EXPECT_NEAR(at_cosine(function, cosine), expected, 1e-5 * expected)
            << g << " " << alpha << " " << cosine;
      }
    }
  }
}

TEST(Draine, SamplesExactQuantilesForEveryGAndAlpha) {
  for (const float g : {0.0F, 1e-8F, 1e-5F, 0.01F, 0.5F, 0.9F, 0.999F}) {
    for (const float alpha : {0.0F, 2e-7F, 1e-5F, 0.1F, 1.0F, 30.0F, 250.0F, 1e5F}) {
      const PhaseFunction function = PhaseFunction::draine(g, alpha);
      // The integral of the formula over w = sqrt(1 + g² - 2 g cosine) needs g; Simpson's rule in
      // the half distance does not.
      constexpr int kSteps = 400;
      double sum = 0;
      double begin = 0;
      for (int step = 1; step < 20; ++step) {
        const float u1 = static_cast<float>(step) / 20;
        const double end =
            std::sqrt(polar_of({0, 0, 1}, function.sample({0, 0, 1}, u1, 0).direction).h);
        for (int i = 0; i <= kSteps; ++i) {
          const double x = begin + (end - begin) * i / kSteps;  // h = x²
          const double weight = i == 0 || i == kSteps ? 1 : 2 + 2 * (i % 2);
          sum += weight * (end - begin) / (3 * kSteps) * 8 * std::numbers::pi * x *
                 draine_reference(g, alpha, 1 - 2 * x * x);
        }
        begin = end;
        EXPECT_NEAR(sum, u1, 3e-6) << g << " " << alpha;
      }
    }
  }
}

TEST(Draine, ContainsHenyeyGreensteinAndRayleigh) {
  for (double cosine = -1; cosine <= 1; cosine += 0.1) {
    EXPECT_FLOAT_EQ(at_cosine(PhaseFunction::draine(0.7F, 0), cosine),
                    at_cosine(PhaseFunction::henyey_greenstein(0.7F), cosine));
    EXPECT_NEAR(at_cosine(PhaseFunction::draine(0, 1), cosine),
                at_cosine(PhaseFunction::rayleigh(), cosine), 1e-7);
  }
}

// --- Values out of range. -----------------------------------------------------------------------

template <class Make>
std::string message_of(Make make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PhaseFunctions, RefuseParametersOutOfRange) {
  EXPECT_EQ(message_of([] { PhaseFunction::henyey_greenstein(1); }),
            "henyey-greenstein: g must lie between -1 and 1, and is 1");
  EXPECT_EQ(message_of([] { PhaseFunction::henyey_greenstein(std::nanf("")); }),
            "henyey-greenstein: g must lie between -1 and 1, and is nan");
  EXPECT_EQ(message_of([] { PhaseFunction::draine(-1, 0); }),
            "draine: g must lie between -1 and 1, and is -1");
  EXPECT_EQ(message_of([] { PhaseFunction::draine(0, -0.5F); }),
            "draine: alpha must be 0 or more, and is -0.5");
  EXPECT_EQ(message_of([] { PhaseFunction::droplets(0); }),
            "droplets: the diameter must be above 0 and at most 50 micrometres, and is 0");
  EXPECT_EQ(message_of([] { PhaseFunction::droplets(50.5F); }),
            "droplets: the diameter must be above 0 and at most 50 micrometres, and is 50.5");
  EXPECT_EQ(message_of([] { PhaseFunction::mixture({}); }),
            "a mixture of phase functions: the weights must sum to 1, and sum to 0");
  EXPECT_EQ(message_of([] {
              PhaseFunction::mixture({{1.5F, {}}, {-0.5F, {}}});
            }),
            "a mixture of phase functions: the weight -0.5 is negative or not finite");
}

}  // namespace
}  // namespace freepath
