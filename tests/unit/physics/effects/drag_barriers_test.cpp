#include <gtest/gtest.h>

#include <algorithm>

#include "support/slopes.hpp"
#include "talus/physics/effects/air_drag.hpp"

namespace talus {
namespace {

using test::block_at;
using test::Hillside;
using test::same_bits;

constexpr double kNothing = 1e-6;  // a capacity of 1e-11 of the energies here [J]

Barrier net(double x, double height, double capacity) {
  return {"net", {{{x, 0.0}, {x, 800.0}}}, height, capacity};
}

std::vector<Barrier> fences(double from, double to, double every) {
  std::vector<Barrier> list;
  for (int i = 0; from + i * every < to; ++i) list.push_back(net(from + i * every, 100.0, kNothing));
  return list;
}

Path run(const Hillside& hill, const Release& release, std::vector<Barrier> list) {
  const Barriers barriers(std::move(list));
  World world = hill.world();
  world.barriers = &barriers;
  Path path;
  trace(world, release, path);
  return path;
}

const Vertex* first_of(const Path& path, Event event) {
  const auto found =
      std::find_if(path.vertices.begin(), path.vertices.end(), [=](const Vertex& v) { return v.event == event; });
  return found == path.vertices.end() ? nullptr : &*found;
}

/// A block of 305 kg thrown level at 20 m/s from 40 m above a plain with undergrowth, at x = 50; c/m = 0.39 1/s.
class ThrownIntoBushes : public testing::Test {
 protected:
  ThrownIntoBushes() { hill_.effects.vegetation_drag = {.coefficient = 120.0, .height = 60.0, .where = {}}; }

  struct Flown {
    double time, fallen;
    Vec3 velocity;
  };
  /// Closed form after a way x: v_x = v0 - r x, and e^-rt = v_x/v0.
  Flown after(double x) const {
    const double kept = 1.0 - rate_ * x / 20.0, time = -std::log(kept) / rate_, end = kGravity / rate_;
    return {time, end * (time - (1.0 - kept) / rate_), Vec3(20.0 * kept, 0.0, -end * (1.0 - kept))};
  }

