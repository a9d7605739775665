#include "dem_warning.hpp"

#include <cmath>

#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/base/vector.hpp"

namespace talus::io {
namespace {

constexpr std::uint64_t kFewestCells = 400;
constexpr double kSteepMedian = 45.0;  // [deg]; seven DEMs: at most 39; their hillshades, or in feet: at least 51
constexpr double kSteepShare = 0.03;   // of the cells; seven DEMs: at most 0.014
constexpr double kStepSlope = 0.05;    // step over cell; the DEMs in centimetres and cells of 4 m: 0.003
constexpr double kWholeMetres = 1.0;   // [m]: always too coarse
constexpr double kFewestBends = 0.1;   // heights in steps on planes, as a drawn test has them, are no rounding

bool is_steep(const DemFigures& f) {
  return degrees(f.median_slope) > kSteepMedian || f.steep_share > kSteepShare;
}

bool has_steps(const DemFigures& f, double cell) {
  return f.step > 0.0 && (f.step >= kStepSlope * cell || f.step >= kWholeMetres) && f.bend_share > kFewestBends;
}

}  // namespace

std::vector<std::string> dem_warnings(const std::string& path, const DemFigures& f, double cell) {
  std::vector<std::string> warnings;
  if (f.cells < kFewestCells) return warnings;
  if (is_steep(f))
    warnings.push_back(
        path + ": half of its cells are steeper than " + with_digits(degrees(f.median_slope), 2) + " deg, and " +
        percent(f.steep_share, 2) +
        " of them steeper than 80 deg (mountain sides: 20 to 40 deg, and 0 to 1.5 %): is it a picture "
        "(a hillshade) in the place of heights, or are they in feet or decimetres? Feet: gdal_calc.py -A " +
        shell_word(path) + " --calc='A*0.3048' --type=Float32 --outfile=metres.tif (decimetres: A*0.1)");
  if (has_steps(f, cell))
    warnings.push_back(path + ": all heights are multiples of " + text_of(f.step) + " m" +
                       (f.step == 0.3048 ? " (a foot)" : "") + ", a slope of " +
                       with_digits(degrees(std::atan(f.step / cell)), 2) + " deg from cell to cell, and " +
                       percent(f.flat_share, 2) +
                       " of the cells are flat: blocks meet steps that the terrain has not; take a DEM with decimals "
                       "(or is it a picture, a hillshade?)");
  return warnings;
}

}  // namespace talus::io
