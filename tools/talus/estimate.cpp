#include "estimate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "progress.hpp"
#include "talus/products/raster_table.hpp"
#include "talus/simulate/screens/screens.hpp"
#include "talus/simulate/stop_row.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace {

using talus::Scenario;

// Measured on the valley and on the region of docs/performance.md.
constexpr double kBase = 64e6;             // of the process [byte]
constexpr double kHistogram = 40.0;        // of a quantity of a touched cell [byte]
constexpr double kHazardCell = 664.0;      // annual frequencies of a touched cell [byte]: 32 bins, containers
constexpr double kHazardLevel = 48.0;      // the same: lengths of all passages, and above each energy threshold [byte]
constexpr double kKeptTotal = 90.0;        // of the energy with rotation of a touched cell in the saved tally [byte]
constexpr double kRasterCell = 2.2;        // of a touched cell in a band of a compressed raster [byte]
constexpr double kHazardFile = 77.0;       // of a touched cell [byte]
constexpr double kStop = 172.0;            // a row of stops.gpkg [byte]
constexpr double kFlatStop = 260.0;        // a row of stops.fgb [byte]
constexpr double kFlatRow = 160.0;         // of stops.fgb in memory while it is written [byte]
constexpr double kPathPoint = 36.0;        // of trajectories.gpkg [byte]
constexpr double kCrossing = 150.0;        // a row of screens.csv [byte]
constexpr double kKeptCell = 344.0;        // of a touched cell in the saved tally [byte]
constexpr double kEmptyCell = 4e-10;       // of the grid, per band, to write [s]
constexpr double kTouchedCell = 0.9e-7;    // of a touched cell, per band, to write [s]
constexpr double kWriteTrajectory = 2e-6;  // a row of stops.gpkg [s]
constexpr double kWriteFiles = 0.6;        // to create all files [s]

double thresholds(const Scenario& scenario) {
  return static_cast<double>(scenario.output.energy_thresholds.size() + scenario.output.height_thresholds.size());
}

/// Annual frequencies of a touched cell [byte].
double hazard_bytes(const Scenario& scenario) {
  return kHazardCell + kHazardLevel * static_cast<double>(1 + scenario.output.energy_thresholds.size());
}

/// Lengths of paths above the energy thresholds, of a touched cell [byte].
double length_bytes(const Scenario& scenario) {
  return 8.0 * static_cast<double>(scenario.output.energy_thresholds.size());
}

/// The energy with rotation of a touched cell [byte].
double total_bytes(const Scenario& scenario) {
  return scenario.output.keeps_total() ? sizeof(talus::EnergyTotal) + kHistogram : 0.0;
}

/// Number of bands of each raster that is written, the largest first.
std::vector<std::size_t> numbers_of_bands(const Scenario& scenario) {
  const talus::RunCounts run = talus::counts_of(scenario);
  std::vector<std::size_t> numbers;
  for (const talus::RunRaster& raster : talus::run_rasters()) numbers.push_back(bands_of(raster, run).size());
  std::ranges::sort(numbers, std::greater<>());
  return numbers;
}

double bands(const Scenario& scenario) {
  const std::vector<std::size_t> numbers = numbers_of_bands(scenario);
  return static_cast<double>(std::accumulate(numbers.begin(), numbers.end(), std::size_t{0}));
}

/// Bands of the largest rasters that are written at the same time: at the end of each, all threads begin with the next.
double bands_at_once(const Scenario& scenario) {
  const std::vector<std::size_t> numbers = numbers_of_bands(scenario);
  return static_cast<double>(numbers[0] + numbers[1]);
}

bool is_flat(const Scenario& scenario) {
  return scenario.output.vectors == talus::VectorFormat::FlatGeobuf;
}

}  // namespace

double bytes_in_memory(const Scenario& scenario, const RunSize& size) {
  const double cell = sizeof(talus::CellRecord) + talus::kQuantities * kHistogram + 16.0 + 4.0 * thresholds(scenario) +
                      length_bytes(scenario) + total_bytes(scenario) +
                      (size.with_hazard ? hazard_bytes(scenario) : 0.0);
  return kBase + size.touched_cells * cell + (is_flat(scenario) ? kFlatRow * size.trajectories : 0.0);
}

double bytes_of_results(const Scenario& scenario, const RunSize& size) {
  const talus::Grid& grid = scenario.surface.grid();
  const double paths = std::min<double>(scenario.output.paths, size.trajectories);
  return size.touched_cells * (kRasterCell * bands(scenario) + (size.with_hazard ? kHazardFile : 0.0)) +
         size.trajectories * (is_flat(scenario) ? kFlatStop : kStop) + size.crossings * kCrossing +
         paths * (500.0 + kPathPoint * size.metres_per_path / grid.cell_x);
}

double bytes_at_work(const Scenario& scenario, const RunSize& size) {
  const double kept = kKeptCell + 4.0 * thresholds(scenario) + length_bytes(scenario) +
                      (scenario.output.keeps_total() ? kKeptTotal : 0.0) +
                      (size.with_hazard ? hazard_bytes(scenario) : 0.0);
  const double tiles = kRasterCell * bands_at_once(scenario) * size.touched_cells;
  return size.touched_cells * kept + std::max(size.touched_cells * kept, tiles) +
         size.trajectories * sizeof(talus::StopRow) + size.crossings * sizeof(talus::Crossing);
}

double seconds_to_write(const Scenario& scenario, const RunSize& size, int processors) {
  const double rasters = bands(scenario) * (kEmptyCell * size.grid_cells + kTouchedCell * size.touched_cells);
  return kWriteFiles + rasters / processors + kWriteTrajectory * size.trajectories;
}

std::string rounded_text(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(1.0, value))) - 1.0);
  return count_text(static_cast<std::uint64_t>(std::ceil(std::ceil(value / unit) * unit)));
}
