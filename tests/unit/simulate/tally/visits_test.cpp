#include "talus/simulate/tally/visits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "support/paths.hpp"
#include "support/scenarios.hpp"
#include "talus/physics/flight.hpp"
#include "talus/simulate/plan/plan.hpp"

namespace talus {
namespace {

using test::Numbers;

using Cell = std::pair<int, int>;  // column, row

struct Seen {
  double speed_squared = 0.0, height = 0.0;
  int impacts = 0, deposits = 0, visits = 0;
};

/// The visits of one path in a batch, by cell; several visits to a cell are joined.
std::map<Cell, Seen> seen(const VisitBatch& batch, const Grid& grid) {
  const int across = (grid.columns + kRegionSide - 1) / kRegionSide;
  std::map<Cell, Seen> cells;
  for (const auto& of_region : batch.regions())
    of_region.second.visits.for_each([&, region = static_cast<int>(of_region.first)](const Visit& visit) {
      Seen& cell = cells[{region % across * kRegionSide + visit.cell % kRegionSide,
                          region / across * kRegionSide + visit.cell / kRegionSide}];
      cell.speed_squared = std::max<double>(cell.speed_squared, visit.speed_squared);
      cell.height = std::max<double>(cell.height, visit.height);
      cell.impacts += static_cast<int>(visit.impacts);
      cell.deposits += static_cast<int>(visit.deposited);
      cell.visits += 1;
    });
  return cells;
}

std::map<Cell, Seen> seen(const Path& path, const Grid& grid) {
  VisitBatch batch(grid);
  batch.add(path, 1.0, 0, nullptr);
  return seen(batch, grid);
}

std::set<Cell> cells_of(const std::map<Cell, Seen>& seen) {
  std::set<Cell> cells;
  for (const auto& [cell, values] : seen) cells.insert(cell);
  return cells;
}

Path flight(const Surface& surface, const Vec3& position, const Vec3& velocity, double* duration = nullptr) {
  Motion motion;
  motion.position = position;
  motion.velocity = velocity;
  PatchIndex at = surface.patch_at(position.x(), position.y());
  Path path;
  path.end = fly(surface, motion, at, false, path) == FlightEnd::Landed ? End::Stopped : End::Left;
  if (duration != nullptr) *duration = motion.time;
  return path;
}

TEST(Visits, InASlideTheSquareOfTheSpeedIsLinearInTheWay) {  // 10 to 20 m/s; the edge of the cells lies half way
  const Span slide{{1, 1}, 0.0F, 0.25F, 1.0F, 0.25F, 0.0F, 0.0F, 0.0F, 0.0F, 10.0F, 20.0F, 0};
  const std::map<Cell, Seen> cells = seen(test::path_of({slide}, End::Left), test::grid_of(8, 8, 1.0, 1.0));
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_NEAR(cells.begin()->second.speed_squared, 0.5 * (100.0 + 400.0), 1e-4);
  EXPECT_NEAR(cells.rbegin()->second.speed_squared, 400.0, 1e-4);
}

/// Times in (0, duration) at which the flight meets a line of the grid in one direction, centres included.
void add_lines(std::vector<double>& times, double from, double speed, double half_cell, double duration) {
  const double to = from + speed * duration;
  for (double k = std::ceil(std::min(from, to) / half_cell); k * half_cell < std::max(from, to); k += 1.0)
    times.push_back(std::clamp((k * half_cell - from) / speed, 0.0, duration));
}

/// The visits by brute force: the parabola sampled densely between the times at which it changes cell or patch.
std::map<Cell, Seen> sampled(const Surface& surface, const Vec3& start, const Vec3& v, double duration) {
  const Grid& grid = surface.grid();
  std::vector<double> times{0.0, duration};
  add_lines(times, start.x(), v.x(), 0.5 * grid.cell_x, duration);
  add_lines(times, start.y(), v.y(), 0.5 * grid.cell_y, duration);
  std::sort(times.begin(), times.end());
  const int samples = 2 + static_cast<int>(100'000 / times.size());
  std::map<Cell, Seen> cells;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double from = times[i], length = times[i + 1] - from;
    if (length < 1e-6) continue;  // a corner closer than the engine's floats can tell
    const double middle = from + 0.5 * length;
    Seen& cell = cells[{grid.column_of(start.x() + v.x() * middle), grid.row_of(start.y() + v.y() * middle)}];
    for (int k = 0; k < samples; ++k) {
      const double t = from + length * k / (samples - 1);
      const double x = start.x() + v.x() * t, y = start.y() + v.y() * t, rise = v.z() - kGravity * t;
      const double z = start.z() + t * (v.z() - 0.5 * kGravity * t);
      const double east = std::clamp(x, 0.5 * grid.cell_x, (grid.columns - 0.5 - 1e-9) * grid.cell_x);  // terrain ends
      const double north = std::clamp(y, 0.5 * grid.cell_y, (grid.rows - 0.5 - 1e-9) * grid.cell_y);
      cell.height = std::max(cell.height, z - test::height_between_centres(surface.heights(), east, north));
      cell.speed_squared = std::max(cell.speed_squared, v.x() * v.x() + v.y() * v.y() + rise * rise);
    }
  }
  return cells;
}

TEST(VisitBatch, FlightsOverRoughTerrainAgainstDenseSampling) {
  Numbers numbers(1);
  const Grid grid = test::grid_of(150, 90, 2.0, 3.0);  // 3 x 2 regions
  const Surface surface(
      test::terrain(grid, [&](double x, double y) { return 300.0 - 0.5 * x - 0.25 * y + numbers.uniform(-1, 1); }),
      SurfaceKind::Bilinear);
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3 start(numbers.uniform(20, 280), numbers.uniform(20, 250), 400.0 - 0.5 * 20 + numbers.uniform(0, 5));
    const Vec3 v(numbers.uniform(-30, 30), numbers.uniform(-30, 30), numbers.uniform(-20, 20));
    double duration = 0.0;
    const auto found = seen(flight(surface, start, v, &duration), grid);
    for (const auto& [cell, expected] : sampled(surface, start, v, duration)) {
      ASSERT_TRUE(found.contains(cell)) << "trial " << trial << " cell " << cell.first << ' ' << cell.second;
      const Seen& is = found.at(cell);
      ASSERT_NEAR(is.speed_squared, expected.speed_squared, 1e-6 * expected.speed_squared) << trial;
      ASSERT_NEAR(is.height, expected.height, 2e-5 + 1e-6 * expected.height) << trial;  // 20 um
    }
  }
}

TEST(VisitBatch, VisitsNoOtherCellThanTheFlightCrosses) {
  Numbers numbers(2);
  const Grid grid = test::grid_of(150, 90, 2.0, 3.0);
  const Surface surface(test::terrain(grid, [](double, double) { return 0.0; }));
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 start(numbers.uniform(20, 280), numbers.uniform(20, 250), numbers.uniform(0, 50));
    const Vec3 v(numbers.uniform(-20, 20), numbers.uniform(-20, 20), numbers.uniform(-20, 20));
    double duration = 0.0;
    const auto found = seen(flight(surface, start, v, &duration), grid);
    const auto expected = sampled(surface, start, v, duration);
    for (const auto& [cell, values] : found) ASSERT_TRUE(expected.contains(cell)) << trial;
    ASSERT_GE(found.size() + 1, expected.size());  // a cell entered in the last rounding of the flight
  }
}

