#ifndef TALUS_CHECKED
#define TALUS_CHECKED  // here in a release too
#endif
#include "talus/base/expect.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(ExpectDeathTest, ABrokenInvariantIsToldAndAborts) {
  const int hits = 3, trials = 2;
  EXPECT_DEATH(TALUS_EXPECT(hits <= trials, "no more hits than trials"),
               "expect_test.cpp:[0-9]+: an invariant is broken: no more hits than trials \\(hits <= trials\\)");
}

TEST(Expect, AnInvariantThatHoldsIsLookedAtOnce) {
  int looked = 0;
  TALUS_EXPECT(++looked == 1, "once");
  EXPECT_EQ(looked, 1);
}

}  // namespace
}  // namespace talus
