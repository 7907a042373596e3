#include "freepath/base/counted.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace freepath {
namespace {

TEST(Counted, OneIsNoPlural) {
  EXPECT_EQ(counted(1, "thread"), "1 thread");
  EXPECT_EQ(counted(0, "thread"), "0 threads");
  EXPECT_EQ(counted(uint64_t{2}, "thread"), "2 threads");
  EXPECT_EQ(counted(1U, "pixel has", "pixels have"), "1 pixel has");
  EXPECT_EQ(counted(7, "pixel has", "pixels have"), "7 pixels have");
}

}  // namespace
}  // namespace freepath