TEST(VisitBatch, ApexInTheMiddleOfACell) {  // v_z = 9.81: 1 s up, 4.905 m; over a plane in the plan of one cell
  const Grid grid = test::grid_of(10, 10, 16.0, 16.0);
  const Surface surface(test::terrain(grid, [](double, double) { return 50.0; }));
  const auto found = seen(flight(surface, {81.0, 82.0, 52.0}, {2.0, 3.0, 9.81}), grid);
  ASSERT_EQ(cells_of(found), (std::set<Cell>{{5, 5}}));
  EXPECT_NEAR(found.at({5, 5}).height, 6.905, 2e-6);
  EXPECT_NEAR(found.at({5, 5}).speed_squared, 13.0 + 2.0 * 9.81 * 6.905, 1e-4);  // energy: v^2 = v_x^2 + v_y^2 + 2 g h
}

TEST(VisitBatch, ACornerCutByAMillimetreCounts) {
  const Grid grid = test::grid_of(12, 12, 2.0, 2.0);
  const Surface surface(test::terrain(grid, [](double, double) { return 0.0; }));
  for (const double shift : {0.001, -0.001}) {  // y = x - shift: one millimetre beside every corner
    const auto cells = cells_of(seen(flight(surface, {3.0, 3.0 - shift, 4.9}, {8.0, 8.0, 0.0}), grid));
    std::set<Cell> expected{{1, 1}};
    for (int i = 1; i < 5; ++i) {  // 8 m in 1 s: up to x = 10.995
      expected.insert(shift > 0.0 ? Cell{i + 1, i} : Cell{i, i + 1});
      expected.insert({i + 1, i + 1});
    }
    EXPECT_EQ(cells, expected) << shift;
  }
}

