#include "talus/physics/barriers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/scenes.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/physics/trace.hpp"
#include "talus/simulate/tally/visits.hpp"

namespace talus {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Barrier net(double x, double height, double capacity) {
  return {"net", {{{x, 0.0}, {x, 40.0}}}, height, capacity};
}

/// The motions after the impacts of a path.
std::vector<Motion> impacts_of(const Path& path) {
  std::vector<Motion> impacts;
  for (const Vertex& vertex : path.vertices)
    if (vertex.event == Event::Impact) impacts.push_back(vertex.motion);
  return impacts;
}

/// A block of 1000 kg thrown level at 10 m/s from 10 m above a plain: after 1 s it is at x = 30, 4.905 m lower.
class Thrown : public testing::Test {
 protected:
  Thrown() {
    release_.body = {1.0, 1000.0};
    release_.motion.position = {20.0, 20.0, 10.0};
    release_.motion.velocity = {10.0, 0.0, 0.0};
    release_.motion.spin = {0.0, 3.0, 0.0};
  }
  Path walked(std::vector<Barrier> list, const Effects* effects = nullptr) const {
    const Barriers barriers(std::move(list));
    Path path;
    trace({surface_, cover_, {}, {}, effects, barriers.empty() ? nullptr : &barriers}, release_, path);
    return path;
  }
  const double energy_ = 0.5 * 1000.0 * (100.0 + 9.81 * 9.81);  // at x = 30

