#pragma once
#include "talus/fit/calibrate/parameters.hpp"

namespace talus {

/// Something that may be missing in a model: its place and its parameters. With all parameters at z = 0 it changes
/// nothing. docs/diagnosis-method.md, "The candidates".
struct Candidate {
  std::string effect;                   ///< as in diagnosis.json: "vegetation-drag", ..., "instrument-bias"
  std::string where;                    ///< "everywhere", "zone meadow", "day 2", "screen S1 speed", "92 to 110 m"
  std::vector<Parameter> parameters;    ///< one or two; those that need no test of their own come last
  std::size_t tested = 1;               ///< number of them that the score test moves
  std::function<void(Model&)> prepare;  ///< before the parameters are set: places and lines
  double searched = 0.0;                ///< number of values of its place that the data chose; each has a price
  double from = 0.0, to = 0.0;          ///< of a band: along the axis [m]
  std::vector<int> days = {};           ///< of wet ground
};

}  // namespace talus
