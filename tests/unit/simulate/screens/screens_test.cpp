#include "talus/simulate/screens/screens.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenarios.hpp"

namespace talus {
namespace {

using test::Numbers;

using Line = std::vector<Eigen::Vector2d>;

/// A plane z = 50 - x / 2 of 200 m x 200 m with these screens.
Scenario plane_with(std::vector<Screen> screens) {
  Scenario s = test::scenario_on(
      test::terrain(test::grid_of(200, 200, 1.0, 1.0), [](double x, double) { return 50.0 - 0.5 * x; }));
  s.screens = std::move(screens);
  return s;
}

Vertex vertex(Event event, double time, const Vec3& position, const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
  return {{time, position, velocity, spin}, event};
}

std::vector<Crossing> crossings_of(const Scenario& scenario, std::vector<Vertex> vertices) {
  Release release;
  release.source = 7;
  release.block = 9;
  release.body = {1.5, 4000.0};
  Path path;
  path.vertices.assign(vertices.begin(), vertices.end());
  std::vector<Crossing> crossings;
  ScreenFinder(scenario).find(release, path, crossings);
  return crossings;
}

/// A path of flights through places in plan, one second from place to place.
std::vector<Vertex> through(const Line& places) {
  std::vector<Vertex> vertices;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector2d way =
        i + 1 < places.size() ? Eigen::Vector2d(places[i + 1] - places[i]) : Eigen::Vector2d(0, 0);
    const Event event = i == 0 ? Event::Release : i + 1 < places.size() ? Event::Impact : Event::End;
    vertices.push_back(
        vertex(event, static_cast<double>(i), {places[i].x(), places[i].y(), 60.0}, {way.x(), way.y(), 0.0}));
  }
  return vertices;
}

std::size_t count(const Line& screen, const Line& path) {
  return crossings_of(plane_with({{"a", {screen}}}), through(path)).size();
}

/// 5 s of flight from (10, 10, 90) at (8, 6, 20): it is at (50, 40, 67.375) when it meets x = 50.
std::vector<Vertex> flight() {
  return {vertex(Event::Release, 3.0, {10, 10, 90}, {8, 6, 20}, {1, 2, -2}),
          vertex(Event::End, 13.0, {90, 70, 90 + 200 - 0.5 * 9.81 * 100}, {0, 0, 0})};
}

TEST(ScreenFinder, ACrossingOfAParabola) {
  const auto crossings = crossings_of(plane_with({{"a", {{{50, 25}, {50, 100}}}}}), flight());
  ASSERT_EQ(crossings.size(), 1U);
  const Crossing& c = crossings[0];
  EXPECT_EQ(c.source, 7U);
  EXPECT_EQ(c.block, 9U);
  EXPECT_EQ(c.screen, 0U);
  EXPECT_NEAR(c.x, 50.0, 1e-12);
  EXPECT_NEAR(c.y, 40.0, 1e-12);
  EXPECT_NEAR(c.speed, std::sqrt(64.0 + 36.0 + (20.0 - 49.05) * (20.0 - 49.05)), 1e-12);
  EXPECT_NEAR(c.height, 90.0 + 100.0 - 0.5 * 9.81 * 25.0 - 25.0, 1e-11);  // above z = 25
  EXPECT_NEAR(c.spin, 3.0, 1e-14);
  EXPECT_EQ(c.mass, 4000.0);
  EXPECT_EQ(c.diameter, 1.5);
  EXPECT_NEAR(c.along, 15.0, 1e-12);
  EXPECT_NEAR(c.time, 8.0, 1e-12);
}

TEST(ScreenFinder, ObliqueLinesOfEitherDirection) {  // from (20, 70) to (80, 10): the path meets x + y = 90 at t = 5
  for (const bool reverse : {false, true}) {
    Line line{{20, 70}, {80, 10}};
    if (reverse) std::swap(line[0], line[1]);
    const auto crossings = crossings_of(plane_with({{"a", {line}}}), flight());
    ASSERT_EQ(crossings.size(), 1U);
    EXPECT_NEAR(crossings[0].x, 50.0, 1e-12);
    EXPECT_NEAR(crossings[0].along, 30.0 * std::sqrt(2.0), 1e-11);
    EXPECT_NEAR(crossings[0].time, 8.0, 1e-12);
  }
}

TEST(ScreenFinder, PartsOfALineCountOnAlongIt) {  // 10 m, then 40 m elsewhere, with a bend
  const Screen screen{"a", {{{0, 100}, {10, 100}}, {{50, 10}, {50, 30}, {50, 50}}}};
  const auto crossings = crossings_of(plane_with({screen}), flight());
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_NEAR(crossings[0].along, 10.0 + 30.0, 1e-11);
}

TEST(ScreenFinder, ScreensInTheOrderOfTime) {
  const auto x_equals = [](double x) { return Screen{"s", {{{x, 0}, {x, 100}}}}; };
  const auto crossings = crossings_of(plane_with({x_equals(70), x_equals(30), x_equals(95), x_equals(50)}), flight());
  ASSERT_EQ(crossings.size(), 3U);
  const std::uint32_t order[] = {1, 3, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(crossings[i].screen, order[i]);
    EXPECT_NEAR(crossings[i].x, 30.0 + 20.0 * static_cast<double>(i), 1e-12);
  }
}

TEST(ScreenFinder, BackAndForthAreThreeCrossings) {
  const auto crossings =
      crossings_of(plane_with({{"a", {{{50, 0}, {50, 100}}}}}), through({{20, 20}, {60, 30}, {40, 40}, {90, 50}}));
  ASSERT_EQ(crossings.size(), 3U);
  EXPECT_NEAR(crossings[0].y, 27.5, 1e-12);
  EXPECT_NEAR(crossings[1].y, 35.0, 1e-12);
  EXPECT_NEAR(crossings[2].y, 42.0, 1e-12);
  EXPECT_LT(crossings[0].time, crossings[1].time);
  EXPECT_LT(crossings[1].time, crossings[2].time);
}

TEST(ScreenFinder, MissesWhatItDoesNotMeet) {
  const Line screen{{50, 20}, {50, 60}};
  EXPECT_EQ(count(screen, {{10, 10}, {90, 10}}), 0U);      // beside its end
  EXPECT_EQ(count(screen, {{10, 30}, {49.999, 30}}), 0U);  // short of it
  EXPECT_EQ(count(screen, {{50.001, 30}, {90, 30}}), 0U);  // beyond it
  EXPECT_EQ(count(screen, {{50.001, 10}, {50.001, 90}}), 0U);
  EXPECT_EQ(count(screen, {{10, 150}, {90, 150}}), 0U);
  EXPECT_EQ(count(screen, {{10, 30}, {10, 30}, {20, 30}}), 0U);  // a step of no length
  EXPECT_EQ(count(screen, {{10, 30}, {90, 30}}), 1U);
  EXPECT_TRUE(crossings_of(plane_with({}), flight()).empty());
}

TEST(ScreenFinder, ThroughAVertexOfTheScreenOnce) {
  const Line bent{{50, 0}, {50, 40}, {70, 80}, {50, 100}};
  EXPECT_EQ(count(bent, {{10, 10}, {90, 70}}), 1U);  // through (50, 40)
  EXPECT_EQ(count(bent, {{90, 70}, {10, 10}}), 1U);
  EXPECT_EQ(count(bent, {{50, 80}, {90, 80}}), 1U);  // through (70, 80)
  EXPECT_EQ(count(bent, {{90, 80}, {50, 80}}), 1U);
}

TEST(ScreenFinder, ThroughAVertexOfThePathOnce) {
  const Line screen{{50, 0}, {50, 100}};
  EXPECT_EQ(count(screen, {{10, 10}, {50, 40}, {90, 30}}), 1U);
  EXPECT_EQ(count(screen, {{90, 30}, {50, 40}, {10, 10}}), 1U);
  EXPECT_EQ(count(screen, {{10, 10}, {50, 40}, {50, 60}, {90, 30}}), 1U);  // along it for a while
}

TEST(ScreenFinder, APathVertexOnTheScreenIsCountedOnceWhateverRoundingSays) {
  Numbers numbers(1);
  for (int i = 0; i < 2000; ++i) {
    const double x = numbers.uniform(10, 90);
    ASSERT_EQ(count({{x, 0}, {x, 200}}, {{numbers.uniform(2, x), 50}, {x, 51}, {numbers.uniform(x, 190), 52}}), 1U)
        << x;
  }
}

TEST(ScreenFinder, TouchingAndTurningBackIsNoNetCrossing) {
  const Line screen{{50, 0}, {50, 100}}, roof{{20, 20}, {50, 40}, {80, 20}};
  EXPECT_EQ(count(screen, {{10, 10}, {50, 40}, {20, 60}}) % 2, 0U);
  EXPECT_EQ(count(screen, {{90, 10}, {50, 40}, {80, 60}}) % 2, 0U);
  EXPECT_EQ(count(roof, {{10, 40}, {90, 40}}) % 2, 0U);  // over its tip
  EXPECT_EQ(count(roof, {{90, 40}, {10, 40}}) % 2, 0U);
}

TEST(ScreenFinder, ARingIsCrossedAnEvenNumberOfTimesUnlessThePathEndsInside) {
  Numbers numbers(2);
  Line ring;
  for (int i = 0; i < 17; ++i) {
    const double r = numbers.uniform(20, 60);
    ring.emplace_back(100 + r * std::cos(i * kPi / 8.5), 100 + r * std::sin(i * kPi / 8.5));
  }
  ring.back() = ring.front();
  const auto inside = [&](const Eigen::Vector2d& p) {  // by the angle under which the ring is seen
    double angle = 0.0;
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const Eigen::Vector2d a = ring[i - 1] - p, b = ring[i] - p;
      angle += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    }
    return std::abs(angle) > kPi;
  };
  const Scenario scenario = plane_with({{"a", {ring}}});
  for (int trial = 0; trial < 500; ++trial) {
    Line path;
    for (int i = 0; i < 12; ++i) path.emplace_back(numbers.uniform(30, 170), numbers.uniform(30, 170));
    ASSERT_EQ(crossings_of(scenario, through(path)).size() % 2 == 1, inside(path.front()) != inside(path.back()))
        << trial;
  }
}

