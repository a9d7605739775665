#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "talus/io/results/qgis_project.hpp"
#include "talus/products/comparison.hpp"

namespace talus::io {

class MapBands;

/// A figure of every run: docs/compare.md, "compare.csv".
struct ComparedFigure {
  std::string table, name, quantity, unit;
  std::vector<std::string> values;  ///< of each run; empty: it has none
  std::string change{};             ///< of two runs the second minus the first
};

/// Folders of finished runs over the same grid, with the rasters that are compared.
class ComparedRuns {
 public:
  /// @param rasters  names without ending; empty: those of `rasters_by_default` that all runs have
  /// Throws InputError if a folder holds no run of maps, if their grids differ, if a named raster is unknown or not in
  /// every folder, or if a raster has other bands, units, titles or classes than that of the first run.
  ComparedRuns(std::vector<std::string> folders, const std::vector<std::string>& rasters);
  ~ComparedRuns();
  ComparedRuns(const ComparedRuns&) = delete;
  ComparedRuns& operator=(const ComparedRuns&) = delete;

  /// The grid and the inputs of the last run.
  const ProjectGround& ground() const { return ground_; }
  /// Notes for who reads the comparison: what differs beside the settings, and what chance does.
  const std::vector<std::string>& notes() const { return notes_; }
  /// The rasters to write: the worst value of all runs, of two runs the change as well. This object must outlive them.
  std::vector<Map> maps() const;
  /// All figures: settings that differ, cells by raster, crossings of screens. Reads all rasters.
  /// @param proceed  called from time to time with the share that is done; false ends the reading
  std::vector<ComparedFigure> figures(const std::function<bool(double share)>& proceed) const;

 private:
  struct Run;
  /// A raster, and its file in each run.
  struct Opened {
    ComparedRaster raster;
    std::vector<std::unique_ptr<MapBands>> files;
    std::vector<std::vector<double>> read(const CellWindow& window) const;
  };
  void check_grids();
  void note_differences();
  void open(const std::string& name);
  std::vector<std::string> chosen(const std::vector<std::string>& asked);
  void add_settings(std::vector<ComparedFigure>& figures) const;
  void add_cells(std::size_t raster, const std::function<bool(double share)>& proceed,
                 std::vector<ComparedFigure>& figures) const;
  void add_screens(std::vector<ComparedFigure>& figures) const;

  std::vector<Run> runs_;
  ProjectGround ground_;
  std::vector<Opened> opened_;
  std::vector<std::string> notes_;
};

/// The names of the rasters that are compared unless others are named.
const std::vector<std::string>& rasters_by_default();

/// "A" of the first run, "B" of the second.
std::string letter_of_run(std::size_t run);

}  // namespace talus::io