  Hillside hill_{0.0, 5.0, 160};
  const Release release_ = block_at({50.0, 400.0, 1040.0}, {20.0, 0.0, 0.0}, 0.6);
  const double mass_ = release_.body.mass, rate_ = 120.0 / mass_;
};

TEST_F(ThrownIntoBushes, ANetHoldsTheEnergyOfTheBlock) {
  for (double x = 0.2; x < 34.0; x += 1.7) {
    const double energy = 0.5 * mass_ * after(x).velocity.squaredNorm();
    const Path caught = run(hill_, release_, {net(50.0 + x, 100.0, energy * (1.0 + 1e-9))});
    ASSERT_EQ(caught.end, End::Caught) << x;
    EXPECT_NEAR(caught.vertices.back().motion.position.x(), 50.0 + x - 0.001, 1e-9);
    EXPECT_NEAR(caught.vertices.back().motion.position.z(), 1040.0 - after(x - 0.001).fallen, 1e-9);
    EXPECT_NEAR(caught.plan_length, x - 0.001, 1e-9);
    const Path broken = run(hill_, release_, {net(50.0 + x, 100.0, energy * (1.0 - 1e-9))});
    ASSERT_EQ(broken.barriers.size(), 1U) << x;
    EXPECT_EQ(broken.barriers[0].how, Meeting::Broken) << x;
  }
}

TEST_F(ThrownIntoBushes, ABrokenNetTakesItsCapacity) {
  for (const double x : {0.2, 7.1, 23.0}) {
    const double energy = 0.5 * mass_ * after(x).velocity.squaredNorm();
    const Path path = run(hill_, release_, {net(50.0 + x, 100.0, 0.3 * energy)});
    const Vertex* broken = first_of(path, Event::Barrier);
    ASSERT_NE(broken, nullptr);
    EXPECT_NEAR(broken->motion.time, after(x).time, 1e-9);
    EXPECT_LT((broken->motion.velocity - std::sqrt(0.7) * after(x).velocity).norm(), 1e-8) << x;
  }
}

TEST_F(ThrownIntoBushes, FencesThatHoldNothingLeaveTheFlight) {
  const Path free = run(hill_, release_, {});
  for (const double every : {10.0, 1.0, 0.25, 0.1}) {
    const std::vector<Barrier> list = fences(50.05, 80.0, every);
    const Path path = run(hill_, release_, list);
    std::size_t met = 0;
    for (const Vertex& vertex : path.vertices) {
      if (vertex.event != Event::Barrier) continue;
      const Flown there = after(0.05 + every * static_cast<double>(met++));
      ASSERT_NEAR(vertex.motion.time, there.time, 1e-7) << every << ' ' << met;
      ASSERT_NEAR(vertex.motion.position.z(), 1040.0 - there.fallen, 1e-6) << every << ' ' << met;
      ASSERT_LT((vertex.motion.velocity - there.velocity).norm(), 1e-6) << every << ' ' << met;
    }
    EXPECT_EQ(met, list.size());
    const Vertex *one = first_of(free, Event::Impact), *other = first_of(path, Event::Impact);
    EXPECT_NEAR(one->motion.position.x(), other->motion.position.x(), 1e-3 * 35.0);
    EXPECT_NEAR(one->motion.time, other->motion.time, 1e-3 * one->motion.time);
  }
}

TEST_F(ThrownIntoBushes, OverTheTopChangesNoBit) {
  std::vector<Barrier> low;
  for (double x = 50.05; x < 65.0; x += 0.7) low.push_back(net(x, 5.0, 0.0));
  const Path path = run(hill_, release_, low);
  EXPECT_GT(path.barriers.size(), 20U);
  EXPECT_TRUE(same_bits(path, hill_.run(release_)));
}

/// With drag by the square of the speed, against steps of the midpoint rule of 0.1 ms; the speed is right to 1e-3.
TEST(AirDragBarriers, ANetHoldsTheEnergyOfTheBlock) {
  Hillside hill(0.0, 5.0, 160);
  hill.effects.air_drag.coefficient = 1.0;
  const Release release = block_at({50.0, 400.0, 1060.0}, {40.0, 0.0, 5.0}, 0.08);
  const double k = air_drag_rate(hill.effects.air_drag, release.body);
  const auto change = [&](const Vec3& u) -> Vec3 { return -k * u.norm() * u - Vec3(0.0, 0.0, kGravity); };
  for (const double x : {0.3, 4.0, 11.0, 37.0, 70.0}) {
    Vec3 v = release.motion.velocity;
    double gone = 0.0;
    for (constexpr double kStep = 1e-4; gone < x; v += kStep * change(v + 0.5 * kStep * change(v)))
      gone += kStep * v.x();
    const double energy = 0.5 * release.body.mass * v.squaredNorm();
    EXPECT_EQ(run(hill, release, {net(50.0 + x, 100.0, 1.004 * energy)}).end, End::Caught) << x;
    EXPECT_EQ(run(hill, release, {net(50.0 + x, 100.0, 0.996 * energy)}).barriers.at(0).how, Meeting::Broken) << x;
  }
}

/// Stems behind a fence are there once: the block meets those that it meets without the fences.
void expect_same_stems(const Hillside& hill, const Release& release) {
  const auto stems_of = [](const Path& path) {
    std::vector<Motion> stems;
    for (const Vertex& v : path.vertices)
      if (v.event == Event::Stem) stems.push_back(v.motion);
    return stems;
  };
  const std::vector<Motion> free = stems_of(hill.run(release)),
                            fenced = stems_of(run(hill, release, fences(22.03, 160.0, 2.9)));
  ASSERT_EQ(free.size(), fenced.size());
  EXPECT_GE(free.size(), 1U);
  for (std::size_t i = 0; i < free.size(); ++i) {
    EXPECT_LT((free[i].position - fenced[i].position).norm(), 1e-5) << i;
    EXPECT_LT((free[i].velocity - fenced[i].velocity).norm(), 1e-5) << i;
  }
}

TEST(StemBarriers, StemsOfAStandAreThoseWithoutFences) {
  Hillside hill(0.0);
  hill.effects.forest_stems = {.density = 300.0, .diameter = 0.2, .height = 60.0, .where = {}};
  hill.rules.impact_limit = 1;
  for (std::uint32_t block = 0; block < 20; ++block)
    expect_same_stems(hill, block_at({20.0, 400.0, 1040.0}, {40.0, 0.0, 0.0}, 1.0, block));
}

TEST(StemBarriers, TreesOfAListAreThoseWithoutFences) {
  Hillside hill(0.0);
  auto map = std::make_shared<ForestMap>();
  map->trees = TreeList({{{30.0, 400.2}, 0.2, 1.0}, {{43.0, 399.5}, 0.2, 1.0}, {{70.0, 400.0}, 0.2, 1.0}});
  hill.effects.forest_stems = {.density = 1.0, .height = 60.0, .where = {}, .map = std::move(map)};
  hill.rules.impact_limit = 1;
  expect_same_stems(hill, block_at({20.0, 400.0, 1040.0}, {40.0, 0.0, 0.0}, 1.0));
}

}  // namespace
}  // namespace talus
