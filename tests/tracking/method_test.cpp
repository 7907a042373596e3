#include "freepath/tracking/method.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "freepath/base/error.h"

namespace freepath {
namespace {

constexpr MethodOption kTwoOptions[] = {{"rate-scale", 1.0F, 1e-3F, 1e3F, "first"},
                                        {"roulette", 0.1F, 0.0F, 1.0F, "second"}};
constexpr MethodInfo kKnown[] = {{"plain", "without options", "", "", "", {}},
                                 {"rich", "with two options", "", "", "", kTwoOptions}};

Method parse(std::string_view text) { return parse_method(text, kKnown); }

/// What parsing complains of; empty if it does not.
std::string complaint(std::string_view text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(ParseMethod, TakesStandardsForWhatIsNotSaid) {
  EXPECT_EQ(parse("plain").name, "plain");
  const Method method = parse("rich");
  EXPECT_EQ(method.name, "rich");
  EXPECT_EQ(method.options[0], 1.0F);
  EXPECT_EQ(method.options[1], 0.1F);
  EXPECT_EQ(method.options[2], 0.0F);
}

TEST(ParseMethod, ReadsOptionsInAnyOrder) {
  const Method expected = parse("rich:rate-scale=0.7,roulette=0.25");
  EXPECT_EQ(expected.options[0], 0.7F);
  EXPECT_EQ(expected.options[1], 0.25F);
  EXPECT_EQ(parse("rich:roulette=0.25,rate-scale=0.7").options, expected.options);
  EXPECT_EQ(parse("rich:roulette=0.25").options[0], 1.0F);
  EXPECT_EQ(parse("rich:rate-scale=7e-1").options[0], 0.7F);
}

TEST(ParseMethod, AcceptsTheEndsOfARange) {
  EXPECT_EQ(parse("rich:rate-scale=1e-3").options[0], 1e-3F);
  EXPECT_EQ(parse("rich:rate-scale=1000").options[0], 1e3F);
  EXPECT_EQ(parse("rich:roulette=0").options[1], 0.0F);
  EXPECT_EQ(parse("rich:roulette=1").options[1], 1.0F);
}

TEST(ParseMethod, ListsTheMethodsForAnUnknownName) {
  EXPECT_EQ(complaint("poor"), "there is no method 'poor'; known are: plain, rich");
  EXPECT_EQ(complaint(""), "there is no method ''; known are: plain, rich");
  EXPECT_EQ(complaint("Plain"), "there is no method 'Plain'; known are: plain, rich");
  EXPECT_EQ(complaint("ric:roulette=1"), "there is no method 'ric'; known are: plain, rich");
  EXPECT_THROW(parse_method("plain", {}), Error);
}

TEST(ParseMethod, ListsTheOptionsForAnUnknownOne) {
  EXPECT_EQ(complaint("rich:speed=1"),
            "'rich' has no option 'speed'; its options are: rate-scale, roulette");
  EXPECT_EQ(complaint("plain:speed=1"), "'plain' has no option 'speed'; its options are: none");
  EXPECT_EQ(complaint("rich:"), "'rich' has no option ''; its options are: rate-scale, roulette");
  EXPECT_EQ(complaint("rich:roulette=1,"),
            "'rich' has no option ''; its options are: rate-scale, roulette");
}

TEST(ParseMethod, RefusesAMethodWithMoreOptionsThanThereIsRoomFor) {
  static constexpr MethodOption kMany[kMaxMethodOptions + 1] = {};
  static constexpr MethodInfo kGreedy = {"greedy", "", "", "", "", kMany};
  static_assert(!has_room_for(kGreedy));
  EXPECT_THROW(parse_method("greedy", {&kGreedy, 1}), Error);
}

TEST(ParseMethod, AsksForAMissingValue) {
  EXPECT_EQ(complaint("rich:roulette"),
            "option 'roulette' of 'rich' needs a value: rich:roulette=0.1");
}

TEST(ParseMethod, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"", "x", "1x", "1 ", " 1", "+1", "1.0.0", "nan", "inf", "-inf", "1e99"}) {
    EXPECT_EQ(complaint(std::string("rich:roulette=") + text),
              "option 'roulette' of 'rich': '" + std::string(text) + "' is not a number");
  }
}

TEST(ParseMethod, RefusesWhatIsOutOfRangeAndNamesTheRange) {
  EXPECT_EQ(complaint("rich:roulette=1.5"), "option 'roulette' of 'rich': 1.5 is outside 0 to 1");
  EXPECT_EQ(complaint("rich:rate-scale=0"),
            "option 'rate-scale' of 'rich': 0 is outside 0.001 to 1000");
  EXPECT_EQ(complaint("rich:rate-scale=-1"),
            "option 'rate-scale' of 'rich': -1 is outside 0.001 to 1000");
}

TEST(MethodToString, NamesOnlyWhatDiffersFromTheStandard) {
  EXPECT_EQ(to_string(parse("plain"), kKnown), "plain");
  EXPECT_EQ(to_string(parse("rich"), kKnown), "rich");
  EXPECT_EQ(to_string(parse("rich:rate-scale=1,roulette=0.1"), kKnown), "rich");
  EXPECT_EQ(to_string(parse("rich:roulette=0"), kKnown), "rich:roulette=0");
  EXPECT_EQ(to_string(parse("rich:roulette=0.5,rate-scale=0.7"), kKnown),
            "rich:rate-scale=0.7,roulette=0.5");
}

TEST(MethodToString, IsReadBackBitForBit) {
  for (const float rate : {0.7F, 1.0F / 3.0F, 1e-3F, 1e3F, 123.456789F}) {
    for (const float roulette : {0.0F, std::numeric_limits<float>::denorm_min(), 0.1F, 1.0F}) {
      Method method;
      method.name = "rich";
      method.options = {rate, roulette};
      const Method back = parse(to_string(method, kKnown));
      EXPECT_EQ(back.name, method.name);
      EXPECT_EQ(back.options, method.options) << to_string(method, kKnown);
    }
  }
}

TEST(MethodToString, RefusesAnUnknownName) {
  Method method;
  method.name = "poor";
  EXPECT_THROW(to_string(method, kKnown), Error);
}

}  // namespace
}  // namespace freepath
