#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "talus/base/sample.hpp"
#include "talus/simulate/scenario/scenario.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// Colours of a legend, from light to dark; of `PlasmaFromDark` from dark to light, where small is grave.
enum class Palette { Plasma, PlasmaFromDark, Viridis, Cividis, HazardClasses };

/// How a map is drawn: a colour up to each limit, and one above the last (of a probability none: its last limit is 1).
struct Legend {
  std::vector<double> limits;  ///< ascending, in the unit of the file
  double factor;               ///< from there to the unit of the labels
  std::string unit;            ///< of the labels; empty for none
  Palette palette;
  std::string band{};  ///< that is shown; the first where empty
};

/// A result file: its name without its ending (docs/products.md), and its bands.
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
  Legend legend;
  bool smallest_in_overviews = false;  ///< of the cells under a pixel; else the largest
  std::vector<std::string> classes{};  ///< names of the whole numbers 0, 1, ... where they stand for classes

  /// Fills row `row` (0 in the south): values[band * columns + column]; NaN where nothing can be said.
  std::function<void(int row, std::span<double> values)> fill_row{};
};

/// All maps of a finished run, in the order in which they are written. The scenario and the tally must outlive them.
///
/// Cells without terrain are NaN. Cells that nothing crosses are 0 in probabilities and counts, NaN in quantities.
std::vector<Map> make_maps(const Scenario& scenario, const Tally& tally);

}  // namespace talus
