#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "talus/products/maps.hpp"

/// The rasters of several runs over the same terrain compared cell by cell: docs/compare.md.
namespace talus {

/// A raster of which runs are compared.
struct ComparedRaster {
  Map map;                      ///< of one run: name, title, bands, legend; without values
  bool lower_is_worse = false;  ///< a return period
  bool zero_is_value = false;   ///< nodata, not 0, is where nothing happens: an energy, a speed, a height

  /// Whether a band holds a value of its own: neither a bound nor a mark.
  bool is_value(std::size_t band) const;
  /// Whether the first band has its 95 % bounds in the second and the third. Classes at bounds are none: a cell that
  /// no block reaches has the class 0 at both.
  bool has_bounds() const;
  /// The band whose mean is told: the one that its style shows.
  std::size_t shown_band() const;
  /// Whether a run reaches a cell. @param values  of all bands of the cell
  bool reached(std::span<const double> values) const;
};

/// The entry of the tables of rasters for a name such as "energy" or "return_period_300"; its bands may still be those
/// of the table. Nothing if the raster is unknown, or a count or a bound of a percentile, which are not compared.
std::optional<ComparedRaster> compared_raster(const std::string& name);

/// The raster of the worst values of the runs (`highest_energy`, `lowest_return_period_300`), and that of the change
/// from the first to the second (`change_energy`); without values.
Map worst_map(const ComparedRaster& raster, std::size_t runs);
Map change_map(const ComparedRaster& raster);

/// The worst value of each band: the highest, of return periods the lowest; runs without a value are left out. A class
/// is `undecided` if the classes at the worst bounds differ.
/// @param runs  values of each run, cell by cell, band by band (`Map::fill`)
/// @param worst  as many values
void take_worst(const ComparedRaster& raster, std::span<const std::vector<double>> runs, std::span<double> worst);

/// The second run minus the first for each band with values. Where one run has none, it counts as 0 if `zero_is_value`
/// (energies, speeds, heights); otherwise nothing is known. With bounds a last band: 1 where those of the two runs do
/// not overlap, 0 where they do.
/// @param change  for each cell the bands of `change_map`
void take_change(const ComparedRaster& raster, std::span<const std::vector<double>> runs, std::span<double> change);

/// Figures of a raster over all cells.
struct ComparedCells {
  std::vector<std::uint64_t> alone;  ///< reached by this run and no other
  std::vector<std::uint64_t> worse;  ///< of two runs: where this one is worse beyond the bounds of both
  std::vector<double> sum;           ///< of the shown band over the cells that all runs reach
  std::uint64_t common = 0;          ///< cells that all runs reach

  explicit ComparedCells(std::size_t runs) : alone(runs), worse(runs), sum(runs) {}
  void add(const ComparedRaster& raster, std::span<const std::vector<double>> runs);
  double mean(std::size_t run) const;  ///< NaN without common cells
};

}  // namespace talus
