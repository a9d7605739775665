#include "talus/simulate/tally/tally.hpp"

#include <gtest/gtest.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <thread>

#include "support/percentile.hpp"
#include "support/scenarios.hpp"

namespace talus {
namespace {

using test::Numbers;
using test::path_of;
using test::stay;

const std::vector<double> kEnergies{1.0, 30.0, 300.0};  // [kJ]
const std::vector<double> kHeights{0.5, 2.0};           // [m]

struct Sample {  // one trajectory
  Path path;
  double mass;
  std::uint32_t source;
};

/// The expected values of one cell, by brute force: one value for each trajectory.
struct Expected {
  std::uint64_t impacts = 0, deposits = 0, trapped = 0, exits = 0;
  std::set<std::uint32_t> sources;
  std::vector<float> energies, speeds, heights;
};
using Cells = std::map<std::pair<int, int>, Expected>;

/// Random walks over neighbouring cells, often coming back, across the regions of a grid of 130 x 100 cells.
std::vector<Sample> random_walks(std::size_t count, std::uint32_t per_source, std::uint64_t seed) {
  Numbers numbers(seed);
  std::vector<Sample> samples;
  for (std::uint32_t i = 0; i < count; ++i) {
    Path path;
    int column = 55 + static_cast<int>(numbers.bits() % 20), row = 55 + static_cast<int>(numbers.bits() % 20);
    for (int step = 0; step < 30; ++step) {
      path.spans.push_back(stay(column, row, static_cast<float>(numbers.uniform(0, 900)),
                                static_cast<float>(std::max(0.0, numbers.uniform(-1, 4))),
                                numbers.bits() % 3 == 0 ? 1U : 0U));
      column = std::clamp(column + static_cast<int>(numbers.bits() % 3) - 1, 0, 129);
      row = std::clamp(row + static_cast<int>(numbers.bits() % 3) - 1, 0, 99);
    }
    path.end = static_cast<End>(numbers.bits() % kEnds);
    samples.push_back({path, numbers.uniform(100, 3000), i / per_source});
  }
  return samples;
}

Cells brute_force(const std::vector<Sample>& samples) {
  Cells cells;
  for (const Sample& sample : samples) {
    std::map<std::pair<int, int>, std::pair<float, float>> largest;  // of this trajectory: speed^2, height
    for (const Span& span : sample.path.spans) {
      const std::pair at{span.patch.column, span.patch.row};
      auto& [speed_squared, height] = largest[at];
      speed_squared = std::max(speed_squared, span.plan_speed_squared);
      height = std::max(height, span.height_from);
      cells[at].impacts += span.impacts;
    }
    for (const auto& [at, values] : largest) {
      Expected& cell = cells[at];
      cell.sources.insert(sample.source);
      cell.energies.push_back(static_cast<float>(0.5e-3 * sample.mass * values.first));
      cell.speeds.push_back(std::sqrt(values.first));
      cell.heights.push_back(values.second);
    }
    const Span& last = sample.path.spans.back();
    Expected& at_end = cells[{last.patch.column, last.patch.row}];
    const End end = sample.path.end;
    at_end.deposits += end == End::Stopped || end == End::Trapped || end == End::Caught ? 1U : 0U;
    at_end.trapped += end == End::Trapped ? 1U : 0U;
    at_end.exits += end == End::Left ? 1U : 0U;
  }
  return cells;
}

void expect_values(const CellRecord& record, Quantity quantity, const std::vector<float>& values) {
  const std::size_t q = index_of(quantity);
  const double unit = quantity == Quantity::Energy ? 0x1p-10 : 0x1p-16;  // docs/products.md, "Percentiles"
  LogHistogram histogram;
  histogram.add(values);
  double sum = 0.0;
  for (const float value : values) sum += value;
  EXPECT_EQ(record.maximum[q], *std::max_element(values.begin(), values.end()));
  const double n = static_cast<double>(values.size());
  EXPECT_NEAR(static_cast<double>(record.sum[q]) * unit, sum, n * unit * 0.5001);  // rounded each
  EXPECT_NEAR(record.mean(quantity), sum / n, unit * 0.5001);
  EXPECT_EQ(record.histogram[q].count(), values.size());
  for (const double share : {0.0, 0.5, 0.95, 1.0})
    EXPECT_EQ(test::percentile(record.histogram[q], share), test::percentile(histogram, share));
}

std::uint32_t above(const std::vector<float>& values, double threshold) {
  return static_cast<std::uint32_t>(
      std::count_if(values.begin(), values.end(), [&](float v) { return v > threshold; }));
}

void expect_equals(const Tally& tally, const Cells& cells) {
  EXPECT_EQ(tally.touched_cells(), cells.size());
  for (int row = 0; row < tally.grid().rows; ++row)
    for (int column = 0; column < tally.grid().columns; ++column) {
      const CellRecord* record = tally.find(column, row);
      const auto it = cells.find({column, row});
      ASSERT_EQ(record != nullptr, it != cells.end()) << column << ' ' << row;
      if (record == nullptr) continue;
      const Expected& cell = it->second;
      ASSERT_EQ(record->passages, cell.energies.size()) << column << ' ' << row;
      ASSERT_EQ(record->impacts, cell.impacts) << column << ' ' << row;
      ASSERT_EQ(record->deposits, cell.deposits) << column << ' ' << row;
      ASSERT_EQ(record->trapped, cell.trapped) << column << ' ' << row;
      ASSERT_EQ(record->exits, cell.exits) << column << ' ' << row;
      ASSERT_EQ(record->sources, cell.sources.size()) << column << ' ' << row;
      expect_values(*record, Quantity::Energy, cell.energies);
      expect_values(*record, Quantity::Speed, cell.speeds);
      expect_values(*record, Quantity::Height, cell.heights);
      const std::uint32_t* over = tally.exceedances(column, row);
      for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(over[i], above(cell.energies, kEnergies[i]));
      for (std::size_t i = 0; i < 2; ++i) ASSERT_EQ(over[3 + i], above(cell.heights, kHeights[i]));
    }
}

Tally new_tally() {
  return {test::grid_of(130, 100, 2.0, 2.0), kEnergies, kHeights};
}

/// The samples in batches of `per_batch`; sources that several batches share get a reach of their own.
std::vector<VisitBatch> batches_of(const std::vector<Sample>& samples, std::size_t per_batch) {
  std::map<std::uint32_t, std::shared_ptr<SourceReach>> reaches;
  std::vector<VisitBatch> batches;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % per_batch == 0) batches.emplace_back(test::grid_of(130, 100, 2.0, 2.0));
    std::shared_ptr<SourceReach>& reach = reaches[samples[i].source];
    if (!reach) reach = std::make_shared<SourceReach>();
    batches.back().add(samples[i].path, samples[i].mass, samples[i].source, reach);
  }
  return batches;
}

