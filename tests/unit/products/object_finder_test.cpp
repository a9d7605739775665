// Energies where a path meets objects, on spans by hand: closed forms.
#include "products/object_finder.hpp"

#include <gtest/gtest.h>

#include "support/scenarios.hpp"

namespace talus {
namespace {

/// Cells of 10 m: the patch (0, 0) lies between (5, 5) and (15, 15).
Surface plain() {
  return Surface(test::terrain(test::grid_of(4, 4, 10.0, 10.0), [](double, double) { return 0.0; }));
}

/// 10 m to the east through the patch, at 10 m/s in plan; the vertical speed goes from 5 to -5 m/s.
Span flight() {
  return {{0, 0}, 0.0F, 0.5F, 1.0F, 0.5F, 3.0F, 3.0F, -1.0F, 100.0F, 5.0F, -5.0F, 0};
}

/// 2 kg, radius 0.5 m: v^2 in J.
Block block() {
  Block body{};
  body.mass = 2.0;
  body.diameter = 1.0;
  return body;
}

HazardObject wall(double west, double east) {
  return {{{{{west, 0.0}, {east, 0.0}, {east, 20.0}, {west, 20.0}, {west, 0.0}}}}, {}};
}

/// A wall 1 mm behind the end of `flight`, in which a path may end `caught`.
const Barriers& wall_at_15() {
  static const Barriers barriers({{"wall", {{{15.001, 0.0}, {15.001, 20.0}}}, 100.0, 1e9}});
  return barriers;
}

ObjectContact contact_with(const HazardObject& object, const Path& path) {
  const Surface surface = plain();
  const std::vector<HazardObject> objects{object};
  std::vector<ObjectContact> contacts(1);
  ObjectFinder(surface, wall_at_15(), objects, 0.5).add(path, block(), contacts);
  return contacts[0];
}

ObjectContact contact_with(const HazardObject& object, const Span& span) {
  return contact_with(object, test::path_of({span}, End::Stopped));
}

TEST(ObjectFinder, TakesTheEnergyAtTheObject) {
  const ObjectContact rising = contact_with(wall(8.0, 9.0), flight());  // touched from x = 7.5 to 9.5: 2.5 to 0.5 m/s
  EXPECT_NEAR(rising.entry, 0.10625, 1e-7);
  EXPECT_NEAR(rising.largest, 0.10625, 1e-7) << "the span has 125 J at its ends, but not here";
  const ObjectContact falling = contact_with(wall(11.0, 13.0), flight());  // 10.5 to 13.5: -0.5 to -3.5 m/s
  EXPECT_NEAR(falling.entry, 0.10025, 1e-7);
  EXPECT_NEAR(falling.largest, 0.11225, 1e-7) << "it falls into the object";
  EXPECT_LT(contact_with(wall(16.0, 17.0), flight()).largest, 0.0F) << "0.5 m beyond its edge";
}

/// 2 kg, 1 m: the rotation adds 0.1 w^2 / 1000 kJ, from the span on from which the block spins.
TEST(ObjectFinder, TakesTheRotationToo) {
  Path path = test::path_of({flight(), flight()}, End::Stopped);
  path.spins = {{0, 10.0}, {0, 20.0}, {1, 30.0}};  // two impacts at one place: the last counts
  const Surface surface = plain();
  const std::vector<HazardObject> objects{wall(8.0, 9.0)};
  std::vector<ObjectContact> with(1), without(1);
  ObjectFinder(surface, wall_at_15(), objects, 0.5, true).add(path, block(), with);
  ObjectFinder(surface, wall_at_15(), objects, 0.5).add(path, block(), without);
  EXPECT_NEAR(with[0].entry, 0.10625 + 0.040, 1e-7);
  EXPECT_NEAR(with[0].largest, 0.10625 + 0.090, 1e-7) << "it passes again, and spins faster";
  EXPECT_NEAR(without[0].entry, 0.10625, 1e-7);
  EXPECT_NEAR(without[0].largest, 0.10625, 1e-7);
}

TEST(ObjectFinder, TheRotationIsThatOfWhatIsLeftAfterABreak) {  // half of the mass, of the same diameter
  Path path = test::path_of({flight(), flight()}, End::Stopped);
  path.spins = {{0, 20.0}, {1, 100.0}};
  Block rest = block();
  rest.mass = 1.0;
  path.breaks = {{1, 1, rest}};
  const Surface surface = plain();
  const std::vector<HazardObject> objects{wall(8.0, 9.0)};
  std::vector<ObjectContact> contacts(1);
  ObjectFinder(surface, wall_at_15(), objects, 0.5, true).add(path, block(), contacts);
  EXPECT_NEAR(contacts[0].largest, 0.053125 + 0.5, 1e-6);
}

TEST(ObjectFinder, InASlideTheSquareOfTheSpeedIsLinear) {  // from 10 to 20 m/s in 10 m
  const Span slide{{0, 0}, 0.0F, 0.5F, 1.0F, 0.5F, 0.0F, 0.0F, 0.0F, 0.0F, 10.0F, 20.0F, 0};
  const ObjectContact contact = contact_with(wall(8.0, 9.0), slide);
  EXPECT_NEAR(contact.entry, 0.100 + 0.25 * 0.300, 1e-7);
  EXPECT_NEAR(contact.largest, 0.100 + 0.45 * 0.300, 1e-7);
}

TEST(ObjectFinder, ALineIsAsWideAsItsWidth) {
  HazardObject road{{}, {{{12.0, -5.0}, {12.0, 25.0}}}};
  EXPECT_NEAR(contact_with(road, flight()).entry, 0.10225, 1e-7);  // from x = 11.5: -1.5 m/s
  road.line_width = 5.0;                                           // from 9 m: 1 m/s; to 15 m: -5 m/s
  EXPECT_NEAR(contact_with(road, flight()).entry, 0.101, 1e-7);
  EXPECT_NEAR(contact_with(road, flight()).largest, 0.125, 1e-7);
}

TEST(ObjectFinder,
     AWideLineIsItsRectangleAlsoInPatchesFarFromItsAxis) {  // 24 m wide: the path begins 9 m from the axis
  const Surface surface(test::terrain(test::grid_of(12, 4, 4.0, 10.0), [](double, double) { return 0.0; }));
  HazardObject road{{}, {{{24.0, -5.0}, {24.0, 45.0}}}};
  road.line_width = 24.0;
  for (int column = 0; column < 11; ++column) {  // one flight through each patch: from x = 4 column + 2, 4 m long
    Span span = flight();
    span.patch = {column, 0};
    const Path path = test::path_of({span}, End::Stopped);
    const auto met = [&](const HazardObject& object) {
      const std::vector<HazardObject> objects{object};
      std::vector<ObjectContact> contacts(1);
      ObjectFinder(surface, wall_at_15(), objects, 0.5).add(path, block(), contacts);
      return contacts[0];
    };
    const ObjectContact of_line = met(road), of_wall = met(wall(12.0, 36.0));
    EXPECT_NEAR(of_line.entry, of_wall.entry, 1e-7) << column;
    EXPECT_NEAR(of_line.largest, of_wall.largest, 1e-7) << column;
    EXPECT_EQ(of_line.largest >= 0.0F, 4 * column + 6 >= 11.5 && 4 * column + 2 <= 36.5) << column;
  }
}

TEST(ObjectFinder, EntryIsTheFirstTouchOfThePath) {  // inside a large object from the start; then a faster span
  Span faster = flight();
  faster.plan_speed_squared = 400.0F;
  const ObjectContact contact = contact_with(wall(0.0, 20.0), test::path_of({flight(), faster}, End::Stopped));
  EXPECT_NEAR(contact.entry, 0.125, 1e-7);
  EXPECT_NEAR(contact.largest, 0.425, 1e-7);
}

TEST(ObjectFinder, EntryOfSeveralPartsIsThatOfThePartThatIsHitHardest) {  // the farther house, into which it falls
  const HazardObject near = wall(9.0, 10.0), far = wall(14.0, 14.5);
  HazardObject both = near;
  both.polygons.push_back(far.polygons.front());
  EXPECT_NEAR(contact_with(near, flight()).entry, 0.10225, 1e-7);  // from x = 8.5: 1.5 m/s
  EXPECT_NEAR(contact_with(far, flight()).entry, 0.11225, 1e-7);   // from x = 13.5: -3.5 m/s
  EXPECT_EQ(contact_with(both, flight()).entry, contact_with(far, flight()).entry);
  std::swap(both.polygons.front(), both.polygons.back());
  EXPECT_EQ(contact_with(both, flight()).entry, contact_with(far, flight()).entry);
}

/// From x = 5 to x = 15: a rim of 0.5 m touches what begins at 5.3 m before the block moves, and reaches it by its
/// centre at a share of 0.03 of the way, where v^2 is 100 + 4.7^2.
TEST(ObjectFinder, WhatABlockLiesBesideAtItsReleaseIsMetByItsCentreOnly) {
  EXPECT_LT(contact_with(wall(3.0, 4.7), flight()).largest, 0.0F);
  EXPECT_NEAR(contact_with(wall(3.0, 5.2), flight()).entry, 0.125, 1e-6);
  EXPECT_NEAR(contact_with(wall(5.3, 6.0), flight()).entry, 0.12209, 1e-6);
}

TEST(ObjectFinder, WhatStandsBehindTheBarrierThatCatchesIsNotMet) {
  const Path caught = test::path_of({flight()}, End::Caught), stopped = test::path_of({flight()}, End::Stopped);
  EXPECT_NEAR(contact_with(wall(15.2, 16.0), stopped).entry, 0.1 + 0.001 * 4.7 * 4.7, 1e-6);  // touched from 14.7 m on
  EXPECT_LT(contact_with(wall(15.2, 16.0), caught).largest, 0.0F);
  EXPECT_NEAR(contact_with(wall(14.7, 16.0), caught).entry, 0.1 + 0.001 * 4.2 * 4.2, 1e-6);  // its centre gets there
}

TEST(ObjectFinder, WhatIsPassedBeforeTheBarrierIsMet) {  // a wall of 0.2 m beside the way, 3 m before its end
  const HazardObject post{{{{{11.0, 10.3}, {12.0, 10.3}, {12.0, 10.5}, {11.0, 10.5}, {11.0, 10.3}}}}, {}};
  const ObjectContact free = contact_with(post, test::path_of({flight()}, End::Stopped)),
                      caught = contact_with(post, test::path_of({flight()}, End::Caught));
  EXPECT_GT(free.entry, 0.0F);
  EXPECT_EQ(free.entry, caught.entry);
  EXPECT_EQ(free.largest, caught.largest);
}

HazardObject::Ring square(double west, double south, double side) {
  return {{west, south}, {west + side, south}, {west + side, south + side}, {west, south + side}, {west, south}};
}

TEST(ObjectFinder, WhatStandsBesideABlockInFrontOfTheBarrierIsMet) {  // 0.36 m from where the block is caught
  const HazardObject post{{{square(14.6, 10.3, 0.2)}}, {}};
  const ObjectContact free = contact_with(post, test::path_of({flight()}, End::Stopped)),
                      caught = contact_with(post, test::path_of({flight()}, End::Caught));
  EXPECT_GT(free.entry, 0.0F);
  EXPECT_EQ(free.entry, caught.entry);
  EXPECT_EQ(free.largest, caught.largest);
}

TEST(ObjectFinder, APartBesideTheReleaseOrBehindTheBarrierHidesNoOther) {
  const HazardObject::Ring beside = square(4.4, 9.9, 0.2), passed = square(10.0, 10.3, 0.2),
                           behind = square(15.2, 9.9, 0.2);
  const Path path = test::path_of({flight()}, End::Caught);
  const float alone = contact_with({{{passed}}, {}}, path).entry;
  EXPECT_GT(alone, 0.0F);
  EXPECT_EQ(contact_with({{{beside}, {passed}}, {}}, path).entry, alone);
  EXPECT_EQ(contact_with({{{passed}, {behind}}, {}}, path).entry, alone);
  EXPECT_LT(contact_with({{{beside}, {behind}}, {}}, path).entry, 0.0F);
}

}  // namespace
}  // namespace talus
