#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "talus/simulate/scenario.hpp"

/// What a run will need, from a sample of its trajectories. docs/performance.md, "What check foretells".

/// How large a run is.
struct RunSize {
  double trajectories = 0.0, grid_cells = 0.0, touched_cells = 0.0, crossings = 0.0;
  double metres_per_path = 0.0;
  bool with_hazard = false;  ///< annual frequencies are kept
};

/// How many cells `times` as many trajectories reach as a sample.
///
/// The cells that few of the sample reach tell of those that none does. Their rates are taken as gamma distributed, so
/// that the numbers of passages are negative binomial: its two parameters follow from the ratios of the cells with one,
/// two and three. Source: Fisher, Corbet and Williams, J. Animal Ecology 12, 1943; Efron and Thisted, Biometrika 63,
/// 1976.
///
/// @param cells  with 0, 1, 2, 3, and 4 or more of the sample
/// @param most   there are
double expected_cells(const std::vector<std::uint64_t>& cells, double times, double most);

double bytes_in_memory(const talus::Scenario& scenario, const RunSize& size);  ///< beside the terrain and zones
double bytes_of_results(const talus::Scenario& scenario, const RunSize& size);
double bytes_at_work(const talus::Scenario& scenario, const RunSize& size);  ///< kept for --resume, beside the results
double seconds_to_write(const talus::Scenario& scenario, const RunSize& size, unsigned processors);

/// Two digits of a number: "1 200".
std::string rounded_text(double value);