TEST(Tally, OneBatchAgainstBruteForce) {
  const auto samples = random_walks(600, 40, 1);
  VisitBatch batch(test::grid_of(130, 100, 2.0, 2.0));
  for (const Sample& s : samples) batch.add(s.path, s.mass, s.source, nullptr);
  Tally tally = new_tally();
  const Cells cells = brute_force(samples);
  std::size_t pairs = 0;
  for (const auto& [at, cell] : cells) pairs += cell.energies.size();
  EXPECT_EQ(tally.add(batch), pairs);
  expect_equals(tally, cells);
}

TEST(Tally, SourcesSharedByBatchesCountOnce) {
  const auto samples = random_walks(600, 40, 2);
  for (const std::size_t per_batch : {1U, 7U, 100U}) {
    Tally tally = new_tally();
    for (const VisitBatch& batch : batches_of(samples, per_batch)) tally.add(batch);
    expect_equals(tally, brute_force(samples));
  }
}

TEST(Tally, TheOrderOfBatchesChangesNothing) {
  const auto samples = random_walks(500, 40, 3);
  Tally first = new_tally();
  for (const VisitBatch& batch : batches_of(samples, 30)) first.add(batch);
  Numbers numbers(4);
  for (int trial = 0; trial < 4; ++trial) {
    auto batches = batches_of(samples, 10 + 20 * static_cast<std::size_t>(trial));
    for (std::size_t i = batches.size(); i > 1; --i) std::swap(batches[i - 1], batches[numbers.bits() % i]);
    Tally tally = new_tally();
    for (const VisitBatch& batch : batches) tally.add(batch);
    test::expect_same_records(tally, first);
  }
}

