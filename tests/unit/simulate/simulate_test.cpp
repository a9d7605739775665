#include "talus/simulate/simulate.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "support/paths.hpp"
#include "support/scenarios.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/plan/plan.hpp"

namespace talus {
namespace {

using test::for_each_path;

using test::kSources, test::kTrajectories, test::tally_of;

/// The slope with a block limit on some paths, two screens and recorded paths.
Scenario scenario() {
  Scenario s = test::rough_slope(kSources, kTrajectories);
  s.screens = {{"a", {{{60, 0}, {60, 140}}}}, {"b", {{{100, 0}, {110, 140}}}}};
  s.output.paths = 40;
  s.rules.impact_limit = 120;
  return s;
}

struct Collected {
  std::vector<StopRow> stops;
  std::vector<Crossing> crossings;
  std::vector<RecordedPath> paths;
  std::vector<double> progress;
};

Sinks sinks_into(Collected& all) {
  Sinks sinks;
  sinks.stops = [&](std::span<const StopRow> rows) { all.stops.insert(all.stops.end(), rows.begin(), rows.end()); };
  sinks.crossings = [&](std::span<const Crossing> rows) {
    all.crossings.insert(all.crossings.end(), rows.begin(), rows.end());
  };
  sinks.paths = [&](const RecordedPath& path) { all.paths.push_back(path); };
  sinks.progress = [&](double share) { return all.progress.push_back(share), true; };
  return sinks;
}

constexpr auto index_of(End end) {
  return static_cast<std::size_t>(end);
}

void expect_same(const Totals& a, const Totals& b) {
  EXPECT_EQ(a.ends, b.ends);
  EXPECT_EQ(a.released, b.released);
  EXPECT_EQ(a.impacts, b.impacts);
  EXPECT_EQ(a.psi_dropped, b.psi_dropped);
  EXPECT_EQ(a.cells_scored, b.cells_scored);
  EXPECT_EQ(a.length_mm, b.length_mm);
  EXPECT_EQ(a.plan_length_mm, b.plan_length_mm);
  EXPECT_EQ(a.left_blocks, b.left_blocks);
  EXPECT_EQ(a.limited_blocks, b.limited_blocks);
  EXPECT_EQ(a.first_limit, b.first_limit);
  EXPECT_EQ(a.interrupted, b.interrupted);
}

TEST(Simulate, IsTheSumOfItsPaths) {
  const Scenario s = scenario();
  Tally tally = tally_of(s), alone = tally_of(s);
  const Totals totals = simulate(s, tally, {}, 2);
  Totals expected;
  std::map<std::uint32_t, std::shared_ptr<SourceReach>> reaches;
  for_each_path(s, [&](const Release& release, const Path& path) {
    VisitBatch batch(s.surface.grid(), length_rules(s.output));
    std::shared_ptr<SourceReach>& reach = reaches[release.source];
    if (!reach) reach = std::make_shared<SourceReach>();
    batch.add(path, release.body.mass, release.source, reach);
    expected.cells_scored += alone.add(batch);
    if (path.end == End::Limit && expected.ends[index_of(End::Limit)] == 0)
      expected.first_limit = {release.source, release.block};
    expected.left_blocks += path.end == End::Left ? 1 : 0;
    expected.limited_blocks += path.end == End::Limit ? 1 : 0;
    ++expected.ends[index_of(path.end)];
    ++expected.released;
    expected.impacts += path.impacts;
    expected.psi_dropped += path.psi_dropped;
    expected.length_mm += std::llround(1e3 * path.length);
    expected.plan_length_mm += std::llround(1e3 * path.plan_length);
  });
  expect_same(totals, expected);
  test::expect_same_records(tally, alone);
  EXPECT_GT(totals.ends[index_of(End::Stopped)], 100U);  // every end that the scene can have is there
  EXPECT_GT(totals.ends[index_of(End::Left)], 10U);
  EXPECT_GT(totals.ends[index_of(End::Limit)], 10U);
}

TEST(Simulate, TotalsAndCellsAddUp) {
  const Scenario s = scenario();
  Tally tally = tally_of(s);
  const Totals totals = simulate(s, tally, {}, 2);
  std::uint64_t passages = 0, impacts = 0, deposits = 0, trapped = 0, exits = 0;
  for (int row = 0; row < tally.grid().rows; ++row)
    for (int column = 0; column < tally.grid().columns; ++column) {
      const CellRecord* cell = tally.find(column, row);
      if (cell == nullptr) continue;
      passages += cell->passages;
      impacts += cell->impacts;
      deposits += cell->deposits;
      trapped += cell->trapped;
      exits += cell->exits;
      EXPECT_GE(cell->sources, 1U);
      EXPECT_LE(cell->sources, kSources);
      for (const LogHistogram& histogram : cell->histogram) EXPECT_EQ(histogram.count(), cell->passages);
    }
  EXPECT_EQ(totals.released, std::uint64_t{kSources} * kTrajectories);
  EXPECT_EQ(std::accumulate(totals.ends.begin(), totals.ends.end(), std::uint64_t{0}), totals.released);
  EXPECT_EQ(deposits, totals.ends[index_of(End::Stopped)] + totals.ends[index_of(End::Trapped)] +
                          totals.ends[index_of(End::Caught)]);
  EXPECT_EQ(trapped, totals.ends[index_of(End::Trapped)]);
  EXPECT_EQ(exits, totals.ends[index_of(End::Left)]);
  EXPECT_EQ(impacts, totals.impacts);
  EXPECT_EQ(passages, totals.cells_scored);
  EXPECT_FALSE(totals.interrupted);
  EXPECT_GE(totals.length_mm, totals.plan_length_mm);
}

TEST(Simulate, EqualBitsForAnyNumberOfThreadsAndLanes) {
  const Scenario s = scenario();
  Tally one = tally_of(s);
  Collected first;
  const Totals totals = simulate(s, one, sinks_into(first), 1, 1);
  for (const auto& [threads, lanes] : {std::pair{2, 1}, {1, 4}, {7, 4}, {1, 8}, {7, 8}, {0, 0}}) {
    if (lanes > most_lanes()) continue;
    Tally tally = tally_of(s);
    Collected all;
    expect_same(simulate(s, tally, sinks_into(all), threads, lanes), totals);
    test::expect_same_records(tally, one);
    ASSERT_EQ(all.stops.size(), first.stops.size());
    for (std::size_t i = 0; i < all.stops.size(); ++i) {
      ASSERT_EQ(all.stops[i].x, first.stops[i].x) << i;
      ASSERT_EQ(all.stops[i].block, first.stops[i].block) << i;
    }
    ASSERT_EQ(all.crossings.size(), first.crossings.size());
    for (std::size_t i = 0; i < all.crossings.size(); ++i)
      ASSERT_EQ(all.crossings[i].speed, first.crossings[i].speed) << i;
    ASSERT_EQ(all.paths.size(), first.paths.size());
  }
}

TEST(Simulate, RowsInOrderAndComplete) {
  const Scenario s = scenario();
  Tally tally = tally_of(s);
  Collected all;
  simulate(s, tally, sinks_into(all), 7);
  std::size_t row = 0, path_row = 0, crossing_row = 0;
  const ScreenFinder finder(s);
  for_each_path(s, [&](const Release& release, const Path& path) {
    ASSERT_LT(row, all.stops.size());
    const StopRow& stop = all.stops[row++];
    ASSERT_EQ(stop.source, release.source);
    ASSERT_EQ(stop.block, release.block);
    ASSERT_EQ(stop.end, path.end);
    ASSERT_EQ(stop.impacts, path.impacts);
    ASSERT_EQ(stop.mass, static_cast<float>(release.body.mass));
    ASSERT_EQ(stop.x, path.vertices.back().motion.position.x());
    ASSERT_EQ(stop.z, path.vertices.back().motion.position.z());
    ASSERT_EQ(stop.length, static_cast<float>(path.length));
    std::vector<Crossing> crossings;
    finder.find(release, path, crossings);
    for (const Crossing& crossing : crossings) {
      ASSERT_EQ(all.crossings.at(crossing_row).time, crossing.time);
      ASSERT_EQ(all.crossings.at(crossing_row++).block, release.block);
    }
    if (!is_recorded(s, release.source, release.block)) return;
    ASSERT_EQ(all.paths.at(path_row).stop.source, release.source);
    ASSERT_EQ(all.paths.at(path_row++).stop.block, release.block);
  });
  EXPECT_EQ(row, all.stops.size());
  EXPECT_EQ(crossing_row, all.crossings.size());
  EXPECT_GT(crossing_row, 500U);
  EXPECT_EQ(path_row, 40U);
  EXPECT_EQ(all.paths.size(), 40U);
}

TEST(Simulate, MaxSpeedOfARowIsThatOfItsPath) {  // the vertices hold the speed after an impact, the flights end faster
  const Scenario s = scenario();
  Tally tally = tally_of(s);
  Collected all;
  simulate(s, tally, sinks_into(all), 1);
  std::size_t row = 0;
  for_each_path(s, [&](const Release&, const Path& path) {
    double fastest = 0.0;
    for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
      const Motion &m = path.vertices[i].motion, &to = path.vertices[i + 1].motion;
      Vec3 end = m.velocity;
      if (path.vertices[i].event == Event::Slide && to.time > m.time)
        end = 2.0 * (to.position - m.position) / (to.time - m.time) - m.velocity;
      else if (path.vertices[i].event != Event::Slide)
        end.z() -= kGravity * (to.time - m.time);
      fastest = std::max({fastest, m.velocity.norm(), end.norm()});
    }
    ASSERT_NEAR(all.stops[row++].max_speed, fastest, 0.02 * fastest) << row;  // pieces of slides are not straight
  });
}

TEST(Simulate, ASinkThatThrowsEndsTheRun) {
  const Scenario s = scenario();
  for (const int threads : {1, 7})
    for (int which = 0; which < 4; ++which) {
      int calls = 0, after = 0;
      bool thrown = false;
      const auto call = [&] {
        after += thrown ? 1 : 0;
        if (++calls < 3) return;
        thrown = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the other threads queue behind it
        throw std::runtime_error("disk full");
      };
      Sinks sinks;
      if (which == 0) sinks.stops = [&](std::span<const StopRow>) { call(); };
      if (which == 1) sinks.crossings = [&](std::span<const Crossing>) { call(); };
      if (which == 2) sinks.paths = [&](const RecordedPath&) { call(); };
      if (which == 3) sinks.progress = [&](double) { return call(), true; };
      Tally tally = tally_of(s);
      try {
        simulate(s, tally, sinks, threads);
        ADD_FAILURE() << "nothing thrown, sink " << which;
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "disk full");
      }
      EXPECT_EQ(calls, 3) << "sink " << which << ", " << threads << " threads";
      EXPECT_EQ(after, 0) << "sink " << which << ", " << threads << " threads";
    }
}

