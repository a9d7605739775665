#include "../../../src/physics/anchor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace talus {
namespace {

Motion at(double time, double x, double y, double z = 0.0) {
  Motion m;
  m.time = time;
  m.position = {x, y, z};
  return m;
}

TEST(Anchor, ABlockThatStaysIsHeldAfterItsPatience) {
  Anchor anchor(5.0);
  anchor.set(at(10.0, 3, 4));
  EXPECT_FALSE(anchor.holds(at(10.0, 3, 4), 1.0));
  EXPECT_FALSE(anchor.holds(at(14.99, 3, 4.9), 1.0));
  EXPECT_TRUE(anchor.holds(at(15.01, 3.5, 4), 1.0));
}

TEST(Anchor, HoppingToAndFroWithinTheCircleIsNoWayOut) {
  Anchor anchor(5.0);
  anchor.set(at(0.0, 0, 0));
  for (int hop = 1; hop <= 49; ++hop) ASSERT_FALSE(anchor.holds(at(0.1 * hop, hop % 2 == 0 ? 0.99 : -0.99, 0), 1.0));
  EXPECT_TRUE(anchor.holds(at(5.1, 0, 0.5), 1.0));
}

TEST(Anchor, TheHeightCountsLikeTheDistanceInPlan) {  // a fall, or a way up or down a wall
  for (const double height : {-300.0, -1.01, -0.99, 0.99, 1.01, 300.0}) {
    Anchor anchor(5.0);
    anchor.set(at(0.0, 0, 0, 70.0));
    EXPECT_EQ(anchor.holds(at(5.1, 0.99, 0, 70.0 + height), 1.0), std::abs(height) < 1.0) << height;
    EXPECT_TRUE(anchor.holds(at(10.2, 0.99, 0, 70.0 + height), 1.0)) << height;
  }
}

TEST(Anchor, IsSetAnewAtAContactOutsideTheCircleAndNowhereElse) {
  Anchor anchor(5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_FALSE(anchor.holds(at(4.0, 0.6, 0.8 - 1e-9), 1.0));  // on the circle: still the first anchor
  EXPECT_FALSE(anchor.holds(at(4.9, 0.61, 0.81), 1.0));       // outside: anew, at 4.9 s
  EXPECT_FALSE(anchor.holds(at(9.8, 0.61, 1.8), 1.0));
  EXPECT_TRUE(anchor.holds(at(9.91, 0.61, 1.8), 1.0));
}

TEST(Anchor, TheReachIsTheDiameterOfTheBlockNow) {
  Anchor anchor(5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_TRUE(anchor.holds(at(5.1, 1.1, 1.6), 2.0));   // 1.94 m away
  EXPECT_FALSE(anchor.holds(at(5.2, 1.1, 1.6), 1.9));  // the block has broken: anew
}

/// The time to get one diameter away from rest grows as sqrt(D).
TEST(Anchor, LargeBlocksMayStayLonger) {
  for (const auto& [diameter, longest] : {std::pair{0.1, 5.0}, {2.0, 5.0}, {8.0, 10.0}, {50.0, 25.0}}) {
    Anchor anchor(5.0);
    anchor.set(at(0.0, 0, 0));
    EXPECT_FALSE(anchor.holds(at(longest - 1e-9, 0, 0), diameter)) << diameter;
    EXPECT_TRUE(anchor.holds(at(longest + 1e-9, 0, 0), diameter)) << diameter;
  }
}

TEST(Anchor, AFarJumpIsNoStay) {  // whatever the time in the air
  Anchor anchor(5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_FALSE(anchor.holds(at(60.0, 2, 0), 1.0));
}

TEST(Anchor, EvenContactsHoldIfADiameterTakesLongerThanThePatience) {  // contacts every 1 cm
  for (const double speed : {0.15, 0.19, 0.21, 1.0}) {
    Anchor anchor(5.0);
    anchor.set(at(0.0, 0, 0));
    bool held = false;
    for (int i = 1; i <= 1000 && !held; ++i) held = anchor.holds(at(0.01 * i / speed, 0.006 * i, 0.008 * i), 1.0);
    EXPECT_EQ(held, speed < 0.2) << speed;
  }
}

}  // namespace
}  // namespace talus