TEST(Tally, ThreadsGiveTheSameRecords) {
  const auto samples = random_walks(2000, 40, 5);
  Tally alone = new_tally(), shared = new_tally();
  for (const VisitBatch& batch : batches_of(samples, 25)) alone.add(batch);
  const auto batches = batches_of(samples, 25);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 5; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < batches.size(); i += 5) shared.add(batches[i]);
    });
  for (std::thread& thread : threads) thread.join();
  test::expect_same_records(shared, alone);
}

TEST(Tally, ARevisitIsOneValue) {  // by hand: 1000 kg; 20 m/s = 200 kJ is its largest, and height 3 of another visit
  VisitBatch batch(test::grid_of(130, 100, 2.0, 2.0));
  batch.add(path_of({stay(3, 4, 400, 1, 1), stay(4, 4, 100, 2), stay(3, 4, 25, 3, 1)}, End::Stopped), 1000.0, 0,
            nullptr);
  Tally tally = new_tally();
  EXPECT_EQ(tally.add(batch), 2U);
  const CellRecord& cell = *tally.find(3, 4);
  EXPECT_EQ(cell.passages, 1U);
  EXPECT_EQ(cell.impacts, 2U);
  EXPECT_EQ(cell.deposits, 1U);
  EXPECT_EQ(cell.sources, 1U);
  EXPECT_EQ(cell.mean(Quantity::Energy), 200.0);
  EXPECT_EQ(cell.mean(Quantity::Speed), 20.0);
  EXPECT_EQ(cell.mean(Quantity::Height), 3.0);
  EXPECT_EQ(tally.exceedances(3, 4)[1], 1U);  // > 30 kJ
  EXPECT_EQ(tally.exceedances(3, 4)[2], 0U);  // not > 300 kJ
  EXPECT_EQ(tally.find(4, 4)->deposits, 0U);
  EXPECT_EQ(tally.find(5, 4), nullptr);
}

TEST(Tally, TheLastCellCountsHowAPathEnds) {
  VisitBatch batch(test::grid_of(130, 100, 2.0, 2.0));
  for (const End end : {End::Stopped, End::Trapped, End::Trapped, End::Left, End::Left, End::Left, End::Limit})
    batch.add(path_of({stay(4, 4, 1, 1), stay(3, 4, 1, 1)}, end), 1000.0, 0, nullptr);
  Tally tally = new_tally();
  tally.add(batch);
  const CellRecord &last = *tally.find(3, 4), &before = *tally.find(4, 4);
  EXPECT_EQ(last.deposits, 3U);
  EXPECT_EQ(last.trapped, 2U);
  EXPECT_EQ(last.exits, 3U);
  EXPECT_EQ(before.deposits + before.trapped + before.exits, 0U);
  ByteWriter saved;
  last.save(saved);
  ByteReader in(saved.bytes());
  CellRecord twice = CellRecord::restored(in);
  twice.merge(last);
  EXPECT_EQ(twice.deposits, 6U);
  EXPECT_EQ(twice.trapped, 4U);
  EXPECT_EQ(twice.exits, 6U);
}