TEST(ScreenFinder, SlidesHaveNoHeight) {  // in plan from 6 m/s at -1 m/s^2 for 2 s: 10 m, then 4 m/s
  const auto crossings = crossings_of(plane_with({{"a", {{{45, 0}, {45, 100}}}}}),
                                      {vertex(Event::Slide, 1.0, {40, 40, 30.0}, {6, 0, -3}, {0, 4, 3}),
                                       vertex(Event::End, 3.0, {50, 40, 25.0}, {4, 0, -2})});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_EQ(crossings[0].height, 0.0);
  EXPECT_NEAR(crossings[0].speed, std::sqrt(1.25) * std::sqrt(36.0 - 2.0 * 5.0), 1e-12);
  EXPECT_NEAR(crossings[0].spin, 5.0, 1e-14);
  EXPECT_NEAR(crossings[0].along, 40.0, 1e-12);
  EXPECT_NEAR(crossings[0].time, 1.0 + 6.0 - std::sqrt(26.0), 1e-12);  // 6 t - t^2/2 = 5
}

TEST(ScreenFinder, ASlideIntoAnImpactHasTheSpeedBeforeIt) {  // the impact leaves 1 m/s only, of 4 m/s
  const auto crossings = crossings_of(
      plane_with({{"a", {{{49, 0}, {49, 100}}}}}),
      {vertex(Event::Slide, 1.0, {40, 40, 30.0}, {6, 0, 0}), vertex(Event::Impact, 3.0, {50, 40, 30.0}, {0.8, 0, 0.6}),
       vertex(Event::End, 4.0, {50.8, 40, 25.0}, {0.8, 0, -3})});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_NEAR(crossings[0].speed, std::sqrt(36.0 - 2.0 * 9.0), 1e-12);
}

