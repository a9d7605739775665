#pragma once
#include <span>
#include <vector>

#include "talus/products/hazard.hpp"

namespace talus {

/// The object whose hazard a map shows.
struct ObjectWidth {
  double width = 0.0;  ///< across the paths [m]; 0: the object is the cell
  double below = 0.0;  ///< only passages lower than this were counted [m]; 0: at any height
};

/// Weighted passages of a place per area, for one level of energy. Sums over parts of paths: means over a larger place
/// are means of these.
struct PassageDensity {
  double length = 0.0;       ///< events per year and metre of width [1/(m year)]
  double by_diameter = 0.0;  ///< the same times the diameter of the block [1/year]
  double squares = 0.0;      ///< events per year times weight, per metre of width [1/(m year^2)]
};

/// The densities of a cell by level: passage, then each threshold. Empty for a cell without lengths.
std::vector<PassageDensity> densities_of(const HazardCell& cell, const WeightScale& scale, double cell_area);

/// How often blocks hit an object of some width, with 95 % bounds [1/year]: the mean number of hits in a year.
///
///   f = width * length + by_diameter             each passage counts W + D: the paths of centres that touch the object
///   interval of Fay & Feuer, each block seen with the weight w s,  s = 32 / (3 pi^2) (W + D) / seen
///
/// @param seen  width of the place over which the density was averaged [m]: of the disc, or of the cell if it is wider.
///              A block that crosses the place stands for (W + D) / seen hits; the factor is E[c^2] / E[c]^2 of the
///              chords c of a disc. D is the mean of the blocks that were seen, and of the one more block of the upper
///              bound the largest: small blocks that hit say nothing of large ones. docs/hazard.md, "An object of some
///              width".
Bounded hits_of_object(const PassageDensity& density, const WeightScale& scale, double width, double seen);

/// Cells of a disc around the centre of a cell, each with its share of the area of the disc.
struct DiscCell {
  int column, row;  ///< relative to the centre
  double share;
};
std::vector<DiscCell> disc(double diameter, double cell_x, double cell_y);

}  // namespace talus
