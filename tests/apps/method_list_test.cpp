// Lists of methods, whose options have commas too.

#include "apps/freepath/method_list.h"

#include <gtest/gtest.h>

#include "freepath/base/error.h"

namespace freepath::testing {
namespace {

using program::split_methods;
using Methods = std::vector<std::string>;

TEST(MethodList, CommasStandBetweenMethods) {
  EXPECT_EQ(split_methods("delta"), Methods({"delta"}));
  EXPECT_EQ(split_methods("delta,regular,auto"), Methods({"delta", "regular", "auto"}));
}

TEST(MethodList, AnItemWithAnEqualsSignBelongsToTheMethodBefore) {
  EXPECT_EQ(split_methods("a:x=1,y=2,b,c:z=3"), Methods({"a:x=1,y=2", "b", "c:z=3"}));
  EXPECT_EQ(split_methods("a:x=1,b:y=2"), Methods({"a:x=1", "b:y=2"}));
}

TEST(MethodList, WhatIsNoListIsRefused) {
  for (const char* text : {"", ",", "a,", ",a", "a,,b", "x=1", "a,x=1"}) {
    EXPECT_THROW(split_methods(text), Error) << text;
  }
}

}  // namespace
}  // namespace freepath::testing
