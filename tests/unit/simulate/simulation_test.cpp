#include "talus/simulate/simulation.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "support/percentile.hpp"
#include "support/scenarios.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::kSources, test::kTrajectories, test::tally_of;

Scenario bare_slope() {
  return test::rough_slope(kSources, kTrajectories);
}

std::vector<std::string> bytes_of(const Tally& tally) {
  std::vector<std::string> regions;
  for (std::size_t i = 0; i < tally.regions(); ++i) {
    ByteWriter out;
    tally.save(i, out);
    regions.push_back(out.bytes());
  }
  return regions;
}

/// The counts and percentiles of every cell, from which maps are made.
std::vector<double> cells_of(const Tally& tally) {
  std::vector<double> values;
  for (int row = 0; row < tally.grid().rows; ++row)
    for (int column = 0; column < tally.grid().columns; ++column) {
      const CellRecord* cell = tally.find(column, row);
      if (cell == nullptr) continue;
      for (const double count :
           {double(cell->passages), double(cell->impacts), double(cell->deposits), double(cell->sources)})
        values.push_back(count);
      for (std::size_t q = 0; q < kQuantities; ++q) {
        values.push_back(cell->maximum[q]);
        values.push_back(static_cast<double>(cell->sum[q]));
        values.push_back(test::percentile(cell->histogram[q], 0.95));
      }
      for (std::size_t i = 0; i < 5; ++i) values.push_back(tally.exceedances(column, row)[i]);
    }
  return values;
}

/// The state that is saved on disk between two programs.
struct Kept {
  Simulation::Position position;
  Totals totals;
  std::vector<std::string> reaches;  // by source cell
  std::vector<std::string> regions;
};

Kept kept_of(const Simulation& simulation, const Tally& tally) {
  std::vector<std::string> reaches;
  simulation.save_reaches([&](std::string_view piece) { reaches.emplace_back(piece); });
  return {simulation.position(), simulation.totals(), reaches, bytes_of(tally)};
}

void restore(const Kept& kept, Simulation& simulation, Tally& tally) {
  for (std::size_t i = 0; i < kept.regions.size(); ++i) {
    ByteReader in(kept.regions[i]);
    tally.merge(i, in);
  }
  simulation.restore(kept.position, kept.totals);
  for (const std::string& piece : kept.reaches) {
    ByteReader in(piece);
    simulation.restore_reach(in);
  }
}

TEST(Simulation, StoppedAndRestoredAfterEveryUnitItEndsAsOneRun) {
  const Scenario s = bare_slope();
  ASSERT_EQ(s.output.energy_thresholds.size() + s.output.height_thresholds.size(), 5U);
  Tally whole = tally_of(s);
  const Totals expected = simulate(s, whole, {}, 2);
  for (const auto& [threads, lanes] : {std::pair{1, 1}, {3, 1}, {1, 0}, {3, 0}}) {
    std::vector<std::uint64_t> released;
    Sinks sinks;
    sinks.stops = [&](std::span<const StopRow> rows) {
      for (const StopRow& row : rows) released.push_back(row.source * kTrajectories + row.block);
    };
    sinks.pause = [] { return true; };
    Kept kept;
    int sessions = 0;
    for (bool done = false; !done; ++sessions) {
      Tally tally = tally_of(s);
      Simulation simulation(s, {}, false, tally, sinks);
      if (sessions > 0) restore(kept, simulation, tally);
      simulation.advance(threads, lanes);
      kept = kept_of(simulation, tally);
      done = simulation.round_done();
      if (done) EXPECT_EQ(cells_of(tally), cells_of(whole));
    }
    EXPECT_GE(sessions,
              lanes == 1 ? 15 / threads : 2);  // units of work; in lanes blocks of later ones are on their way
    EXPECT_EQ(kept.totals.ends, expected.ends);
    EXPECT_EQ(kept.totals.length_mm, expected.length_mm);
    ASSERT_EQ(released.size(), s.released());  // every block once, in order
    for (std::size_t i = 0; i < released.size(); ++i) ASSERT_EQ(released[i], i);
  }
}

TEST(Simulation, RoundsOfFewAreOneOfMany) {
  const Scenario all = bare_slope();
  Scenario third = all;
  third.trajectories = kTrajectories / 3;
  Tally whole = tally_of(all), tally = tally_of(all);
  simulate(all, whole, {}, 2);
  const Sinks none;
  Simulation simulation(third, {}, true, tally, none);
  for (int round = 0; round < 3; ++round) {
    if (round > 0) simulation.next_round();
    simulation.advance(2);
    ASSERT_TRUE(simulation.round_done());
  }
  EXPECT_EQ(simulation.totals().released, all.released());
  EXPECT_EQ(cells_of(tally), cells_of(whole));  // a source cell counts once in a cell
}

TEST(Simulation, SeveralAtATimeDoNotDisturbEachOther) {
  const Scenario s = bare_slope();
  Tally expected = tally_of(s);
  simulate(s, expected, {}, 1);
  std::vector<Tally> tallies;
  for (int i = 0; i < 4; ++i) tallies.push_back(tally_of(s));
  std::vector<std::thread> threads;
  for (Tally& tally : tallies) threads.emplace_back([&s, &tally] { simulate(s, tally, {}, 1); });
  for (std::thread& thread : threads) thread.join();
  for (const Tally& tally : tallies) EXPECT_EQ(cells_of(tally), cells_of(expected));
}

TEST(Simulation, PartsHoldEverySourceOnce) {
  for (std::uint32_t of = 1; of <= 7; ++of) {
    std::uint32_t next = 0;
    for (std::uint32_t number = 1; number <= of; ++number) {
      const Part part{number, of};
      EXPECT_EQ(part.first(kSources), next);
      next = part.end(kSources);
    }
    EXPECT_EQ(next, kSources);
  }
}

TEST(Simulation, DamagedBytesAreNoTally) {
  const Scenario s = bare_slope();
  Tally tally = tally_of(s);
  simulate(s, tally, {}, 1);
  const std::vector<std::string> regions = bytes_of(tally);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i].empty()) continue;
    for (const std::size_t length : {std::size_t{1}, regions[i].size() / 2 + 1, regions[i].size() - 1}) {
      Tally other = tally_of(s);
      const std::string cut = regions[i].substr(0, length);
      ByteReader in(cut);
      EXPECT_THROW(other.merge(i, in), std::out_of_range) << i << ' ' << length;
    }
  }
}

TEST(Simulation, InAScratchFileItCountsTheSame) {
  const Scenario s = bare_slope();
  Tally expected = tally_of(s);
  simulate(s, expected, {}, 2);
  ScratchFile file(std::filesystem::temp_directory_path().string(), 1);  // every process is above this limit
  {
    Tally tally = tally_of(s, MemoryPolicy(&file));
    const Sinks none;
    Simulation simulation(s, {}, true, tally, none);
    simulation.advance(2);
    EXPECT_EQ(cells_of(tally), cells_of(expected));
    const std::vector<std::string> saved = bytes_of(tally);
    for (std::size_t i = 0; i < tally.regions(); ++i) {
      ByteWriter taken;
      tally.take(i, taken);
      EXPECT_EQ(taken.bytes(), saved[i]);
    }
    EXPECT_EQ(tally.touched_cells(), 0U);
  }
  EXPECT_GT(expected.touched_cells(), 0U);
}

}  // namespace
}  // namespace talus