TEST(Tally, AThresholdItselfIsNotExceeded) {
  VisitBatch batch(test::grid_of(130, 100, 2.0, 2.0));
  batch.add(path_of({stay(3, 4, 600, 2.0F)}, End::Left), 1000.0, 0, nullptr);  // 300 kJ, 2 m
  batch.add(path_of({stay(3, 4, 601, std::nextafter(2.0F, 3.0F))}, End::Left), 1000.0, 0, nullptr);
  Tally tally = new_tally();
  tally.add(batch);
  EXPECT_EQ(tally.exceedances(3, 4)[2], 1U);
  EXPECT_EQ(tally.exceedances(3, 4)[4], 1U);
}

TEST(Tally, CornersOfTheGridAndOfRegions) {
  Tally tally = new_tally();
  VisitBatch batch(tally.grid());
  const std::pair<int, int> corners[] = {{0, 0},   {63, 63},  {64, 63},  {63, 64},
                                         {64, 64}, {127, 99}, {128, 64}, {129, 99}};
  for (const auto& [column, row] : corners)
    batch.add(path_of({stay(column, row, 1, 1)}, End::Stopped), 1.0, 0, nullptr);
  tally.add(batch);
  EXPECT_EQ(tally.touched_cells(), std::size(corners));
  for (const auto& [column, row] : corners) {
    ASSERT_NE(tally.find(column, row), nullptr) << column << ' ' << row;
    EXPECT_EQ(tally.find(column, row)->passages, 1U);
  }
}

TEST(Tally, EmptyHasNoRecordAndItMoves) {
  Tally tally = new_tally();
  tally.add(VisitBatch(tally.grid()));
  EXPECT_EQ(tally.touched_cells(), 0U);
  EXPECT_EQ(tally.find(0, 0), nullptr);
  VisitBatch batch(tally.grid());
  batch.add(path_of({stay(3, 4, 1, 1)}, End::Stopped), 1.0, 0, nullptr);
  tally.add(batch);
  const Tally moved(std::move(tally));
  EXPECT_EQ(moved.find(3, 4)->passages, 1U);
}

TEST(Tally, WithoutThresholds) {
  Tally tally(test::grid_of(130, 100, 2.0, 2.0), {}, {});
  VisitBatch batch(tally.grid());
  batch.add(path_of({stay(3, 4, 1, 1), stay(4, 4, 1, 1)}, End::Stopped), 1.0, 0, nullptr);
  EXPECT_EQ(tally.add(batch), 2U);
}

TEST(Tally, MemoryOfATouchedCell) {
  EXPECT_LE(sizeof(LogHistogram), 32U);
  EXPECT_LE(sizeof(CellRecord), 176U);
  EXPECT_LE(sizeof(Visit), 20U);
#ifdef __GLIBC__  // all that 100 trajectories leave in each of 16 384 cells (nothing to count under a sanitizer)
  Numbers numbers(6);
  const Grid grid = test::grid_of(128, 128, 2.0, 2.0);
  const auto in_use = [] { return static_cast<double>(mallinfo2().uordblks); };
  const double before = in_use();
  Tally tally(grid, {1.0, 30.0, 300.0}, {0.5, 2.0});
  for (int pass = 0; pass < 10; ++pass) {
    VisitBatch batch(grid);
    for (int i = 0; i < 10; ++i) {
      Path path;
      for (int cell = 0; cell < 128 * 128; ++cell)
        path.spans.push_back(stay(cell % 128, cell / 128, static_cast<float>(numbers.uniform(100, 400)),
                                  static_cast<float>(numbers.uniform(0, 3))));
      batch.add(path, 1000.0, 0, nullptr);
    }
    tally.add(batch);
  }
  ASSERT_EQ(tally.touched_cells(), 16'384U);
  EXPECT_LE((in_use() - before) / 16'384.0, 600.0);  // [B]
#endif
}

}  // namespace
}  // namespace talus
