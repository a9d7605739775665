#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "talus/products/cell_window.hpp"
#include "talus/simulate/scenario/scenario.hpp"
#include "talus/simulate/tally/tally.hpp"

namespace talus {

/// Colours of a legend, from light to dark. `PuBuGnFromDark` is from dark to light: small values are the grave ones.
/// `Change`: blue below 0, no colour around 0, orange above; `ChangeReversed`: orange below, blue above.
enum class Palette { Plasma, PuBuGnFromDark, Viridis, YlGnBu, HazardClasses, Change, ChangeReversed };

/// How a map is drawn: one colour up to each limit, and one above the last limit. A probability has no colour above
/// its last limit, which is 1.
struct Legend {
  std::vector<double> limits;  ///< ascending, in the unit of the file
  double factor;               ///< from the unit of the file to the unit of the labels
  std::string unit;            ///< of the labels; empty for none
  Palette palette;
  std::string band{};          ///< name of the band that is shown; empty: the first
  bool has_zero = true;        ///< 0 is a value, "nothing here": it has an entry, without a colour
  bool names_in_file = false;  ///< the names of its classes are stored beside the raster, too
};

/// A result file: its name without its ending (docs/products.md), and its bands.
struct Map {
  enum class Kind { Probability, Quantity, Count };  ///< Count: whole numbers, written as UInt32
  struct Band {
    std::string name;  ///< "P95", "P(E > 300 kJ)"
    std::string unit;  ///< "1" (a fraction), "kJ", "m/s", "m", "count"
  };
  /// A band that is 1 in some cells and 0 in the others: drawn over the map, in one colour.
  struct Mark {
    std::string band;
    std::string label;   ///< what is so in the cells
    std::string colour;  ///< "#rrggbb"
  };
  std::string name;   ///< "impact_probability"
  std::string title;  ///< one line of description
  Kind kind;
  std::vector<Band> bands;
  Legend legend;
  bool smallest_in_overviews = false;  ///< overviews show the smallest cell of a pixel, else the largest
  std::vector<std::string> classes{};  ///< names of the values 0, 1, ... if the values are classes; of the changes
  std::vector<Mark> marks{};
  bool farthest_in_overviews = false;  ///< overviews show the cell farthest from 0

  /// Fills the cells of a window: values[(row * window.columns + column) * bands + band], row 0 in the south; NaN means
  /// no value. Several threads may call it at the same time.
  std::function<void(const CellWindow& window, std::span<double> values)> fill{};
  /// The value of each band in all cells of a window, where it is known to be the same; else nothing. May be empty.
  std::function<std::optional<std::vector<double>>(const CellWindow& window)> everywhere{};
};

/// All maps of a finished run, in the order in which they are written. The scenario and the tally must outlive them.
///
/// Cells without terrain are NaN. Cells that nothing crosses are 0 in probabilities and counts, NaN in quantities.
std::vector<Map> make_maps(const Scenario& scenario, const Tally& tally);

}  // namespace talus
