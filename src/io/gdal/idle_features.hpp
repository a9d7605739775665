#pragma once
#include <functional>
#include <string>
#include <vector>

#include "layer.hpp"

namespace talus::io {

/// Cells that a feature covers, how many of them have a height, and how many had another value than 0 before.
struct CoveredCells {
  std::uint64_t all = 0, with_height = 0, taken = 0;
};

/// Gives the cells of the DEM whose centres the polygons of a feature cover a value.
CoveredCells mark_cells(const Parts& feature, std::uint8_t value, const Terrain& terrain, Raster<std::uint8_t>& cells);

/// Marks cells of the DEM by the polygons of a layer, and remembers those that act in no cell.
class IdleFeatures {
 public:
  /// @param kind  what the polygons are, for messages: "zones"
  IdleFeatures(std::string path, std::string kind, const Terrain& terrain)
      : path_(std::move(path)), kind_(std::move(kind)), terrain_(terrain) {}

  /// As `mark_cells`.
  ///
  /// @param name   of the feature: its number, with what else it is called: "4 (road)"
  /// @param value  is not called for a feature off the DEM
  void mark(const std::string& name, const Parts& feature, const std::function<std::uint8_t()>& value,
            Raster<std::uint8_t>& cells);

  /// Whether all features with a geometry are off the DEM, and there is one.
  bool all_off(std::size_t features) const {
    return !off_.empty() && off_.size() + without_geometry_.size() == features;
  }
  /// The box around all features that have a geometry [m, local].
  const OGREnvelope& box() const { return box_; }
  /// A line for each way in which features have no effect.
  /// @param cells  as `mark` has left them
  void warn(const Raster<std::uint8_t>& cells, std::vector<std::string>& warnings) const;

 private:
  std::string path_, kind_;
  const Terrain& terrain_;
  OGREnvelope box_;
  std::vector<std::string> without_geometry_, off_, narrow_, without_height_;
  std::vector<std::string> takers_;                           // features that overlap an earlier one of another value
  std::uint64_t taken_ = 0;                                   // cells of both
  std::vector<std::pair<Parts, std::uint8_t>> earlier_;       // that have cells, and their values
  std::vector<std::pair<std::string, std::uint8_t>> marked_;  // names and values of the others
};

}  // namespace talus::io
