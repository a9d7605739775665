// The energy with rotation per cell: closed forms, the vertices of paths, and the same bits in any order.
#include <gtest/gtest.h>

#include <cmath>

#include "support/paths.hpp"
#include "support/percentile.hpp"
#include "support/scenarios.hpp"
#include "talus/physics/flight.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus {
namespace {

using test::path_of;
using test::stay;

Tally kept(const Grid& grid) {
  Tally tally(grid, {}, {});
  tally.keep_energy_total();
  return tally;
}

VisitBatch batch_for(const Tally& tally) {
  VisitBatch batch(tally.grid());
  batch.keep_energy_total();
  return batch;
}

TEST(EnergyTotal, ABlockInFreeFlightWithSpin) {  // 1/2 m v^2 + 1/2 (2/5 m R^2) w^2 where it leaves each cell, falling
  const Surface surface(test::terrain(test::grid_of(12, 4, 4.0, 4.0), [](double, double) { return -1000.0; }));
  const Block body = block_of(1.5, 2700.0);
  constexpr double kSpeed = 12.0, kSpin = 25.0, kStart = 3.0;
  Motion motion;
  motion.position = {kStart, 6.5, 0.0};
  motion.velocity = {kSpeed, 0.0, 0.0};
  PatchIndex at = surface.patch_at(motion.position.x(), motion.position.y());
  Path path;
  path.end = fly(surface, motion, at, false, path) == FlightEnd::Landed ? End::Stopped : End::Left;
  ASSERT_EQ(path.end, End::Left);
  path.spins = {{0, kSpin}};
  Tally tally = kept(surface.grid());
  VisitBatch batch = batch_for(tally);
  batch.add(path, body, 0, nullptr);
  tally.add(batch);
  const double rotation = 0.5e-3 * (0.4 * body.mass * 0.75 * 0.75) * kSpin * kSpin;  // [kJ]
  for (int column = 1; column < 11; ++column) {
    const double time = ((column + 1) * 4.0 - kStart) / kSpeed, fall = kGravity * time;
    const double translation = 0.5e-3 * body.mass * (kSpeed * kSpeed + fall * fall);
    const EnergyTotal* total = tally.energy_total(column, 1);
    ASSERT_NE(tally.find(column, 1), nullptr);
    EXPECT_NEAR(total->maximum, translation + rotation, 5e-7 * (translation + rotation)) << column;
    EXPECT_NEAR(tally.find(column, 1)->maximum[Quantity::Energy], translation, 5e-7 * translation) << column;
    EXPECT_NEAR(total->mean(), total->maximum, 0x1p-10);
  }
}

TEST(EnergyTotal, EachPartOfAPathHasItsSpin) {  // 1000 kg, 1 m: 0.1 (D w)^2 adds to v^2; 0.5 kJ for each m^2/s^2
  Path path = path_of({stay(1, 1, 100, 1), stay(2, 1, 64, 1), stay(3, 1, 36, 1), stay(3, 1, 9, 1), stay(1, 1, 4, 1)},
                      End::Stopped);
  path.spins = {
      {0, 0.0}, {1, 10.0}, {1, 20.0}, {3, 30.0}, {4, 40.0}};  // at 1 two impacts at one place: the last counts
  Tally tally = kept(test::grid_of(8, 8, 1.0, 1.0));
  VisitBatch batch = batch_for(tally);
  Block body;
  body.mass = 1000.0;
  batch.add(path, body, 0, nullptr);
  tally.add(batch);
  EXPECT_FLOAT_EQ(tally.energy_total(1, 1)->maximum, 0.5F * (4.0F + 160.0F)) << "slower, but it came back spinning";
  EXPECT_FLOAT_EQ(tally.energy_total(2, 1)->maximum, 0.5F * (64.0F + 40.0F));
  EXPECT_FLOAT_EQ(tally.energy_total(3, 1)->maximum, 0.5F * (9.0F + 90.0F)) << "both parts: 38 and 49.5 kJ";
  EXPECT_EQ(tally.find(1, 1)->maximum[Quantity::Energy], 50.0F);
}

TEST(EnergyTotal, OfABlockThatBreaks) {  // from the break on mass, diameter and spin are those of the rest
  Path path = path_of({stay(1, 1, 100, 1), stay(2, 1, 100, 1)}, End::Stopped);
  path.spins = {{0, 10.0}, {1, 5.0}};
  Block rest;
  rest.mass = 500.0;
  rest.diameter = 0.5;
  path.breaks = {{0, 1, rest}};
  Block whole;
  whole.mass = 1000.0;
  Tally tally = kept(test::grid_of(8, 8, 1.0, 1.0));
  VisitBatch batch = batch_for(tally);
  batch.add(path, whole, 0, nullptr);
  Path piece = path_of({stay(2, 1, 400, 1)}, End::Stopped);  // another piece: one value with its block, the largest
  piece.spins = {{0, 0.0}};
  batch.add(piece, rest, 0, nullptr, true);
  tally.add(batch);
  EXPECT_FLOAT_EQ(tally.energy_total(1, 1)->maximum, 0.5F * (100.0F + 10.0F));
  EXPECT_FLOAT_EQ(tally.energy_total(2, 1)->maximum, 0.25F * 400.0F);
  EXPECT_EQ(tally.energy_total(2, 1)->histogram.count(), 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(tally.energy_total(2, 1)->mean()), 100.0F);
}

/// The largest energy with rotation of a path from its vertices: at both ends of each leg [kJ].
double largest_of_vertices(const Block& body, const Path& path) {
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i)
    for (const double share : {0.0, 1.0}) {
      const Motion m = motion_between(path.vertices[i], path.vertices[i + 1], share);
      largest = std::max(largest, 0.5e-3 * body.mass *
                                      (m.velocity.squaredNorm() + 0.1 * std::pow(body.diameter * m.spin.norm(), 2.0)));
    }
  return largest;
}

