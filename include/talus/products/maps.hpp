#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "talus/base/sample.hpp"
#include "talus/simulate/scenario/scenario.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// A result file: its name without the ending, and its bands. docs/products.md, "Rasters".
struct Map {
  enum class Kind { Probability, Quantity, Count };  ///< Count: whole numbers, written as UInt32
  struct Band {
    std::string name;  ///< "P95", "P(E > 300 kJ)"
    std::string unit;  ///< "1" (a fraction), "kJ", "m/s", "m", "count"
  };
  std::string name;   ///< "impact_probability"
  std::string title;  ///< one line of description
  Kind kind;
  std::vector<Band> bands;

  /// Fills row `row` (0 in the south): values[band * columns + column]; NaN where nothing can be said.
  std::function<void(int row, std::span<double> values)> fill_row;
  bool smallest_in_overviews = false;  ///< of the cells under a pixel; else the largest
  std::vector<std::string> classes{};  ///< names of the whole numbers 0, 1, ... where they stand for classes
};

/// All maps of a finished run, in the order in which they are written. The scenario and the tally must outlive them.
///
/// Cells without terrain are NaN. Cells that nothing crosses are 0 in probabilities and counts, NaN in quantities.
std::vector<Map> make_maps(const Scenario& scenario, const Tally& tally);

/// Bounds of a probability of which `hits` of `trials` were counted: Clopper-Pearson, two-sided.
///
/// @param confidence  for instance 0.95
/// Exactly 0 at no hit and 1 at all hits. Covers at least `confidence` for independent trials of one probability, and
/// for trials stratified by source cell more still (Hoeffding 1956). docs/products.md, "Impact probability".
Interval probability_bounds(std::uint64_t hits, std::uint64_t trials, double confidence);

}  // namespace talus
