#pragma once
#include "scenario_spec.hpp"
#include "table_reader.hpp"

namespace talus::io {

/// Reads [frequency]: by_true_area, total, per_area, power_law = { A, b }. docs/hazard.md, "How often".
///
/// @param origin  of what is given, for the record: "scenario"
void read_frequency(ScenarioSpec& spec, TableReader table, const std::string& origin);

}  // namespace talus::io
