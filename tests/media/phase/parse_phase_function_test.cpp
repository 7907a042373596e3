#include "freepath/media/phase/parse_phase_function.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "freepath/base/error.h"

namespace freepath {
namespace {

const Vec3f kBefore(0, 0, 1);
const Vec3f kAfter = Vec3f(1, 2, 1.5F).normalized();

void expect_same(std::string_view text, const PhaseFunction& expected) {
  EXPECT_FLOAT_EQ(parse_phase_function(text).evaluate(kBefore, kAfter),
                  expected.evaluate(kBefore, kAfter))
      << text;
}

std::string parse_message(std::string_view text) {
  try {
    parse_phase_function(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParsePhaseFunction, KnowsEachKind) {
  expect_same("isotropic", PhaseFunction());
  expect_same("henyey-greenstein:g=-0.8", PhaseFunction::henyey_greenstein(-0.8F));
  expect_same("rayleigh", PhaseFunction::rayleigh());
  expect_same("draine:alpha=2,g=0.5", PhaseFunction::draine(0.5F, 2));
  expect_same(" droplets : diameter = 20 ", PhaseFunction::droplets(20));
}

TEST(ParsePhaseFunction, AddsTheWeightedPartsOfAMixture) {
  const PhaseFunction hg = PhaseFunction::henyey_greenstein(0.8F);
  const PhaseFunction rayleigh = PhaseFunction::rayleigh();
  const PhaseFunction mixture = PhaseFunction::mixture({{0.7F, hg}, {0.3F, rayleigh}});
  EXPECT_FLOAT_EQ(mixture.evaluate(kBefore, kAfter),
                  0.7F * hg.evaluate(kBefore, kAfter) + 0.3F * rayleigh.evaluate(kBefore, kAfter));
  expect_same("0.7*henyey-greenstein:g=0.8+0.3*rayleigh", mixture);
  expect_same("0.7 * henyey-greenstein:g=8e-1 + 0.3 * rayleigh", mixture);
  expect_same("1*rayleigh", rayleigh);
  expect_same("0*isotropic+1*rayleigh", rayleigh);
}

TEST(ParsePhaseFunction, ReadsATableRelativeToAFolder) {
  // The name of a file may hold a plus.
  const std::filesystem::path folder = ::testing::TempDir();
  std::ofstream(folder / "phase+table.txt") << "0 2\n180 0\n";
  for (const std::string text : {"tabulated:phase+table.txt", "1*tabulated:phase+table.txt",
                                 "0.5*tabulated:phase+table.txt+0.5*tabulated:phase+table.txt"}) {
    EXPECT_NEAR(parse_phase_function(text, folder).mean_cosine(), 1.0 / 3, 1e-6) << text;
  }
  std::ofstream(folder / "bad_table.txt") << "0 2\n180 -1\n";
  try {
    parse_phase_function("tabulated:bad_table.txt", folder);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), (folder / "bad_table.txt").string() + ":2: the value -1 is negative");
  }
}

TEST(ParsePhaseFunction, SaysWhatIsWrong) {
  EXPECT_EQ(parse_message("raleigh"),
            "there is no phase function 'raleigh'; did you mean 'rayleigh'?");
  EXPECT_EQ(parse_message("xyzzy"),
            "there is no phase function 'xyzzy'; there are isotropic, henyey-greenstein, rayleigh, "
            "draine, droplets, tabulated");
  EXPECT_EQ(parse_message(""),
            "there is no phase function ''; there are isotropic, henyey-greenstein, rayleigh, "
            "draine, droplets, tabulated");
  EXPECT_EQ(parse_message("isotropic:g=0"), "isotropic: takes no parameters, and has 'g=0'");
  EXPECT_EQ(parse_message("henyey-greenstein"),
            "henyey-greenstein: g is missing: henyey-greenstein:g=NUMBER");
  EXPECT_EQ(parse_message("draine:g=0.5"),
            "draine: alpha is missing: draine:g=NUMBER,alpha=NUMBER");
  EXPECT_EQ(parse_message("draine:0.5"), "draine: '0.5' should read g=NUMBER or alpha=NUMBER");
  EXPECT_EQ(parse_message("draine:g=0.5,beta=1"),
            "draine: there is no parameter 'beta'; it takes g and alpha");
  EXPECT_EQ(parse_message("draine:g=0.5,g=0.5"), "draine: g is given twice");
  EXPECT_EQ(parse_message("droplets:diameter=20um"),
            "droplets: diameter is '20um', which is no number");
  EXPECT_EQ(parse_message("droplets:diameter="), "droplets: diameter is '', which is no number");
  EXPECT_EQ(parse_message("henyey-greenstein:g=1"),
            "henyey-greenstein: g must lie between -1 and 1, and is 1");
  EXPECT_EQ(parse_message("henyey-greenstein:g=nan"),
            "henyey-greenstein: g must lie between -1 and 1, and is nan");
  EXPECT_EQ(parse_message("tabulated"), "tabulated: the name of a file is missing: tabulated:FILE");
  EXPECT_EQ(parse_message("tabulated:no_such_file.txt"),
            "no_such_file.txt: no such file; check the path");
  EXPECT_EQ(parse_message("tabulated:/"), "/: is a directory; name a table of a phase function");
  EXPECT_EQ(parse_message("0.7*rayleigh+0.2*isotropic"),
            "a mixture of phase functions: the weights must sum to 1, and sum to 0.9");
  EXPECT_EQ(parse_message("1.5*rayleigh+-0.5*isotropic"),
            "a mixture of phase functions: the weight -0.5 is negative or not finite");
  EXPECT_EQ(parse_message("rayleigh+0.5*isotropic"),
            "a mixture of phase functions: 'rayleigh' needs a weight, as in 0.5*rayleigh");
  EXPECT_EQ(parse_message("0.5*rayleigh+0.5*"),
            "there is no phase function ''; there are isotropic, henyey-greenstein, rayleigh, "
            "draine, droplets, tabulated");
  EXPECT_EQ(parse_message("1*rayleigh+"),
            "there is no phase function 'rayleigh+'; did you mean 'rayleigh'?");
}

TEST(ParsePhaseFunction, AllowsForTheRoundingOfWeights) {
  EXPECT_EQ(parse_message("0.33333*rayleigh+0.66666*isotropic"), "no error");
  EXPECT_NE(parse_message("0.333*rayleigh+0.666*isotropic"), "no error");
}

TEST(PhaseFunctionFiles, AreThoseOfTables) {
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(phase_function_files("rayleigh"), Paths{});
  EXPECT_EQ(phase_function_files("tabulated:a.txt"), Paths{"a.txt"});
  EXPECT_EQ(phase_function_files("0.5*tabulated:a.txt + 0.25*rayleigh+0.25*tabulated:b+c.txt", "f"),
            (Paths{"f/a.txt", "f/b+c.txt"}));
}

}  // namespace
}  // namespace freepath
