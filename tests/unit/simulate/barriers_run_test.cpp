// Barriers in whole runs on a rough slope, with and without effects.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/paths.hpp"
#include "support/scenarios.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::for_each_path;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Scenario slope(bool effects) {
  Scenario s = test::rough_slope(4, 200);
  if (!effects) return s;
  s.effects.vegetation_drag.coefficient = 100.0;
  s.effects.air_drag.coefficient = 0.5;
  s.effects.forest_stems.density = 100.0;
  s.effects.rolling_resistance.coefficient = 0.1;
  s.effects.fragmentation.threshold = 60.0;
  s.drag_and_stems = true;
  return s;
}

/// A line from one side of the terrain to the other, 200 m x 140 m, which the blocks go down eastwards.
Barrier across(double x_south, double x_north, double height, double capacity) {
  return {"net", {{{x_south, -1.0}, {0.5 * (x_south + x_north), 70.0}, {x_north, 141.0}}}, height, capacity};
}

struct Outcomes {
  Tally tally;
  Totals totals;
};

Outcomes run(Scenario s, std::vector<Barrier> barriers, int threads = 2) {
  s.barriers = Barriers(std::move(barriers));
  Outcomes r{{s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds}, {}};
  r.totals = simulate(s, r.tally, {}, threads);
  return r;
}

BarrierCounts sum_of(const Totals& totals) {
  BarrierCounts sum;
  for (std::size_t i = 0; i < totals.barriers.size(); ++i) sum.add(totals.barriers.sum(i));
  return sum;
}

class BarrierRun : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithoutAndWithEffects, BarrierRun, testing::Bool());

TEST_P(BarrierRun, ZeroHeightChangesNoBit) {
  const Scenario s = slope(GetParam());
  const Outcomes without = run(s, {}), with = run(s, {across(60, 60, 0.0, kInfinity), across(40, 90, 0.0, 0.0)});
  test::expect_same_records(without.tally, with.tally);
  EXPECT_EQ(without.totals.ends, with.totals.ends);
  EXPECT_EQ(without.totals.length_mm, with.totals.length_mm);
  const BarrierCounts sum = sum_of(with.totals);
  EXPECT_EQ(sum.hits(), 0U);
  EXPECT_GT(sum.over, 0U);
}

/// Lines on the border of cells (x = 60), within them (61.3), and oblique: no cell wholly behind a line is crossed.
/// Without the line most blocks get there.
TEST_P(BarrierRun, NothingBehindOneThatHoldsAll) {
  const Scenario s = slope(GetParam());
  for (const auto& [south, north] : {std::pair{60.0, 60.0}, {61.3, 61.3}, {50.0, 75.0}}) {
    const Outcomes open = run(s, {across(south, north, 0.0, 0.0)}),
                   closed = run(s, {across(south, north, 1e4, kInfinity)});
    std::uint64_t before = 0;
    for (int row = 0; row < s.surface.grid().rows; ++row)
      for (int column = 0; column < s.surface.grid().columns; ++column) {
        const double line = std::max(south + (north - south) * (2.0 * row + 1.0) / 142.0,
                                     south + (north - south) * (2.0 * row + 3.0) / 142.0);
        if (2.0 * column < line) continue;
        const CellRecord* record = open.tally.find(column, row);
        before += record == nullptr ? 0 : record->passages;
        EXPECT_EQ(closed.tally.find(column, row), nullptr) << column << ' ' << row;
      }
    EXPECT_GT(before, 1000U);
    const BarrierCounts sum = sum_of(closed.totals);
    EXPECT_EQ(sum.over + sum.broken, 0U);
    EXPECT_GE(sum.caught, closed.totals.ends[static_cast<std::size_t>(End::Caught)]);  // pieces too
    if (!GetParam()) EXPECT_EQ(sum.caught, closed.totals.ends[static_cast<std::size_t>(End::Caught)]);
    std::uint64_t ends = 0;
    for (const std::uint64_t count : closed.totals.ends) ends += count;
    EXPECT_EQ(ends, closed.totals.released);
  }
}