TEST(Simulate, ProgressRisesToOne) {
  for (const int threads : {1, 7}) {
    const Scenario s = scenario();
    Tally tally = tally_of(s);
    Collected all;
    simulate(s, tally, sinks_into(all), threads);
    for (std::size_t i = 1; i < all.progress.size(); ++i) ASSERT_GT(all.progress[i], all.progress[i - 1]);
    ASSERT_FALSE(all.progress.empty());
    EXPECT_GT(all.progress.front(), 0.0);
    EXPECT_EQ(all.progress.back(), 1.0);
  }
}

TEST(Simulate, ProgressReturningFalseInterrupts) {
  const Scenario s = scenario();
  for (const int threads : {1, 3}) {
    Tally tally = tally_of(s);
    Collected all;
    Sinks sinks = sinks_into(all);
    sinks.progress = [&](double share) { return all.progress.push_back(share), share < 0.3; };
    const Totals totals = simulate(s, tally, sinks, threads);
    EXPECT_TRUE(totals.interrupted);
    EXPECT_LT(totals.released, s.released());
    ASSERT_EQ(all.stops.size(), totals.released);  // all finished rows, from the first release on
    for (std::size_t i = 0; i < all.stops.size(); ++i)
      ASSERT_EQ(all.stops[i].source * kTrajectories + all.stops[i].block, i);
    std::uint64_t passages = 0;
    for (int cell = 0; cell < 7000; ++cell)
      if (const CellRecord* record = tally.find(cell % 100, cell / 100)) passages += record->passages;
    EXPECT_EQ(passages, totals.cells_scored);
  }
}

TEST(Simulate, FalseAtTheLastUnitIsNoInterruption) {
  const Scenario s = scenario();
  Tally tally = tally_of(s);
  Sinks sinks;
  sinks.progress = [](double share) { return share < 1.0; };
  EXPECT_FALSE(simulate(s, tally, sinks, 2).interrupted);
}

TEST(Simulate, BlocksThatAreReleasedOffTheTerrainLeave) {
  Scenario s = scenario();
  s.sources.assign(1, {0, 0.5, 70.0, true});
  Tally tally = tally_of(s);
  const Totals totals = simulate(s, tally, {}, 2);
  EXPECT_EQ(totals.ends[index_of(End::Left)], kTrajectories);
  EXPECT_EQ(totals.cells_scored, 0U);
  EXPECT_EQ(tally.touched_cells(), 0U);
}

}  // namespace
}  // namespace talus
