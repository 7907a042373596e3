// When a pass over all pixels has to end: times are given, not waited for.

#include "freepath/paths/deadline.h"

#include <gtest/gtest.h>

namespace freepath {
namespace {

TEST(Deadline, WithoutALimitNothingEnds) {
  Deadline deadline(0);
  deadline.begin_pass(0, true);
  EXPECT_FALSE(deadline.is_over(1e9, 0));
  deadline.begin_pass(1e9, false);
  EXPECT_FALSE(deadline.is_over(2e9, 0.001));
}

TEST(Deadline, NothingEndsBeforeTheLimit) {
  Deadline deadline(10);
  deadline.begin_pass(0, true);
  EXPECT_FALSE(deadline.is_over(9.99, 1e-6));
  deadline.begin_pass(5, false);
  EXPECT_FALSE(deadline.is_over(9.99, 1e-6));
}

TEST(Deadline, AFirstPassGoesOnWhileItWillBeCompleteWithinTwiceTheLimitAndASecond) {
  Deadline deadline(10);
  deadline.begin_pass(0, true);
  // Done to this part after 10 s it is complete at 20 s, 21 s and 22 s.
  EXPECT_FALSE(deadline.is_over(10, 10.0 / 20));
  EXPECT_FALSE(deadline.is_over(10, 10.0 / 20.99));
  EXPECT_TRUE(deadline.is_over(10, 10.0 / 21.01));
  EXPECT_TRUE(deadline.is_over(10, 10.0 / 22));
  // Hopes are disappointed.
  EXPECT_FALSE(deadline.is_over(20.99, 0.9999));
  EXPECT_TRUE(deadline.is_over(21, 0.9999));
}

TEST(Deadline, AFirstPassOfWhichNothingIsDoneMayGoOnToo) {
  Deadline deadline(10);
  deadline.begin_pass(0, true);
  EXPECT_FALSE(deadline.is_over(20.99, 0));
  EXPECT_TRUE(deadline.is_over(21, 0));
}

TEST(Deadline, LaterPassesAreAllowedSomePercent) {
  Deadline deadline(10);  // and 1.05 · 10 + 0.25 = 10.75 at the most
  deadline.begin_pass(6, false);
  // After 4 s, complete 4.7 s and 4.8 s after the pass began.
  EXPECT_FALSE(deadline.is_over(10, 4 / 4.7));
  EXPECT_TRUE(deadline.is_over(10, 4 / 4.8));
  EXPECT_TRUE(deadline.is_over(10.75, 0.9999));
}

TEST(Deadline, AWishToStopLeavesAFirstPassASecond) {
  Deadline deadline(0);
  deadline.begin_pass(0, true);
  EXPECT_FALSE(deadline.stop_is_wished());
  deadline.request_stop(4);
  EXPECT_TRUE(deadline.stop_is_wished());
  EXPECT_FALSE(deadline.is_over(4, 4 / 4.9));
  EXPECT_TRUE(deadline.is_over(4, 4 / 5.1));
  EXPECT_FALSE(deadline.is_over(4.9, 0));
  EXPECT_TRUE(deadline.is_over(5, 0.9999));
}

TEST(Deadline, AWishToStopEndsOtherPassesAtOnce) {
  Deadline deadline(100);
  deadline.begin_pass(3, false);
  deadline.request_stop(4);
  EXPECT_TRUE(deadline.is_over(4, 0.9999));
  EXPECT_TRUE(deadline.is_over(4, 0));
}

TEST(Deadline, TheFirstWishCounts) {
  Deadline deadline(0);
  deadline.begin_pass(0, true);
  deadline.request_stop(4);
  deadline.request_stop(4.5);
  EXPECT_TRUE(deadline.is_over(5, 0.9999));
}

}  // namespace
}  // namespace freepath
