#pragma once
#include <string>

#include "talus/simulate/scenario/scenario.hpp"

/// Time, memory and disk of a run, from a sample of its trajectories. docs/performance.md, "What check foretells".

/// Size of a run.
struct RunSize {
  double trajectories = 0.0, grid_cells = 0.0, touched_cells = 0.0, crossings = 0.0;
  double metres_per_path = 0.0;
  bool with_hazard = false;  ///< annual frequencies are kept
};

double bytes_in_memory(const talus::Scenario& scenario, const RunSize& size);  ///< without terrain and zones
double bytes_of_results(const talus::Scenario& scenario, const RunSize& size);
/// Bytes beside the results while the run goes on: saved work for --resume, and compressed tiles of maps.
double bytes_at_work(const talus::Scenario& scenario, const RunSize& size);
double seconds_to_write(const talus::Scenario& scenario, const RunSize& size, int processors);

/// Two digits of a number: "1 200".
std::string rounded_text(double value);
