#include <gtest/gtest.h>

#include <map>

#include "support/scenarios.hpp"
#include "talus/simulate/plan/plan.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::path_of;
using test::stay;

TEST(Pieces, CountAsOneTrajectoryWithTheLargestValues) {
  const Grid grid = test::grid_of(10, 10, 2.0, 2.0);
  VisitBatch batch(grid);
  Path whole = path_of({stay(3, 3, 100.0F, 1.0F, 1), stay(3, 3, 400.0F, 0.5F), stay(4, 3, 400.0F, 0.5F)}, End::Stopped);
  whole.breaks = {{1, 1, Block{.diameter = 1.0, .mass = 300.0}}};  // 1000 kg until the first impact, then 300 kg
  batch.add(whole, 1000.0, 7, nullptr);
  batch.add(path_of({stay(4, 3, 900.0F, 2.0F), stay(5, 3, 1.0F, 0.0F)}, End::Stopped), 200.0, 7, nullptr, true);
  batch.add(path_of({stay(4, 3, 1.0F, 0.0F)}, End::Stopped), 500.0, 7, nullptr, true);
  batch.add(path_of({stay(4, 3, 100.0F, 0.0F)}, End::Left), 1000.0, 7, nullptr);  // another block
  Tally tally(grid, {30.0}, {1.5});
  EXPECT_EQ(tally.add(batch), 4U);

  const CellRecord* first = tally.find(3, 3);
  EXPECT_EQ(first->passages, 1U);
  EXPECT_EQ(first->impacts, 1U);
  EXPECT_EQ(first->maximum[0], 60.0F);  // 300 kg at 20 m/s, more than 1000 kg at 10 m/s
  EXPECT_EQ(first->maximum[1], 20.0F);
  EXPECT_EQ(first->maximum[2], 1.0F);
  const CellRecord* second = tally.find(4, 3);
  EXPECT_EQ(second->passages, 2U);
  EXPECT_EQ(second->deposits, 1U);  // two of its pieces lie here
  EXPECT_EQ(second->trapped, 0U);
  EXPECT_EQ(second->exits, 1U);
  EXPECT_EQ(second->sources, 1U);
  EXPECT_EQ(second->maximum[0], 90.0F);
  EXPECT_EQ(second->mean(Quantity::Energy), (90.0 + 50.0) / 2.0);
  EXPECT_EQ(tally.exceedances(4, 3)[0], 2U);
  EXPECT_EQ(tally.exceedances(4, 3)[1], 1U);
  EXPECT_EQ(tally.find(5, 3)->deposits, 1U);
}

Scenario breaking() {
  Scenario s = test::rough_slope(4, 150);
  s.effects.fragmentation = {.threshold = 60.0, .largest = 0.6, .where = {}};
  return make_scenario(std::move(s));
}

TEST(Pieces, AreTheSameForAnyNumberOfThreadsAndAllScored) {
  const Scenario s = breaking();
  const auto run = [&](int threads, Totals& totals, double& mass) {
    Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
    Sinks sinks;
    sinks.stops = [&mass](std::span<const StopRow> rows) {
      for (const StopRow& row : rows) mass += row.mass;
    };
    totals = simulate(s, tally, sinks, threads);
    return tally;
  };
  Totals one, three;
  double mass = 0.0, again = 0.0;
  const Tally first = run(1, one, mass), second = run(3, three, again);
  test::expect_same_records(first, second);
  EXPECT_EQ(one.impacts, three.impacts);
  EXPECT_EQ(one.pieces, three.pieces);
  EXPECT_EQ(mass, again);
  EXPECT_GT(one.pieces, 100U);
  std::uint64_t impacts = 0, most = 0;
  for (int row = 0; row < s.surface.grid().rows; ++row)
    for (int column = 0; column < s.surface.grid().columns; ++column)
      if (const CellRecord* record = first.find(column, row)) {
        impacts += record->impacts;
        most = std::max<std::uint64_t>({most, record->passages, record->deposits});
      }
  EXPECT_EQ(impacts, one.impacts);  // the impacts of the pieces, too
  EXPECT_LE(most, s.released());    // no trajectory counts twice in a cell

  double released = 0.0;
  for (std::uint32_t source = 0; source < 4; ++source)
    for (std::uint32_t block = 0; block < 150; ++block) released += make_release(s, source, block).body.mass;
  EXPECT_LT(mass, 0.9 * released);  // stops hold the largest pieces
  EXPECT_GT(mass, 0.2 * released);
}