/// A block that breaks a net loses the capacity of the net and keeps its direction.
TEST_P(BarrierRun, BrokenLosesTheCapacity) {
  Scenario s = slope(GetParam());
  s.effects.fragmentation.threshold = 0.0;  // the mass stays
  // Without drag the velocities of the path are those of the block; effects/drag_barriers_test.cpp has those with drag.
  s.effects.vegetation_drag.coefficient = s.effects.air_drag.coefficient = 0.0;
  const double capacity = 2000.0;
  s.barriers = Barriers({across(55, 65, 1e4, capacity)});
  int broken = 0;
  for_each_path(s, [&](const Release& release, const Path& path) {
    for (std::size_t i = 1; i < path.vertices.size(); ++i) {
      if (path.vertices[i].event != Event::Barrier) continue;
      const Vec3 before = motion_between(path.vertices[i - 1], path.vertices[i], 1.0).velocity;
      const Vec3 after = path.vertices[i].motion.velocity;
      const double half = 0.5 * release.body.mass;
      EXPECT_LT((after.normalized() - before.normalized()).norm(), 1e-9);
      EXPECT_NEAR(half * before.squaredNorm() - half * after.squaredNorm(), capacity, 1e-6 * capacity);
      ++broken;
    }
    for (const Vertex& vertex : path.vertices) EXPECT_TRUE(vertex.motion.velocity.allFinite());
  });
  EXPECT_GT(broken, 50);
}

TEST_P(BarrierRun, EqualForAnyNumberOfThreads) {
  const Scenario s = slope(GetParam());
  const std::vector<Barrier> nets{across(40, 60, 1.0, 5e3), across(80, 80, 2.0, kInfinity)};
  const Outcomes one = run(s, nets, 1);
  const BarrierCounts sum = sum_of(one.totals);
  EXPECT_GT(sum.over, 0U);
  EXPECT_GT(sum.caught, 0U);
  EXPECT_GT(sum.broken, 0U);
  for (const int threads : {2, 7}) {
    const Outcomes other = run(s, nets, threads);
    test::expect_same_records(one.tally, other.tally);
    ASSERT_EQ(one.totals.barriers.size(), other.totals.barriers.size());
    for (std::size_t b = 0; b < one.totals.barriers.size(); ++b)
      for (std::size_t k = 0; k < one.totals.barriers.parts(b).size(); ++k) {
        EXPECT_EQ(one.totals.barriers.parts(b)[k].over, other.totals.barriers.parts(b)[k].over);
        EXPECT_EQ(one.totals.barriers.parts(b)[k].caught, other.totals.barriers.parts(b)[k].caught);
        EXPECT_EQ(one.totals.barriers.parts(b)[k].broken, other.totals.barriers.parts(b)[k].broken);
      }
  }
}

/// The counts by place are those of the screen in the same line, which sees where blocks cross when the net has no
/// height. 142 m make 29 parts of 5 m.
TEST_P(BarrierRun, CountsByPlaceAreThoseOfAScreen) {
  Scenario s = slope(GetParam());
  const Barrier line = across(60, 60, 0.0, 0.0);
  s.screens = {{"a", line.lines}};
  s.barriers = Barriers({line});
  std::vector<std::uint64_t> places(29, 0);
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  Sinks sinks;
  sinks.crossings = [&](std::span<const Crossing> rows) {
    for (const Crossing& c : rows) ++places[static_cast<std::size_t>(c.along / 5.0)];
  };
  const Totals totals = simulate(s, tally, sinks, 2);
  ASSERT_EQ(totals.barriers.parts(0).size(), places.size());
  for (std::size_t k = 0; k < places.size(); ++k) EXPECT_EQ(totals.barriers.parts(0)[k].over, places[k]) << k;
}

TEST(BarrierRules, WrongBarriersAreRefused) {
  const auto refused = [](Barrier barrier) {
    Scenario s = slope(false);
    s.barriers = Barriers({std::move(barrier)});
    EXPECT_ANY_THROW(make_scenario(std::move(s)));
  };
  refused(across(60, 60, -1.0, 1.0));
  refused(across(60, 60, 1.0, -1.0));
  refused(across(60, 60, std::nan(""), 1.0));
  refused({"short", {{{1.0, 1.0}}}, 1.0, 1.0});
}

}  // namespace
}  // namespace talus