  Surface surface_{test::terrain(test::grid_of(60, 20, 2.0, 2.0), [](double, double) { return 0.0; })};
  Cover cover_{{Ground{}}, {}};
  Release release_;
};

TEST_F(Thrown, OverTheTopChangesNoBit) {
  const Path free = walked({}), over = walked({net(30.0, 5.0, 0.0)});
  ASSERT_FALSE(over.barriers.empty());
  EXPECT_EQ(over.barriers[0].how, Meeting::Over);
  EXPECT_NEAR(over.barriers[0].along, 20.0, 1e-12);
  ASSERT_EQ(free.vertices.size(), over.vertices.size());
  for (std::size_t i = 0; i < free.vertices.size(); ++i) {
    EXPECT_EQ(free.vertices[i].motion.position, over.vertices[i].motion.position);
    EXPECT_EQ(free.vertices[i].motion.velocity, over.vertices[i].motion.velocity);
  }
  EXPECT_EQ(free.length, over.length);
}

TEST_F(Thrown, CaughtBelowTheTop) {
  const Path path = walked({net(30.0, 5.2, energy_ * (1.0 + 1e-12))});
  EXPECT_EQ(path.end, End::Caught);
  ASSERT_EQ(path.vertices.size(), 2U);
  const Motion& end = path.vertices.back().motion;
  EXPECT_NEAR(end.position.x(), 29.999, 1e-9);
  EXPECT_NEAR(end.position.z(), 10.0 - 0.5 * 9.81 * 0.9999 * 0.9999, 1e-9);
  EXPECT_EQ(end.velocity.norm(), 0.0);
  EXPECT_EQ(end.spin.norm(), 0.0);
  EXPECT_NEAR(path.plan_length, 9.999, 1e-9);
  const double g = 9.81, a = g / 10.0;  // length of a parabola, closed form
  EXPECT_NEAR(path.length, 0.5 * 10.0 * (std::sqrt(1 + a * a) + std::asinh(a) / a), 0.002);
  EXPECT_NEAR(surface_.x_of(path.spans.back().patch.column + path.spans.back().p_to), 29.999, 1e-5);
  EXPECT_NEAR(path.spans.back().height_to, 10.0 - 0.5 * g, 0.002);
  EXPECT_NEAR(path.spans.back().rise_to, -g, 0.002);
}

/// Half of the energy is left: the speed is that of before times sqrt(1/2), in the same direction; the flight from
/// there to the plain is a parabola again.
TEST_F(Thrown, BrokenGoesOnWithTheEnergyThatIsLeft) {
  const Path path = walked({net(30.0, 6.0, 0.5 * energy_)});
  ASSERT_GE(path.vertices.size(), 3U);
  ASSERT_EQ(path.vertices[1].event, Event::Barrier);
  const Motion& m = path.vertices[1].motion;
  EXPECT_NEAR(m.time, 1.0, 1e-12);
  EXPECT_NEAR(m.position.x(), 30.0, 1e-12);
  EXPECT_NEAR(m.position.z(), 10.0 - 4.905, 1e-12);
  EXPECT_NEAR(m.velocity.x(), 10.0 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(m.velocity.z(), -9.81 * std::sqrt(0.5), 1e-12);
  EXPECT_EQ(m.spin, release_.motion.spin);
  const double down = 9.81 * std::sqrt(0.5), fall = (std::sqrt(down * down + 2 * 9.81 * 5.095) - down) / 9.81;
  EXPECT_EQ(path.vertices[2].event, Event::Impact);
  EXPECT_NEAR(path.vertices[2].motion.time, 1.0 + fall, 1e-9);
  EXPECT_NEAR(path.vertices[2].motion.position.x(), 30.0 + fall * 10.0 * std::sqrt(0.5), 1e-9);
  int breaks = 0;
  for (const BarrierPassage& passage : path.barriers) breaks += passage.how == Meeting::Broken ? 1 : 0;
  EXPECT_EQ(breaks, 1);  // not met again where it starts on the line
}

/// Three nets of a tenth of the energy each, close together: the energies add up. A fourth holds the rest.
TEST_F(Thrown, NetsOneAfterTheOther) {
  const double part = 0.1 * energy_;
  const Path path = walked(
      {net(30.000, 6.0, part), net(30.001, 6.0, part), net(30.002, 6.0, part), net(30.003, 6.0, 0.71 * energy_)});
  EXPECT_EQ(path.end, End::Caught);
  ASSERT_EQ(path.barriers.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(path.barriers[i].barrier, i);
  EXPECT_NEAR(path.vertices[3].motion.velocity.squaredNorm() * 500.0, 0.7 * energy_, 0.001 * energy_);
  EXPECT_EQ(
      walked({net(30.0, 6.0, part), net(30.001, 6.0, part), net(30.002, 6.0, part), net(30.003, 6.0, 0.69 * energy_)})
          .barriers[3]
          .how,
      Meeting::Broken);
}

/// Panels that overlap, or an old fence and its replacement: in any order, direction and division of the line.
TEST_F(Thrown, NetsOnOneLineTakeTheirCapacityEach) {
  test::Numbers numbers(3);
  for (int i = 0; i < 200; ++i) {
    const double angle = numbers.uniform(0.3, 2.8);
    const Eigen::Vector2d middle(30.0, 20.0), along(std::cos(angle), std::sin(angle));
    std::vector<Barrier> nets;
    for (int n = 0; n < 3; ++n) {
      const Eigen::Vector2d from = middle - numbers.uniform(1.0, 9.0) * along,
                            to = middle + numbers.uniform(1.0, 9.0) * along;
      nets.push_back({"net", {n == 1 ? std::vector{to, from} : std::vector{from, to}}, 20.0, 0.1 * energy_});
    }
    Path path = walked(nets);
    ASSERT_GE(path.vertices.size(), 3U);
    EXPECT_EQ(path.vertices[1].event, Event::Barrier) << i;
    EXPECT_NEAR(500.0 * path.vertices[1].motion.velocity.squaredNorm(), 0.7 * energy_, 1e-6 * energy_) << i;
    EXPECT_EQ(path.barriers.size(), 3U) << i;

    nets[static_cast<std::size_t>(i % 3)].capacity = kInfinity;
    path = walked(nets);
    EXPECT_EQ(path.end, End::Caught) << i;
    EXPECT_NEAR(path.vertices.back().motion.position.x(), 29.999, 1e-5) << i;  // in front of all of them
  }
}

TEST_F(Thrown, ALowNetOnTheLineOfOneThatBreaksIsPassedOnce) {
  for (const bool low_first : {true, false}) {
    std::vector<Barrier> nets{net(30.0, 1.0, 0.0), net(30.0, 20.0, 0.1 * energy_)};
    if (!low_first) std::swap(nets[0], nets[1]);
    EXPECT_EQ(walked(nets).barriers.size(), 2U);
  }
}

TEST_F(Thrown, ANetWithoutCapacityTakesNothing) {
  const Path path = walked({net(30.0, 6.0, 0.0)});
  ASSERT_EQ(path.vertices[1].event, Event::Barrier);
  EXPECT_NEAR(path.vertices[1].motion.velocity.squaredNorm() * 500.0, energy_, 1e-9 * energy_);
}

/// A block of 1000 kg set on a smooth slope of 0.8 slides down: g (sin b - tan(phi) cos b) along it, without a bounce.
class Sliding : public Thrown {
 protected:
  Sliding() {
    surface_ =
        Surface(test::terrain(test::grid_of(60, 20, 2.0, 2.0), [](double x, double) { return 100.0 - 0.8 * x; }));
    release_.motion.position = {20.0, 20.0, 100.0 - 16.0};
    release_.motion.velocity = {0.0, 0.0, 0.0};
  }
  /// Energy at x [J], from rest at x = 20.
  static double energy_at(double x) {
    const double way = (x - 20.0) * std::sqrt(1.64), pull = 9.81 * (0.8 - 0.57735026918962573) / std::sqrt(1.64);
    return 1000.0 * pull * way;
  }
};

TEST_F(Sliding, CaughtByAnyHeight) {
  const Path path = walked({net(40.0, 0.01, 1.01 * energy_at(40.0))});
  EXPECT_EQ(path.end, End::Caught);
  EXPECT_NEAR(path.vertices.back().motion.position.x(), 39.999, 1e-4);
  EXPECT_NEAR(path.vertices.back().motion.position.z(), 100.0 - 0.8 * 40.0, 2e-3);
  EXPECT_NEAR(path.plan_length, 20.0, 2e-3);
  EXPECT_NEAR(path.length, 20.0 * std::sqrt(1.64), 4e-3);
  EXPECT_EQ(path.spans.back().height_to, 0.0F);
}

TEST_F(Sliding, BreaksAndSlidesOn) {
  const double capacity = 0.6 * energy_at(40.0);
  const Path path = walked({net(40.0, 3.0, capacity), net(50.0, 3.0, 1e12)});
  const auto broken = std::find_if(path.vertices.begin(), path.vertices.end(),
                                   [](const Vertex& v) { return v.event == Event::Barrier; });
  ASSERT_NE(broken, path.vertices.end());
  EXPECT_EQ((broken - 1)->event, Event::Slide);
  EXPECT_EQ((broken + 1)->event, Event::Slide);
  EXPECT_NEAR(broken->motion.position.x(), 40.0, 1e-9);
  EXPECT_NEAR(broken->motion.velocity.squaredNorm() * 500.0, energy_at(40.0) - capacity, 1e-4 * energy_at(40.0));
  ASSERT_EQ(path.barriers.size(), 2U);
  EXPECT_EQ(path.barriers[0].how, Meeting::Broken);
  EXPECT_EQ(path.end, End::Caught);
  EXPECT_NEAR(path.vertices.back().motion.position.x(), 50.0, 2e-3);
}

/// The speed at the end of a span that is cut, and in the map of its cell: v^2 = 2 a s, from rest at x = 20.
TEST_F(Sliding, TheMapSeesTheSpeedAtTheBarrier) {
  for (const double x : {20.05, 20.25, 20.7, 21.6}) {  // its first slide is of 0.78 m in plan
    const Path path = walked({net(x, 3.0, kInfinity)});
    EXPECT_EQ(path.end, End::Caught);
    const double squared = 2.0 * energy_at(x - 0.001) / 1000.0;
    EXPECT_NEAR(path.spans.back().rise_to, std::sqrt(squared), 1e-4) << x;
    VisitBatch batch(surface_.grid());
    batch.add(path, release_.body, 0, nullptr);
    ASSERT_EQ(batch.regions().size(), 1U);
    ASSERT_EQ(batch.regions().begin()->second.visits.size(), 1U);
    batch.regions().begin()->second.visits.for_each(
        [&](const Visit& visit) { EXPECT_NEAR(visit.speed_squared, squared, 1e-4 * squared) << x; });
  }
}

/// 45 degrees, phi = 30 degrees, D = 4 m (90 478 kg), at rest on the ground: E = m g (sin b - tan(phi) cos b) s is
/// 187.6 kJ after 0.5 m in plan, in the middle of a piece. A barrier of 100 kJ breaks and leaves the rest; one of 190
/// kJ holds.
TEST_F(Sliding, ABarrierInTheMiddleOfAPieceTakesItsCapacity) {
  surface_ = Surface(test::terrain(test::grid_of(40, 9, 5.0, 5.0), [](double x, double) { return 500.0 - x; }));
  release_.body = block_of(4.0, 2700.0);
  release_.motion.position = {22.5, 22.5, 500.0 - 22.5};
  const double energy = release_.body.mass * 9.81 * (1.0 - 0.57735026918962573) * 0.5;
  ASSERT_NEAR(energy, 187.6e3, 50.0);
  const Path path = walked({net(23.0, 3.0, 100e3)});
  const auto broken = std::find_if(path.vertices.begin(), path.vertices.end(),
                                   [](const Vertex& v) { return v.event == Event::Barrier; });
  ASSERT_NE(broken, path.vertices.end());
  EXPECT_NEAR(0.5 * release_.body.mass * broken->motion.velocity.squaredNorm(), energy - 100e3, 1.0);
  EXPECT_EQ(walked({net(23.0, 3.0, 187e3)}).barriers.at(0).how, Meeting::Broken);
  EXPECT_EQ(walked({net(23.0, 3.0, 188e3)}).end, End::Caught);
}

/// A smooth slope of 3 in 4 (exact in floats: no edge of a patch is convex) without asperities: after each diameter of
/// 1 m, 0.8 m in plan, an impact that changes nothing. Many fences stand on it that take 1e-12 of the energy.
class SlidingThroughFences : public Sliding {
 protected:
  SlidingThroughFences() {
    surface_ =
        Surface(test::terrain(test::grid_of(60, 20, 2.0, 2.0), [](double x, double) { return 100.0 - 0.75 * x; }));
    cover_.grounds[0] = {.theta_scale = 0.0, .psi_scale = 0.0, .shape_min = 1.0, .shape_max = 1.0};
    release_.motion.position = {20.0, 20.0, 85.0};
    for (double x = 20.3; x < 60.0; x += 0.61) fences_.push_back(net(x, 3.0, 1e-9));
  }
  const std::vector<Barrier> last_{net(99.9, 3.0, kInfinity)};
  std::vector<Barrier> fences_ = last_;
};

TEST_F(SlidingThroughFences, TheDiameterDoesNotBeginAgain) {
  const double pull = 9.81 * (0.75 - 0.57735026918962573) / 1.25;
  const Path path = walked(fences_);
  EXPECT_EQ(path.barriers.size(), fences_.size());
  const std::vector<Motion> impacts = impacts_of(path);
  EXPECT_EQ(impacts.size(), 100U);  // in 79.9 m in plan, with the first
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    const double way = static_cast<double>(i);
    ASSERT_NEAR(impacts[i].position.x(), 20.0 + 0.8 * way, 1e-6 * (way + 1.0));  // a slide may end 1e-6 D early
    ASSERT_NEAR(impacts[i].velocity.squaredNorm(), 2.0 * pull * way, 1e-5 * (way + 1.0));
  }
}

/// Drag acts at the end of a slide (docs/effects.md), also if fences break in it.
TEST_F(SlidingThroughFences, DragActsAsWithoutThem) {
  Effects effects;
  effects.vegetation_drag = {.coefficient = 300.0, .height = 60.0, .where = {}};
  const std::vector<Motion> free = impacts_of(walked(last_, &effects)), fenced = impacts_of(walked(fences_, &effects));
  ASSERT_EQ(free.size(), fenced.size());
  for (std::size_t i = 0; i < free.size(); ++i) {
    ASSERT_LT((free[i].position - fenced[i].position).norm(), 1e-5) << i;
    ASSERT_LT((free[i].velocity - fenced[i].velocity).norm(), 1e-5) << i;
  }
}

TEST(Barrier, NeverNegativeNeverNaN) {
  EXPECT_EQ(kept_speed(2.0, 2.0), 0.0);
  EXPECT_EQ(kept_speed(2.0, 3.0), 0.0);
  EXPECT_DOUBLE_EQ(kept_speed(4.0, 3.0), 0.5);
  EXPECT_EQ(kept_speed(1e-300, 0.0), 1.0);
  const Barrier barrier = net(0.0, 2.0, 100.0);
  EXPECT_EQ(meeting(barrier, 2.0, 1.0), Meeting::Over);
  EXPECT_EQ(meeting(barrier, std::nextafter(2.0, 0.0), 100.0), Meeting::Caught);
  EXPECT_EQ(meeting(barrier, 0.0, std::nextafter(100.0, 200.0)), Meeting::Broken);
  EXPECT_EQ(meeting(barrier, 0.0, std::nan("")), Meeting::Caught);
  EXPECT_EQ(meeting(net(0.0, 0.0, kInfinity), 0.0, 1.0), Meeting::Over);  // sliding, under a net of no height
}

/// Twenty segments in three boxes, a zigzag. A way along the line crosses each segment once, in order, from any start.
TEST(Barriers, CrossingsComeInTheOrderOfTheWay) {
  Barrier zigzag{"z", {{}}, 1.0, 1.0};
  for (int i = 0; i <= 20; ++i) zigzag.lines[0].emplace_back(i, i % 2 == 0 ? -1.0 : 1.0);
  const Barriers barriers({zigzag});
  EXPECT_NEAR(barriers.length(0), 20.0 * std::sqrt(5.0), 1e-12);
  for (const bool back : {false, true}) {
    const Eigen::Vector2d a(back ? 30.0 : -1.0, 0.0), b(back ? -1.0 : 30.0, 0.0);
    std::optional<Barriers::Cut> cut;
    int count = 0;
    for (; (cut = barriers.next(a, b, cut)); ++count) {
      const double x = back ? 19.5 - count : 0.5 + count;
      EXPECT_NEAR(a.x() + cut->share * (b.x() - a.x()), x, 1e-12);
      EXPECT_NEAR(cut->along, x * std::sqrt(5.0), 1e-9);
    }
    EXPECT_EQ(count, 20);
  }
}

/// A crossing through a corner of the line or of the path counts once.
TEST(Barriers, CornersCountOnce) {
  const Barriers bend({Barrier{"b", {{{5.0, 0.0}, {5.0, 10.0}, {5.0, 20.0}}}, 1.0, 1.0}});
  const auto count = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    int found = 0;
    std::optional<Barriers::Cut> cut;
    while ((cut = bend.next(a, b, cut))) ++found;
    return found;
  };
  EXPECT_EQ(count({0.0, 10.0}, {10.0, 10.0}), 1);
  EXPECT_EQ(count({0.0, 4.0}, {5.0, 4.0}) + count({5.0, 4.0}, {10.0, 4.0}), 1);
  EXPECT_EQ((count({0.0, 4.0}, {5.0, 4.0}) + count({5.0, 4.0}, {0.0, 4.0})) % 2, 0);  // there and back
  EXPECT_EQ(count({0.0, 30.0}, {10.0, 30.0}), 0);
}

}  // namespace
}  // namespace talus