/// Blocks that end so, and those of which any piece does: each is traced alone, with its pieces.
struct Counted {
  std::uint64_t with_largest = 0, with_any = 0;
  std::array<std::uint32_t, 2> first{};  ///< (source, block) of the first of `with_any`
};
Counted counted(const Scenario& s, End end) {
  Counted out;
  for (std::uint32_t source = 0; source < 4; ++source)
    for (std::uint32_t block = 0; block < 150; ++block) {
      Path whole;
      trace(s.world(), make_release(s, source, block), whole);
      bool any = whole.end == end;
      out.with_largest += any ? 1U : 0U;
      trace_pieces(s.world(), whole, [&](const Release&, const Path& piece) { any = any || piece.end == end; });
      if (any && out.with_any == 0) out.first = {source, block};
      out.with_any += any ? 1U : 0U;
    }
  return out;
}

TEST(Pieces, ABlockOfWhichAPieceLeavesHasLeft) {
  Scenario s = test::rough_slope(4, 150);
  s.effects.fragmentation = {.threshold = 60.0, .largest = 0.6, .where = {}};
  s.features[0].frequency = 0.6;
  s = make_scenario(std::move(s));
  const Counted left = counted(s, End::Left);
  ASSERT_GT(left.with_any, left.with_largest);
  for (const int threads : {1, 3}) {
    Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
    auto weights = AnnualWeights::of(s);
    ASSERT_TRUE(weights);
    const double unit = weights->scale().unit;
    tally.keep_hazard(std::move(*weights));
    const Totals totals = simulate(s, tally, {}, threads);
    EXPECT_EQ(totals.ends[static_cast<std::size_t>(End::Left)], left.with_largest);
    EXPECT_EQ(totals.left_blocks, left.with_any);
    EXPECT_NEAR(static_cast<double>(totals.left_weight) * unit, 0.6 * static_cast<double>(left.with_any) / 600.0, 1e-9);
  }
}

/// A limit that only a smaller piece reaches was counted nowhere.
TEST(Pieces, ABlockOfWhichAPieceReachesALimitIsCounted) {
  Scenario s = test::rough_slope(4, 150);
  s.effects.fragmentation = {.threshold = 60.0, .largest = 0.6, .where = {}};
  s = make_scenario(std::move(s));
  std::vector<double> times;
  for (std::uint32_t block = 0; block < 150; ++block) {
    Path whole;
    trace(s.world(), make_release(s, 0, block), whole);
    times.push_back(whole.vertices.back().motion.time);
  }
  std::ranges::sort(times);
  s.rules.time_limit = times[120];  // most of the largest pieces end before it
  const auto [with_largest, limited, first] = counted(s, End::Limit);
  ASSERT_GT(limited, with_largest);
  for (const int threads : {1, 3}) {
    Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
    const Totals totals = simulate(s, tally, {}, threads);
    EXPECT_EQ(totals.ended(End::Limit), with_largest);
    EXPECT_EQ(totals.limited_blocks, limited);
    EXPECT_EQ(totals.first_limit, first);
  }
}

TEST(Pieces, CrossScreensWithTheirOwnMass) {
  Scenario s = breaking();
  s.screens = {{"below", {{{150.0, 1.0}, {150.0, 139.0}}}}};
  s = make_scenario(std::move(s));
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> mass;
  Sinks sinks;
  sinks.crossings = [&mass](std::span<const Crossing> rows) {
    for (const Crossing& row : rows) mass[{row.source, row.block}] += row.mass;
  };
  simulate(s, tally, sinks, 2);
  int smaller = 0;
  for (const auto& [key, sum] : mass) {
    const double whole = make_release(s, key.first, key.second).body.mass;
    if (sum < 0.99 * whole) ++smaller;
    EXPECT_LE(sum, 1.5 * whole);  // a piece may roll back and cross again, the whole may not come several times
  }
  EXPECT_GT(smaller, 10);
}

}  // namespace
}  // namespace talus