TEST(VisitBatch, AlongAnEdgeTheCellOfThePlaceHoldsThePath) {
  const Grid grid = test::grid_of(12, 12, 2.0, 2.0);
  const Surface surface(test::terrain(grid, [](double, double) { return 0.0; }));
  const auto north = cells_of(seen(flight(surface, {6.0, 3.0, 4.9}, {0.0, 8.0, 0.0}), grid));
  EXPECT_EQ(north, (std::set<Cell>{{3, 1}, {3, 2}, {3, 3}, {3, 4}, {3, 5}}));  // x = 6.0 belongs to column 3
  const auto west = cells_of(seen(flight(surface, {11.0, 6.0, 4.9}, {-8.0, 0.0, 0.0}), grid));
  EXPECT_EQ(west, (std::set<Cell>{{1, 3}, {2, 3}, {3, 3}, {4, 3}, {5, 3}}));
}

TEST(VisitBatch, ASpanByHand) {  // over the middles of both directions: three cells, all values exact in floats
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const Span span{{2, 3}, 0.25F, 0.0F, 0.75F, 1.0F, 1.0F, 3.0F, -4.0F, 16.0F, 6.0F, -2.0F, 3};
  // p = 1/4 + s/2 and q = s meet 1/2 at s = 1/2 both: no third cell lies between; height = 1 + 6 s - 4 s^2
  const auto found = seen(test::path_of({span}, End::Stopped), grid);
  ASSERT_TRUE(found.contains({2, 3}) && found.contains({3, 4}));
  EXPECT_EQ(found.at({2, 3}).speed_squared, 16.0 + 36.0);
  EXPECT_EQ(found.at({2, 3}).height, 3.0);  // at s = 1/2
  EXPECT_EQ(found.at({3, 4}).speed_squared, 16.0 + 4.0);
  EXPECT_EQ(found.at({3, 4}).height, 3.25);  // the apex at s = 3/4
  EXPECT_EQ(found.at({3, 4}).impacts, 3);
  EXPECT_EQ(found.at({3, 4}).deposits, 1);
  EXPECT_EQ(found.at({2, 3}).impacts + found.at({2, 3}).deposits, 0);
}

TEST(VisitBatch, ThreeCellsOfOneSpan) {  // q turns at s = 1/4, p at 3/4
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const Span span{{2, 3}, 0.125F, 0.375F, 0.625F, 0.875F, 0.0F, 8.0F, 0.0F, 1.0F, 4.0F, 8.0F, 0};
  const auto found = seen(test::path_of({span}, End::Left), grid);
  ASSERT_EQ(cells_of(found), (std::set<Cell>{{2, 3}, {2, 4}, {3, 4}}));
  EXPECT_EQ(found.at({2, 3}).height, 2.0);
  EXPECT_EQ(found.at({2, 4}).height, 6.0);
  EXPECT_EQ(found.at({3, 4}).height, 8.0);
  EXPECT_EQ(found.at({2, 3}).speed_squared, 1.0 + 25.0);  // rise 4 + 4 s
  EXPECT_EQ(found.at({2, 4}).speed_squared, 1.0 + 49.0);
  EXPECT_EQ(found.at({3, 4}).speed_squared, 1.0 + 64.0);
  EXPECT_EQ(found.at({3, 4}).deposits, 0);
}

TEST(VisitBatch, ConvexClearanceIsLargestAtAnEnd) {  // a saddle: the ground falls away faster than the parabola
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const Span span{{2, 3}, 0.0F, 0.0F, 0.25F, 0.25F, 2.0F, 3.0F, 4.0F, 1.0F, 0.0F, 0.0F, 0};
  EXPECT_EQ(seen(test::path_of({span}, End::Left), grid).at({2, 3}).height, 3.0);
}

TEST(VisitBatch, SlidesHaveTheirSpeedAndNoHeight) {
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const Span slide{{2, 3}, 0.0F, 0.25F, 1.0F, 0.25F, 0.0F, 0.0F, 0.0F, 0.0F, 6.0F, 4.0F, 0};
  const auto found = seen(test::path_of({slide}, End::Caught), grid);
  ASSERT_EQ(cells_of(found), (std::set<Cell>{{2, 3}, {3, 3}}));
  EXPECT_EQ(found.at({2, 3}).speed_squared, 36.0);
  EXPECT_EQ(found.at({3, 3}).speed_squared, 26.0);  // half way of 36 to 16: v^2 falls evenly along a slide
  EXPECT_EQ(found.at({3, 3}).height, 0.0);
  EXPECT_EQ(found.at({3, 3}).deposits, 1);  // caught is a deposit too
}

