#include "../../../src/physics/anchor.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace talus {
namespace {

Motion at(double time, double x, double y, double z = 0.0) {
  Motion m;
  m.time = time;
  m.position = {x, y, z};
  return m;
}

TEST(Anchor, ABlockThatStaysIsTrappedAfterItsPatience) {
  Anchor anchor(1.0, 5.0);
  anchor.set(at(10.0, 3, 4));
  EXPECT_FALSE(anchor.traps(at(10.0, 3, 4)));
  EXPECT_FALSE(anchor.traps(at(14.99, 3, 4.9)));
  EXPECT_TRUE(anchor.traps(at(15.01, 3.5, 4)));
}

TEST(Anchor, HoppingToAndFroWithinTheCircleIsNoWayOut) {
  Anchor anchor(1.0, 5.0);
  anchor.set(at(0.0, 0, 0));
  for (int hop = 1; hop <= 49; ++hop) ASSERT_FALSE(anchor.traps(at(0.1 * hop, hop % 2 == 0 ? 0.99 : -0.99, 0)));
  EXPECT_TRUE(anchor.traps(at(5.1, 0, 0.5)));
}

TEST(Anchor, OnlyThePlanCounts) {
  Anchor anchor(1.0, 5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_TRUE(anchor.traps(at(5.1, 0, 0, 300.0)));
}

TEST(Anchor, IsSetAnewAtAContactOutsideTheCircleAndNowhereElse) {
  Anchor anchor(1.0, 5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_FALSE(anchor.traps(at(4.0, 0.6, 0.8 - 1e-9)));  // on the circle: still the first anchor
  EXPECT_FALSE(anchor.traps(at(4.9, 0.61, 0.81)));       // outside: anew, at 4.9 s
  EXPECT_FALSE(anchor.traps(at(9.8, 0.61, 1.8)));
  EXPECT_TRUE(anchor.traps(at(9.91, 0.61, 1.8)));
}

TEST(Anchor, TheReachIsAPlainDistance) {
  Anchor anchor(2.0, 5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_TRUE(anchor.traps(at(5.1, 1.1, 1.6)));   // 1.94 m away
  EXPECT_FALSE(anchor.traps(at(5.2, 1.2, 1.7)));  // 2.08 m away: anew
}

TEST(Anchor, AFarJumpIsNeverATrap) {  // whatever the time in the air
  Anchor anchor(1.0, 5.0);
  anchor.set(at(0.0, 0, 0));
  EXPECT_FALSE(anchor.traps(at(60.0, 2, 0)));
}

TEST(Anchor, EvenContactsAreATrapIfADiameterTakesLongerThanThePatience) {  // contacts every 1 cm
  for (const double speed : {0.15, 0.19, 0.21, 1.0}) {
    Anchor anchor(1.0, 5.0);
    anchor.set(at(0.0, 0, 0));
    bool trapped = false;
    for (int i = 1; i <= 1000 && !trapped; ++i) trapped = anchor.traps(at(0.01 * i / speed, 0.006 * i, 0.008 * i));
    EXPECT_EQ(trapped, speed < 0.2) << speed;
  }
}

}  // namespace
}  // namespace talus