TEST(EnergyTotal, TheLargestOfAPathIsThatOfItsVertices) {
  Scenario s = test::rough_slope(3, 40);
  s = make_scenario(std::move(s));
  int spinning = 0;
  test::for_each_path(s, [&](const Release& release, const Path& path) {
    Tally tally = kept(s.surface.grid());
    VisitBatch batch = batch_for(tally);
    batch.add(path, release.body, 0, nullptr);
    tally.add(batch);
    float most = 0.0F, moving = 0.0F;
    for (int row = 0; row < s.surface.grid().rows; ++row)
      for (int column = 0; column < s.surface.grid().columns; ++column)
        if (const CellRecord* record = tally.find(column, row)) {
          most = std::max(most, tally.energy_total(column, row)->maximum);
          moving = std::max(moving, record->maximum[Quantity::Energy]);
        }
    const double expected = largest_of_vertices(release.body, path);
    EXPECT_NEAR(most, expected, 1e-5 * expected);
    spinning += most > 1.05F * moving ? 1 : 0;
  });
  EXPECT_GT(spinning, 60) << "otherwise this test says nothing of the rotation";
}

Tally traced(const Scenario& s, bool total, int threads) {
  Tally tally(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  if (total) tally.keep_energy_total();
  simulate(s, tally, {}, threads);
  return tally;
}

TEST(EnergyTotal, NeverBelowTheTranslationalOneAndTheSameForAnyThreads) {
  const Scenario s = make_scenario(test::rough_slope(6, 150));
  const Tally one = traced(s, true, 1), three = traced(s, true, 3), without = traced(s, false, 2);
  test::expect_same_records(one, three);
  test::expect_same_records(one, without);
  Tally restored(s.surface.grid(), s.output.energy_thresholds, s.output.height_thresholds);
  restored.keep_energy_total();
  for (std::size_t i = 0; i < three.regions(); ++i) {
    ByteWriter bytes;
    three.save(i, bytes);
    ByteReader in(bytes.bytes());
    restored.merge(i, in);
  }
  for (int row = 0; row < s.surface.grid().rows; ++row)
    for (int column = 0; column < s.surface.grid().columns; ++column) {
      const CellRecord* record = one.find(column, row);
      if (record == nullptr) continue;
      EXPECT_EQ(without.energy_total(column, row), nullptr);
      const EnergyTotal &total = *one.energy_total(column, row), &other = *restored.energy_total(column, row);
      ASSERT_EQ(total.histogram.count(), record->passages);
      ASSERT_EQ(total.maximum, other.maximum);
      ASSERT_EQ(total.sum, other.sum);
      ASSERT_GE(total.maximum, record->maximum[Quantity::Energy]);
      ASSERT_GE(total.sum, record->sum[Quantity::Energy]);
      for (const double share : {0.0, 0.5, 0.95, 0.99}) {
        ASSERT_EQ(test::percentile(total.histogram, share), test::percentile(other.histogram, share));
        ASSERT_GE(test::percentile(total.histogram, share),
                  test::percentile(record->histogram[Quantity::Energy], share));
      }
    }
}

}  // namespace
}  // namespace talus