/// A block of 4 m at rest on a smooth slope of 45 degrees: v^2 = 2 g (sin b - tan(phi) cos b) s, from the first
/// centimetres on, and t = v / a.
TEST(ScreenFinder, ASlideFromRestInClosedForm) {
  Scenario s =
      test::scenario_on(test::terrain(test::grid_of(40, 9, 5.0, 5.0), [](double x, double) { return 500.0 - x; }));
  const std::vector<std::pair<double, double>> exact{{0.02, 0.407}, {0.25, 1.440}, {0.5, 2.036}, {1.0, 2.880}};
  for (const auto& [way, speed] : exact) s.screens.push_back({"", {{{22.5 + way, 0.0}, {22.5 + way, 45.0}}}});
  Release release;
  release.body = block_of(4.0, 2700.0);
  release.motion.position = {22.5, 22.5, 500.0 - 22.5};
  Path path;
  trace(s.world(), release, path);
  std::vector<Crossing> crossings;
  ScreenFinder(s).find(release, path, crossings);
  ASSERT_EQ(crossings.size(), exact.size());
  const double pull = 9.81 * (1.0 - 1.0 / std::sqrt(3.0)) / std::sqrt(2.0);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double v = std::sqrt(2.0 * pull * std::sqrt(2.0) * exact[i].first);
    EXPECT_NEAR(exact[i].second, v, 0.0006);  // the figures by hand
    EXPECT_NEAR(crossings[i].speed, v, 1e-6) << i;
    EXPECT_NEAR(crossings[i].time, v / pull, 1e-6) << i;
    EXPECT_NEAR(crossings[i].dip, radians(45.0), 1e-6) << i;
  }
}

TEST(ScreenFinder, NeverBelowTheGround) {  // a landing that rounding puts a little under the surface
  const auto crossings = crossings_of(plane_with({{"a", {{{49.9999, 0}, {49.9999, 100}}}}}),
                                      {vertex(Event::Impact, 0.0, {40, 40, 30.0}, {10, 0, -0.095}),
                                       vertex(Event::End, 1.0, {50, 40, 25.0}, {0, 0, 0})});
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_GE(crossings[0].height, 0.0);
  EXPECT_LE(crossings[0].height, 1e-3);
}

TEST(PartAlong, OfALineWithACornerAndOfTwoLines) {
  const Screen screen{"a", {{{0, 0}, {30, 0}, {30, 40}}, {{100, 0}, {100, 10}}}};  // 70 m and 10 m long
  EXPECT_EQ(length_of(screen.lines[0]), 70.0);
  EXPECT_EQ(part_along(screen, 10, 50), (Line{{10, 0}, {30, 0}, {30, 20}}));
  EXPECT_EQ(part_along(screen, 0, 70), screen.lines[0]);
  EXPECT_EQ(part_along(screen, 70, 80), screen.lines[1]);
  EXPECT_EQ(part_along(screen, 69.9999999, 80), screen.lines[1]) << "the edge of a stretch is rounded";
  EXPECT_EQ(part_along(screen, 72, 75), (Line{{100, 2}, {100, 5}}));
}

}  // namespace
}  // namespace talus
