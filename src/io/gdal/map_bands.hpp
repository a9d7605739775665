#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "dataset.hpp"
#include "talus/products/maps.hpp"

namespace talus::io {

/// All bands of a raster that Talus has written, read window by window.
class MapBands {
 public:
  /// Throws InputError if the file cannot be opened, or has not this size.
  MapBands(const std::string& path, int columns, int rows);

  const std::string& path() const { return path_; }
  const std::vector<Map::Band>& bands() const { return bands_; }
  const std::string& title() const { return title_; }

  /// The values of a window as `Map::fill` gives them. Several threads may call it at the same time. Throws InputError.
  std::vector<double> read(const CellWindow& window);

 private:
  std::string path_, title_;
  Dataset dataset_;
  std::vector<Map::Band> bands_;
  std::vector<double> nodata_;  // of each band
  std::mutex mutex_;            // of the dataset
};

}  // namespace talus::io
