#pragma once
#include <span>

#include "scenario_spec.hpp"
#include "table_reader.hpp"

/// Keys of a model from `talus diagnose`, beside ground and effects. docs/scenario.md, "Barriers".
namespace talus::io {

/// Reads `line` of [barriers] into spec.barrier_lines: straight barriers, their ends in the coordinates of the DEM.
void read_barrier_lines(ScenarioSpec& spec, TableReader& barriers, const std::string& origin);

/// Reads [[instrument_bias]] of a model into spec.instrument_bias.
void read_instrument_bias(ScenarioSpec& spec, TableReader& top);

/// Warns of lines without a capacity.
void warn_of_unsaid_capacities(const std::vector<BarrierLine>& lines, std::vector<std::string>& warnings);

/// Warns of barriers that stop more than any net, or are higher: in J, or a dam. Silent where the capacity is infinite.
void warn_of_unlikely_barriers(std::span<const Barrier> barriers, std::vector<std::string>& warnings);

/// Warns of barriers that have one id, of the layer and of `line`.
void warn_of_equal_ids(std::span<const Barrier> barriers, std::vector<std::string>& warnings);

/// The text of `line` that reads back as these lines.
std::string barrier_lines_text(const std::vector<BarrierLine>& lines);

/// The barrier on a grid for a line in the coordinates of the DEM, and the inverse.
Barrier barrier_of(const BarrierLine& line, const Grid& grid);
BarrierLine line_of(const Barrier& barrier, const Grid& grid);

}  // namespace talus::io