TEST(VisitBatch, ImpactsAndDepositsAreWhereTheyHappen) {
  const Scenario scenario = test::rough_slope(4, 100);
  const Grid& grid = scenario.surface.grid();
  Path path;
  int impacts = 0, stopped = 0;
  for (std::uint32_t source = 0; source < 4; ++source)
    for (std::uint32_t block = 0; block < 100; ++block) {
      trace(scenario.world(), make_release(scenario, source, block), path);
      std::map<Cell, Seen> expected;
      for (const Vertex& vertex : path.vertices) {
        const Vec3& p = vertex.motion.position;
        if (vertex.event == Event::Impact) ++expected[{grid.column_of(p.x()), grid.row_of(p.y())}].impacts, ++impacts;
      }
      const Vec3& end = path.vertices.back().motion.position;
      const bool stops = rests(path.end);
      if (stops) expected[{grid.column_of(end.x()), grid.row_of(end.y())}].deposits = 1, ++stopped;
      for (const auto& [cell, values] : seen(path, grid)) {
        ASSERT_EQ(values.impacts, expected[cell].impacts) << source << ' ' << block;
        ASSERT_EQ(values.deposits, expected[cell].deposits) << source << ' ' << block;
      }
    }
  EXPECT_GT(impacts, 1000);
  EXPECT_GT(stopped, 50);
}

TEST(VisitBatch, ComingBackIsANewVisit) {
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const auto found = seen(
      test::path_of({test::stay(1, 1, 4, 1), test::stay(1, 1, 9, 0), test::stay(2, 1, 1, 1), test::stay(1, 1, 1, 2)},
                    End::Stopped),
      grid);
  EXPECT_EQ(found.at({1, 1}).visits, 2);
  EXPECT_EQ(found.at({1, 1}).speed_squared, 9.0);
  EXPECT_EQ(found.at({1, 1}).height, 2.0);
  EXPECT_EQ(found.at({2, 1}).visits, 1);
}

TEST(VisitBatch, NoTerrainNoVisit) {
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  const Surface surface(test::terrain(grid, [](double, double) { return 0.0; }));
  VisitBatch batch(grid);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  batch.add(flight(surface, {0.2, 4.0, kNaN}, {1.0, 1.0, 0.0}), 1.0, 0, nullptr);
  batch.add(flight(surface, {0.2, 0.2, 5.0}, {1.0, 1.0, 0.0}), 1.0, 0, nullptr);  // half a cell at the edge is outside
  batch.add(Path{}, 1.0, 0, nullptr);
  EXPECT_EQ(batch.trajectories().size(), 3U);
  for (const auto& [cell, values] : seen(batch, grid)) {
    EXPECT_TRUE(std::isfinite(values.speed_squared) && std::isfinite(values.height)) << cell.first;
    EXPECT_EQ(values.impacts + values.deposits, 0);
  }
}

TEST(VisitList, KeepsTheOrderAndUsesPiecesAgain) {
  std::vector<VisitList::Piece> spare;
  VisitList list, other;
  const auto append_to = [&](VisitList& to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to.append(0, 0, spare).height = static_cast<float>(i);
  };
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, VisitList::kPiece, VisitList::kPiece + 1, 3 * VisitList::kPiece}) {
    append_to(list, count);
    EXPECT_EQ(list.size(), count);
    EXPECT_EQ(list.empty(), count == 0);
    EXPECT_EQ(list.room(), (count + VisitList::kPiece - 1) / VisitList::kPiece * VisitList::kPiece);
    std::size_t next = 0;
    list.for_each([&](const Visit& visit) { EXPECT_EQ(visit.height, static_cast<float>(next++)); });
    EXPECT_EQ(next, count);
    list.clear(spare);
    EXPECT_TRUE(list.empty());
  }
  EXPECT_EQ(spare.size(), 3U);  // the most that it had at once
  append_to(other, 2 * VisitList::kPiece);
  EXPECT_EQ(spare.size(), 1U);
}

TEST(VisitBatch, FillsUpAndClears) {
  const Grid grid = test::grid_of(8, 8, 1.0, 1.0);
  VisitBatch batch(grid);
  const Path path = test::path_of({test::stay(1, 1, 4, 1)}, End::Left);
  while (!batch.full()) batch.add(path, 1.0, 0, nullptr);
  EXPECT_LE(batch.trajectories().size(), 65'536U - 128U);  // numbers of 16 bits, one unit of work on top
  batch.clear();
  EXPECT_FALSE(batch.full());
  for (const auto& [index, region] : batch.regions()) EXPECT_TRUE(region.visits.empty()) << index;
  Path back_and_forth;
  for (int i = 0; i < 1000; ++i) back_and_forth.spans.push_back(test::stay(i % 2, 1, 4, 1));
  std::size_t visits = 0;
  for (; !batch.full(); visits += 1000) batch.add(back_and_forth, 1.0, 0, nullptr);
  EXPECT_LE(visits * sizeof(Visit), std::size_t{17} << 20U);
}

}  // namespace
}  // namespace talus
